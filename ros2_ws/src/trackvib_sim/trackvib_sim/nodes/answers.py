"""Hears whoever answers with coil currents, whatever quality of service they offer."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.packed_message import MessageReader
from mr_mount_controller.node_base.plain_text import readable
from mr_mount_controller.node_base.qos import LOOP_QOS
from rclpy.duration import Infinite
from rclpy.qos import QoSCompatibility, QoSProfile, QoSReliabilityPolicy, qos_check_compatible
from trackvib_msgs.msg import CoilCurrent

from .graph import full_name, is_known

_BEST_EFFORT = QoSProfile(depth=LOOP_QOS.depth, reliability=QoSReliabilityPolicy.BEST_EFFORT)


class Answers:
    """Subscriptions to the currents: a reliable one, for the lock-step must lose nothing.

    Who offers best effort only is not heard by it, so a second subscription is made as soon as there is such a one.
    """

    def __init__(self, node, coils, on_answer, listen):
        """Listen, by `listen` as that of `LoopNode`, to so many currents.

        `on_answer` takes an answer's bytes, the stamp of its sample [ns] and the currents.
        """
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
        names = [full_name(each) for each in publishers if each.qos_profile.reliability == _BEST_EFFORT.reliability]
        if names and all(map(is_known, names)):
            self._subscriptions.append(self._listen(_BEST_EFFORT))
            self._node.get_logger().warning(
                f"{readable(', '.join(names))} answers on {topics.COIL_CURRENT} with best effort: its answers are "
                "used, but may be lost in transit; use reliable QoS"
            )


class DeafListeners:
    """Tells, once each, who listens to one of some publishers and cannot hear it by his quality of service."""

    def __init__(self, node, publishers):
        self._node, self._publishers, self._told = node, publishers, set()

    def tell(self):
        """Warn of those that have come since the last time."""
        for sentence in set(self._sentences()) - self._told:
            self._told.add(sentence)
            self._node.get_logger().warning(sentence)

    def _sentences(self):
        for publisher in self._publishers:
            for each in self._node.get_subscriptions_info_by_topic(publisher.topic_name):
                verdict, reason = qos_check_compatible(publisher.qos_profile, _asked_for(each.qos_profile))
                name = full_name(each)
                if verdict == QoSCompatibility.ERROR and is_known(name):
                    yield (
                        f"{readable(name)} receives nothing on {publisher.topic_name}, its QoS is incompatible: "
                        f"{reason.rstrip(' ;')}"
                    )


def _asked_for(profile):
    """Return a profile without the times that ask for nothing: infinite ones, where ROS's own default is none."""
    times = {name: getattr(profile, name) for name in ("deadline", "liveliness_lease_duration")}
    return QoSProfile(
        depth=1,
        reliability=profile.reliability,
        durability=profile.durability,
        **{name: time for name, time in times.items() if time < Infinite},
    )
