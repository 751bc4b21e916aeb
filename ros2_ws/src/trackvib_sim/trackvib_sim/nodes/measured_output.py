"""What the simulator publishes of its running gear: a topic a kind, and what their numbers belong to."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.packed_message import PackedMessage
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from trackvib_msgs.msg import Measured, MeasuredDescription, MeasuredKind

from ..simulation.running_gear import RunningGear
from .messages import set_stamp


class MeasuredOutput:
    """Publishers of what is measured in the running gear, at a rate [Hz] of simulated time."""

    def __init__(self, node, simulation, vehicle, rate):
        self._simulation, self._gear = simulation, RunningGear(vehicle, simulation)
        self._periods = simulation.settings.rates.control // rate
        self._kinds = []  # publisher and message of each
        for kind in self._gear.kinds:
            message = Measured(value=[0.0] * len(kind.names))
            message.header.frame_id = topics.ROAD_FRAME
            publisher = node.create_publisher(Measured, topics.measured_topic(kind.name), LOOP_WRITER_QOS)
            self._kinds.append((publisher, PackedMessage(message, {"value": (len(kind.names),)})))
        self._description_out = node.create_publisher(MeasuredDescription, topics.MEASURED_DESCRIPTION, LATCHED_QOS)

    def introduce(self):
        """Publish what the numbers belong to."""
        message = MeasuredDescription()
        set_stamp(message, self._simulation.time)
        for kind in self._gear.kinds:
            topic, names = topics.measured_topic(kind.name), list(kind.names)
            message.kinds.append(MeasuredKind(topic=topic, unit=kind.unit, meaning=kind.meaning, names=names))
        self._description_out.publish(message)

    def publish_in_turn(self):
        """Publish what there is to measure, if it is time to."""
        if self._simulation.periods % self._periods == 0:
            for (publisher, message), values in zip(self._kinds, self._gear.read(), strict=True):
                publisher.publish(message.fill(self._simulation.time, value=values))
