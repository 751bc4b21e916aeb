"""Whom the simulator waits for at the start, and whom it watches then: another simulator, and the recorder."""

import time
from math import inf

from builtin_interfaces.msg import Time
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.loop_node import NodeError
from mr_mount_controller.node_base.qos import CLOCK_QOS, LATCHED_QOS
from rosgraph_msgs.msg import Clock

from ..numerics.units import NANO

# A message waits in a queue of 1000 at worst, so a recorder this far behind has lost nothing yet.
_LAG = NANO // 4  # ns of simulated time
_LISTENING = 0.7  # s in which a simulator that is there already makes itself known
_AGAIN = 1.0  # s after which one that stands still has told its time again
_TIMEOUT = 10.0  # s of wall time
_SETTLING = 0.3  # s without a new partner; a controller's two subscriptions are not found in the same instant


class Gathering:
    """Tells when all partners are there and nobody else has come for a moment."""

    def __init__(self, present):
        """`present()` returns one number a kind of partner: how many there are, or whether there is what it brings."""
        self._present = present
        self._seen, self._since = None, 0.0

    def complete(self):
        """Return whether it is time to begin."""
        now = self._present()
        if now != self._seen:
            self._seen, self._since = now, time.monotonic()
        return all(now) and time.monotonic() - self._since > _SETTLING


class SecondClock:
    """Notices another simulator in the ROS domain: of two, the one whose clock is behind gives way.

    A single message that is ahead is none: a clock goes on, and one that stands still repeats itself.
    """

    def __init__(self, node, simulated_time):
        """Listen to the clock; `simulated_time()` is the node's own simulated time [ns]."""
        self.ahead = False
        self._node, self._time = node, simulated_time
        self._heard = -inf  # wall time of the latest message that was ahead, s
        self._own = 0  # the latest time that the node has ever published, ns: its own clock goes back, too
        node.listen(Clock, topics.CLOCK, self._on_clock, CLOCK_QOS)

    def listen(self):
        """Listen for as long as a simulator that is there already needs to make itself known."""
        self._node.spin_until(lambda: self._heard > -inf, _LISTENING)
        if self._heard > -inf:
            self._node.spin_until(lambda: self.ahead, _AGAIN)

    def refuse(self):
        """Raise `NodeError` if there is one that is ahead."""
        if self.ahead:
            raise NodeError(f"another simulator drives {topics.CLOCK} in this ROS domain; set another ROS_DOMAIN_ID")

    def start_anew(self):
        """Note, before it happens, that the node's own time goes back to zero."""
        self._own = max(self._own, self._time())

    def _on_clock(self, message):
        if message.clock.sec * NANO + message.clock.nanosec > max(self._own, self._time()):
            before, self._heard = self._heard, time.monotonic()
            self.ahead |= self._heard - before < _AGAIN


class RecorderLag:
    """Follows how far the recorder has written, so that no message is lost however slow it is."""

    def __init__(self, node, time):
        """Listen to the recorder; `time()` is the simulated time [ns]."""
        self._node, self._time = node, time
        self._recorded = None  # time up to which it has written, ns; unknown without a recorder
        node.listen(Time, topics.RECORDED, self._on_recorded, LATCHED_QOS)

    @property
    def there(self):
        """Whether a recorder has said that all its subscriptions stand."""
        return self._recorded is not None

    def wait(self):
        """Hold the loop while the recorder is too far behind; one that does not catch up is no longer waited for."""
        if not self.there or self._near() or self._node.spin_until(self._near, _TIMEOUT) or self._node.stopping():
            return
        self._recorded = None
        self._node.get_logger().warning("the recorder does not keep up, no longer waiting for it; messages may be lost")

    def start_anew(self):
        """Note that time has gone back to zero."""
        if self.there:
            self._recorded = 0

    def _near(self):
        return self._time() - self._recorded <= _LAG

    def _on_recorded(self, written):
        stamp = written.sec * NANO + written.nanosec
        if 0 <= stamp <= self._time():  # else it speaks of the time before a reset
            self._recorded = stamp
