"""The recorder node: writes topics to an MCAP bag as they travel, with the parameters of the nodes behind them."""

import os
import sys
import time
from datetime import datetime
from importlib import import_module

from builtin_interfaces.msg import Time
from mr_mount_controller.node_support import LOOP_QOS, LoopNode, NodeError, run_node
from mr_mount_controller.parameters import Parameter
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

from ..bags.qos import qos_record
from ..bags.stamps import leading_stamp
from ..bags.versions import versions
from ..bags.writing import BagError, BagWriter
from ..simulation.settings import NANO
from . import topics

DEFAULT_TOPICS = [
    topics.CHASSIS_IMU,
    topics.POWERTRAIN_IMU,
    topics.COIL_CURRENT,
    topics.MOUNT_STATE,
    topics.ODOMETRY,
    topics.ROAD_PROFILE,
    topics.VEHICLE_DESCRIPTION,
    topics.CLOCK,
    topics.DIAGNOSTICS,
]
PARAMETERS = (
    Parameter("bag", "", "Folder of the bag; empty for bag_<date and time> where the node was started."),
    Parameter("topics", DEFAULT_TOPICS, "Topics to record; recording starts when all of them are there."),
)
_DEPTH = 1000  # messages that may wait
_SERVICE_TIMEOUT = 2.0  # s, for a node to tell its parameters
_UNKNOWN = "_NODE_NAME_UNKNOWN_"  # rmw's word for it
_NAMES_TIMEOUT = 3.0  # s
_REST = 0.02  # s between looks; waking for every message would take the processor from the loop
_NICE = 10
_QUIET = 0.2  # s without a message after which nothing more is expected at the end


class RecorderNode(LoopNode):
    """Records raw messages; their time in the bag is the simulated time of their stamp."""

    def __init__(self):
        super().__init__("recorder", PARAMETERS)
        path = self.settings["bag"] or f"bag_{datetime.now():%Y%m%dT%H%M%S}"
        try:
            self._bag = BagWriter(path)
        except BagError as error:
            raise NodeError(str(error)) from None
        self._wanted = {self.resolve_topic_name(topic) for topic in self.settings["topics"]}
        self._recorded = self.create_publisher(Time, topics.RECORDED, LOOP_QOS)
        self._latest = 0  # stamp, ns
        self._received = 0

    def run(self):
        """Wait for every topic, write down where it comes from, record until told to stop."""
        self.get_logger().info(f"waiting for {', '.join(sorted(self._wanted))}")
        if not self.spin_until(lambda: all(map(self.get_publishers_info_by_topic, self._wanted))):
            return
        # names of nodes come a moment after their publishers; what is not a node never has one
        self.spin_until(lambda: not any(_UNKNOWN in name for name in self._publishing_nodes()), _NAMES_TIMEOUT)
        self._bag.add_provenance("versions", versions())
        for name in self._publishing_nodes():
            self._bag.add_provenance(f"parameters of {name}", self._parameters_of(name))
        # only now: whoever waits for a recorder starts when it sees the subscriptions
        for topic in sorted(self._wanted):
            self._subscribe(topic)
        self.get_logger().info(f"recording {len(self._wanted)} topics to {self._bag.path}")
        while not self.stopping():
            if self._take_all():
                seconds, nanoseconds = divmod(self._latest, NANO)
                self._recorded.publish(Time(sec=seconds, nanosec=nanoseconds))
            time.sleep(_REST)

    def _take_all(self):
        """Write all that has arrived; returns whether anything had."""
        start = before = self._received
        while True:
            self.spin_once(0.0)
            if self._received == before:
                return before > start
            before = self._received

    def close(self):
        """Take what has arrived already, then complete the bag."""
        while self._take_all():
            time.sleep(_QUIET)
        self._bag.close()
        self.get_logger().info(f"{self._bag.counts.total()} messages in {self._bag.path}")

    def _subscribe(self, topic):
        infos = self.get_publishers_info_by_topic(topic)
        offers = [info.qos_profile for info in infos]
        qos = QoSProfile(depth=_DEPTH)
        # take all that every publisher can give
        if all(offer.durability == QoSDurabilityPolicy.TRANSIENT_LOCAL for offer in offers):
            qos.durability = QoSDurabilityPolicy.TRANSIENT_LOCAL
        if any(offer.reliability == QoSReliabilityPolicy.BEST_EFFORT for offer in offers):
            qos.reliability = QoSReliabilityPolicy.BEST_EFFORT
        type_name = infos[0].topic_type
        self._bag.add_topic(topic, type_name, [qos_record(offer) for offer in offers])
        package, kind, name = type_name.split("/")
        message_type = getattr(import_module(f"{package}.{kind}"), name)
        first_field = next(iter(message_type.get_fields_and_field_types().values()))
        stamped = first_field in ("std_msgs/Header", "builtin_interfaces/Time")
        self.create_subscription(
            message_type, topic, lambda data: self._on_message(topic, stamped, data), qos, raw=True
        )

    def _on_message(self, topic, stamped, data):
        if stamped:
            stamp = leading_stamp(data)
            self._latest = max(self._latest, stamp)
        else:
            stamp = self._latest
        self._bag.write(topic, stamp, data)
        self._received += 1

    def _publishing_nodes(self):
        infos = (info for topic in sorted(self._wanted) for info in self.get_publishers_info_by_topic(topic))
        return sorted({f"{info.node_namespace.rstrip('/')}/{info.node_name}" for info in infos})

    def _parameters_of(self, name):
        """Ask a node for its parameters; one that does not tell (or is no ROS 2 node) is recorded as silent."""
        client = AsyncParameterClient(self, name)
        names = self._result(client.list_parameters())
        if names is None:
            self.get_logger().warning(f"{name} does not tell its parameters; the bag goes without them")
            return {"": "not told"}
        names = sorted(names.result.names)
        values = self._result(client.get_parameters(names))
        return dict(zip(names, map(parameter_value_to_python, values.values), strict=True)) if values else {}

    def _result(self, future):
        return future.result() if self.spin_until(future.done, _SERVICE_TIMEOUT) else None


def main(args=None):
    """Run the node."""
    # The loop goes first: a recorder that is served at once takes the processor from it for every message.
    os.nice(_NICE)
    sys.exit(run_node(RecorderNode, args))
