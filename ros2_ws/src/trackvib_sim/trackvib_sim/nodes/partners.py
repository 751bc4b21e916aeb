"""Whom the simulator waits for at the start, and whom it watches then: another simulator, recorder, live view."""

import time
from functools import partial
from math import inf

from builtin_interfaces.msg import Time
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.loop_node import NodeError
from mr_mount_controller.node_base.qos import CLOCK_QOS, LATCHED_QOS
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from ..bags.timekeeping import END_OF_TIME
from ..numerics.units import NANO
from .graph import is_known, publishing_nodes, subscribing_nodes

# The recorder's port in shared memory holds 512 messages, and a period has some four. What finds it full is sent again
# after up to 3 s, if its writer still holds it by then, and meanwhile all that follows waits.
_LAG = 100  # periods
_LISTENING = 0.7  # s in which a simulator that is there already makes itself known
_LOOK = 0.05  # s for what has come meanwhile to be served
_AGAIN = 1.0  # s after which one that stands still has told its time again
_TIMEOUT = 10.0  # s without any progress of the recorder
_LAST = 5.0  # s at the end of a run that shall stop
LIVE_VIEW = "live_view"  # how the name of its node begins
_VIEWED = (
    topics.TF,
    topics.TRACK_LINKS,
    topics.ROAD_STRIPS,
    topics.MOUNT_STATE,
    topics.CHASSIS_IMU,
    topics.POWERTRAIN_IMU,
)
_SETTLING = 0.3  # s without a new partner; a controller's two subscriptions are not found in the same instant


class Gathering:
    """Tells when all partners are there and nobody else has come for a moment."""

    def __init__(self, present, ready=lambda: True):
        """`present()` returns how many partners there are of each kind, `ready()` whether all else is there."""
        self._present, self._ready = present, ready
        self._seen, self._since = None, 0.0

    def look(self):
        """Note who is there now; returns whether all are, and have been for a moment."""
        now = self._present()
        if now != self._seen:
            self._seen, self._since = now, time.monotonic()
        return all(now) and time.monotonic() - self._since > _SETTLING

    def complete(self):
        """Return whether it is time to begin."""
        return self.look() and self._ready()


class SecondClock:
    """Notices another simulator in the ROS domain and namespace: of two, the one whose clock is behind gives way.

    A single message that is ahead is none: a clock goes on, and one that stands still repeats itself.
    """

    def __init__(self, node, simulated_time):
        """Listen to the clock; `simulated_time()` is the node's own simulated time [ns]."""
        self.ahead = False
        self._node, self._time = node, simulated_time
        self._since = time.monotonic()
        self._heard = -inf  # wall time of the latest message that was ahead, s
        self._own = 0  # the latest time that the node has ever published, ns: its own clock goes back, too
        self._topic = node.listen(Clock, topics.CLOCK, self._on_clock, CLOCK_QOS).topic_name

    def listen(self, meanwhile):
        """Have listened for as long as a simulator that is there already needs to make itself known; `refuse` it.

        `meanwhile()` is called again and again.
        """

        def heard():
            meanwhile()
            return self._heard > -inf

        left = self._since + _LISTENING - time.monotonic()
        self._node.spin_until(heard, max(left, _LOOK))
        if self._heard > -inf:
            self._node.spin_until(lambda: self.ahead, _AGAIN)
        self.refuse()

    def refuse(self):
        """Raise `NodeError` if there is one that is ahead."""
        if self.ahead:
            raise NodeError(
                f"another simulator publishes {self._topic} in this ROS domain; set another ROS_DOMAIN_ID or namespace"
            )

    def start_anew(self):
        """Note, before it happens, that the node's own time goes back to zero."""
        self._own = max(self._own, self._time())

    def _on_clock(self, message):
        if message.clock.sec * NANO + message.clock.nanosec > max(self._own, self._time()):
            before, self._heard = self._heard, time.monotonic()
            self.ahead |= self._heard - before < _AGAIN


