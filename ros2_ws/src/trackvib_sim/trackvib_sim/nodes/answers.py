"""Hears whoever answers with coil currents, whatever quality of service they offer."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.packed_message import MessageReader
from mr_mount_controller.node_base.plain_text import readable
from mr_mount_controller.node_base.qos import LOOP_QOS
from rclpy.qos import QoSCompatibility, QoSProfile, QoSReliabilityPolicy, qos_check_compatible
from trackvib_msgs.msg import CoilCurrent

_BEST_EFFORT = QoSProfile(depth=LOOP_QOS.depth, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class Answers:
    """Subscriptions to the currents: a reliable one, for the lock-step must lose nothing.

    Who offers best effort only is not heard by it, so a second subscription is made as soon as there is such a one.
    """

    def __init__(self, node, coils, on_answer, listen):
        """`on_answer` takes the bytes, the stamp of the sample [ns] and the currents; `listen` is `LoopNode.listen`'s."""
        reader = MessageReader(CoilCurrent, "sample_stamp", {"current": coils})
        self._node = node
        self._listen = lambda qos: listen(
            CoilCurrent, topics.COIL_CURRENT, on_answer, qos, lambda data: (data, *reader.read(data))
        )
        self._subscriptions = [self._listen(LOOP_QOS)]

    @property
    def topic(self):
        """Full name of the topic."""
        return self._subscriptions[0].topic_name

    def count(self):
        """Return how many nodes answer; a reliable subscription hears them all, or else the second one does."""
        reliable = self._subscriptions[0].get_publisher_count()
        if len(self._subscriptions) == 1 and self._node.count_publishers(self.topic) > reliable:
            self._hear_best_effort()
        return self._subscriptions[-1].get_publisher_count()

    def _hear_best_effort(self):
        publishers = self._node.get_publishers_info_by_topic(self.topic)
        names = [each.node_name for each in publishers if each.qos_profile.reliability == _BEST_EFFORT.reliability]
        if names:
            self._subscriptions.append(self._listen(_BEST_EFFORT))
            self._node.get_logger().warning(
                f"{readable(', '.join(names))} answers on {topics.COIL_CURRENT} with best effort: it is heard, but an "
                "answer may be lost on its way; the loop is meant for reliable ones"
            )


def misfits(node, publishers):
    """Yield, in a sentence each, who listens to one of some publishers and cannot hear it by his quality of service."""
    for publisher in publishers:
        for each in node.get_subscriptions_info_by_topic(publisher.topic_name):
            verdict, reason = qos_check_compatible(publisher.qos_profile, each.qos_profile)
            if verdict == QoSCompatibility.ERROR:
                name = readable(f"{each.node_namespace.rstrip('/')}/{each.node_name}")
                yield f"{name} does not hear {publisher.topic_name}, its QoS does not fit: {reason.rstrip(' ;')}"
