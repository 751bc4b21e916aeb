"""The player node: publishes a bag's messages as they were recorded, at the times of their stamps."""

import sys
import time
from collections import deque
from fnmatch import fnmatchcase
from functools import partial
from itertools import groupby

from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.loop_node import LoopNode, NodeError
from mr_mount_controller.node_base.node_process import run_node
from mr_mount_controller.node_base.parameters import ParameterError
from mr_mount_controller.node_base.plain_text import readable
from mr_mount_controller.node_base.qos import CLOCK_QOS
from mr_mount_controller.node_base.topics import CLOCK
from rclpy.duration import Duration
from rclpy.exceptions import NameValidationException
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rosgraph_msgs.msg import Clock

from ..bags.errors import BagError
from ..bags.limits import largest_chunk
from ..bags.playing import OpenBag
from ..numerics.units import NANO
from .messages import message_type
from .older_messages import renewal
from .partners import Gathering
from .player_parameters import PARAMETERS
from .run_control import RunControl, services

_DEPTH = 1000  # messages that may wait, or are kept for late joiners; the bag does not tell
_PLAYED = ("cdr", "")  # encodings of messages; of older recorders' it is not told
_CLOCK_STEP = NANO // 100  # ns
_FLUSH = Duration(seconds=2)  # for the last messages to arrive
_REPEAT = 0.5  # s of wall time after which a player that stands still tells the time again