class RecorderLag:
    """Follows how far the recorder has written, so that no message is lost however slow it is.

    A writer holds its last messages only (ours 1000, others perhaps 10) and nothing but the pace of the loop keeps it
    from making more. So the loop waits until both samples and answers are written.
    """

    def __init__(self, node, period, time, heard):
        """Listen to the recorder.

        `period` is the loop's [ns], `time()` the simulated time [ns], `heard()` the latest sample [ns] that somebody
        has answered.
        """
        self._node, self._lag, self._time, self._heard = node, _LAG * period, time, heard
        # times up to which it has written, ns; unknown without a recorder
        self._recorded = {topics.RECORDED: None, topics.RECORDED_ANSWERS: None}
        for topic in self._recorded:
            on_recorded = partial(self._on_recorded, topic)
            node.listen(Time, topic, on_recorded, LATCHED_QOS)
        self._topics = set()  # full names of those that it records
        node.listen(String, topics.RECORDED_TOPICS, self._on_topics, LATCHED_QOS)

    @property
    def there(self):
        """Whether a recorder has said that all its subscriptions stand."""
        return None not in self._recorded.values()

    @property
    def reached(self):
        """Whether it is there and what the node publishes from now on reaches it.

        That its subscriptions know the node's publishers does not mean that these know them, too.
        """
        if not (self.there and self._topics):
            return False
        publishers = publishing_nodes(self._node, [self._node.resolve_topic_name(topics.RECORDED)])
        mine = {publisher.topic_name for publisher in self._node.publishers} & self._topics
        return any(_hears(self._node, recorder, mine) for recorder in filter(is_known, publishers))

    def wait(self):
        """Hold the loop while the recorder is too far behind; one that stands still is no longer waited for."""
        self._hold(self._lag)

    def complete(self):
        """Hold until the recorder has written all there is."""
        self._hold(0)

    def complete_in_time(self):
        """Wait until it has written all there is, even when the node shall stop, but not for long."""
        if self.there:
            self._node.patience.wait_until(lambda: self._behind() <= 0, _LAST)

    def start_anew(self):
        """Note that time has gone back to zero."""
        for topic, stamp in self._recorded.items():
            if stamp is not None and stamp != END_OF_TIME:
                self._recorded[topic] = 0

    def _hold(self, lag):
        while self.there and self._behind() > lag and not self._node.stopping():
            before = self._recorded.copy()
            if self._node.spin_until(lambda before=before: self._recorded != before, _TIMEOUT):
                continue
            if not self._node.stopping():
                self._recorded = dict.fromkeys(self._recorded)
                self._node.get_logger().warning(
                    "the recorder does not keep up, no longer waiting for it; messages may be lost"
                )

    def _behind(self):
        """How far the recorder is behind [ns]: with the samples, or with the answers to them."""
        samples, answers = self._recorded[topics.RECORDED], self._recorded[topics.RECORDED_ANSWERS]
        return max(self._time() - samples, self._heard() - answers)

    def _on_topics(self, names):
        self._topics = set(names.data.split("\n"))

    def _on_recorded(self, topic, written):
        stamp = written.sec * NANO + written.nanosec
        if 0 <= stamp <= self._time() or stamp == END_OF_TIME:  # else it speaks of the time before a reset
            self._recorded[topic] = stamp


def view_is_reached(node):
    """Return whether what the simulator's node publishes for a live view reaches one, in all its parts."""
    viewed = [node.resolve_topic_name(topic) for topic in _VIEWED]
    views = [name for name in subscribing_nodes(node, viewed[0]) if name.rpartition("/")[2].startswith(LIVE_VIEW)]
    return any(_hears(node, view, viewed) for view in views)


def _hears(node, name, topic_names):
    return all(name in subscribing_nodes(node, topic) for topic in topic_names)