class PlayerNode(LoopNode):
    """Plays a bag; pause, resume, step and reset are those of the simulator, a step being one instant of the bag.

    Topics are published by their relative names, so that they can be remapped and put into a namespace. `clock` is the
    player's own, whether there is one in the bag or not.
    """

    NAME, PARAMETERS = "player", PARAMETERS
    SERVICES = services("instant of the bag")

    def __init__(self):
        super().__init__()
        self._control = RunControl(self, lambda: self._time)
        largest_chunk.set(self.settings["largest_chunk"])
        try:
            if not self.settings["bag"]:
                raise ParameterError("player: parameter 'bag' is empty, accepted: the path of a bag")
            self._bag = OpenBag(self.settings["bag"], self._is_wanted)
        except BagError as error:
            raise NodeError(str(error)) from None
        self._time, self._end = self._span()
        self._begin = self._time
        self._outputs = {}  # by topic in the bag
        self._renewals = {}  # of connections whose type has changed since, by their numbers
        self._misfits = set()  # topics with messages that cannot be played
        self._connections = self._playable(self._chosen())
        self._clock_out = self.create_publisher(Clock, CLOCK, CLOCK_QOS)
        self._origin = 0.0  # wall time at which the time of the bag would be zero, s

    def run(self):
        """Wait until somebody listens, then play until the end or a stop."""
        names = sorted(publisher.topic_name for publisher in self._outputs.values())  # as remapped
        self.get_logger().info(f"waiting for a subscriber to {', '.join(names)}")
        gathering = Gathering(self._subscribers)
        self.spin_until(gathering.complete)
        while not self.stopping():
            self._control.state = "running"
            self._play()
            if not (self._control.reset_wanted or self.settings["loop"]):
                break
            self._control.begin_epoch()
        if not self.stopping():
            self.get_logger().info(f"played up to {self._time / NANO:.3f} s")
            for publisher in self._outputs.values():
                publisher.wait_for_all_acked(_FLUSH)

    def close(self):
        """Close the bag."""
        self._bag.close()

    def _span(self):
        """Return begin and end [ns] in the time of the bag."""
        first, last = self._bag.start, self._bag.end
        length = (last - first) / NANO
        start, end = self.settings["start"], self.settings["end"] or length
        if start > length:
            raise ParameterError(f"player: parameter 'start' is {start} s, accepted: 0 to {length:g} s in this bag")
        if not start <= end:
            raise ParameterError(f"player: parameter 'end' is {end} s, accepted: 0 or from start, {start} s, on")
        return first + round(start * NANO), min(first + round(end * NANO), last)

    def _is_wanted(self, topic):
        return topic.removeprefix("/") != CLOCK and any(map(partial(_matches, topic), self.settings["topics"]))

    def _chosen(self):
        there = sorted({connection.topic for connection in self._bag.connections})
        for pattern in self.settings["topics"]:
            if not any(_matches(topic, pattern) for topic in there):
                raise ParameterError(
                    f"player: parameter 'topics': the bag has no topic {pattern.removeprefix('/')!r}, "
                    f"it has {', '.join(there)}"
                )
        return [connection for connection in self._bag.connections if self._is_wanted(connection.topic)]

    def _playable(self, connections):
        """Make publishers, and return the connections that can be played; the others are named once."""
        played, left_out = [], {}
        for connection in connections:
            try:
                self._prepare_output(connection)
            except (ValueError, NameValidationException) as error:
                left_out.setdefault(connection.topic, str(error).splitlines()[0])
            else:
                played.append(connection)
        for topic, reason in left_out.items():
            self.get_logger().warning(f"{readable(topic)} is left out: {readable(reason)}")
        if connections and not played:
            raise NodeError(f"nothing in bag {self.settings['bag']!r} can be played")
        return played

    def _prepare_output(self, connection):
        """Make what plays a connection; raises ValueError or NameValidationException where nothing can."""
        if connection.encoding not in _PLAYED:
            raise ValueError(f"its messages are in {connection.encoding!r}, accepted: cdr")
        kind = message_type(connection.type_name)
        renew = renewal(connection.schema, kind)
        output = self._outputs.get(connection.topic)
        if output is None:
            output = self.create_publisher(kind, connection.topic.removeprefix("/"), _qos(connection))
            self._outputs[connection.topic] = output
        elif output.msg_type is not kind:
            raise ValueError(f"{connection.type_name} is a second type on this topic")
        if renew:
            self._renewals[connection.number] = renew

    def _subscribers(self):
        return [sum(publisher.get_subscription_count() for publisher in self._outputs.values())]

    def _play(self):
        """Play from begin to end once, or until a stop or a reset is wanted."""
        self._time, tick = self._begin, self._begin
        self._publish_earlier()
        self._origin = time.perf_counter() - self._begin / NANO / self.settings["rate"]
        messages = self._bag.messages(self._connections, start=self._begin, stop=self._end + 1)
        for stamp, instant in groupby(messages, key=lambda message: message[1]):
            while tick < stamp:
                if not self._wait_until(tick):
                    return
                self._publish_clock()
                tick += _CLOCK_STEP - tick % _CLOCK_STEP
            if not self._wait_until(stamp):
                return
            for connection, _, data in instant:
                self._publish(connection, data)
            self._control.end_period()
        if self._wait_until(self._end):
            self._publish_clock()

    def _publish_earlier(self):
        """Publish what was kept for late joiners before the begin."""
        latched = [connection for connection in self._connections if connection.is_latched]
        if self._begin == self._bag.start or not latched:
            return
        kept = {connection.topic: deque(maxlen=_DEPTH) for connection in latched}
        for connection, _, data in self._bag.messages(latched, stop=self._begin):
            kept[connection.topic].append((connection, data))
        for messages in kept.values():
            for connection, data in messages:
                self._publish(connection, data)

    def _publish(self, connection, data):
        if renew := self._renewals.get(connection.number):
            try:
                data = renew(data)
            except LayoutError as error:
                self._leave_out(connection, error)
                return
        self._outputs[connection.topic].publish(data)

    def _leave_out(self, connection, error):
        """Say once a topic that a message of it cannot be played."""
        if connection.topic not in self._misfits:
            self._misfits.add(connection.topic)
            self.get_logger().warning(
                f"a message on {connection.topic} is left out, it does not match {connection.type_name}: {error}; "
                "further ones are counted only"
            )

    def _wait_until(self, stamp):
        """Wait for a time of the bag [ns], however long the player is paused; returns whether to go on."""
        self.spin_once(0.0)
        while not (self.stopping() or self._control.reset_wanted):
            if self._control.holding:
                self._pause()
                continue
            left = self._origin + stamp / NANO / self.settings["rate"] - time.perf_counter()
            if left <= 0.0:
                self._time = stamp
                return True
            self.spin_once(min(left, _REPEAT))
        return False

    def _pause(self):
        began = time.perf_counter()
        go_on = lambda: not self._control.holding or self._control.reset_wanted  # noqa: E731
        while not (go_on() or self.stopping()):
            self._publish_clock()
            self.spin_until(go_on, _REPEAT)
        self._origin += time.perf_counter() - began

    def _publish_clock(self):
        seconds, nanoseconds = divmod(self._time, NANO)
        message = Clock()
        message.clock.sec, message.clock.nanosec = seconds, nanoseconds
        self._clock_out.publish(message)


def _matches(topic, pattern):
    return fnmatchcase(topic.removeprefix("/"), pattern.removeprefix("/"))


def _qos(connection):
    qos = QoSProfile(depth=_DEPTH)
    if connection.is_latched:
        qos.durability = QoSDurabilityPolicy.TRANSIENT_LOCAL
    if connection.is_best_effort:
        qos.reliability = QoSReliabilityPolicy.BEST_EFFORT
    return qos


def main(args=None):
    """Run the node."""
    sys.exit(run_node(PlayerNode, args))
