"""The recorder node: writes topics to an MCAP bag as they travel, with the parameters of the nodes behind them."""

import sys
import time
from datetime import datetime

from builtin_interfaces.msg import Time
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.loop_node import LoopNode, NodeError
from mr_mount_controller.node_base.node_process import run_node
from mr_mount_controller.node_base.plain_text import plain_line
from mr_mount_controller.node_base.qos import LATCHED_QOS
from mr_mount_controller.node_base.scheduling import stand_back
from rclpy.serialization import deserialize_message
from std_msgs.msg import String

from ..bags.errors import BagError
from ..bags.provenance import write_parameters, write_versions
from ..bags.timekeeping import Timekeeping
from ..bags.writing import BagWriter
from ..numerics.units import NANO
from .graph import is_known, publishing_nodes
from .messages import message_type
from .provenance import parameters_of
from .recorder_parameters import PARAMETERS
from .topic_choice import TopicChoice, subscribe

_NAMES_TIMEOUT = 3.0  # s
_REST = 0.005  # s between looks, in which no loop comes as far ahead as it may, 100 periods
_FLUSH = 0.5  # s; a recorder that is killed loses this much and a look at most
_LOOK = 0.5  # s between looks for further topics
_QUIET = 0.2  # s without a message after which nothing more is expected at the end
_LAST = 2.0  # s that the end takes at most, should messages never cease; all that had arrived is taken long before


class RecorderNode(LoopNode):
    """Records raw messages; their time in the bag is the simulated time of their stamp.

    A bag holds one epoch: with time that goes back, its messages would be mixed with those of the run before.
    """

    NAME, PARAMETERS = "recorder", PARAMETERS

    def __init__(self):
        super().__init__()
        self._choice = TopicChoice(self, self.settings["topics"], self.settings["pattern"])
        self._path = self.settings["bag"] or f"bag_{datetime.now():%Y%m%dT%H%M%S}"
        self._epoch = 1
        self._bag = None
        self._topics = {}  # what the bag is told of each, by name
        self._refused = set()  # topics found by the pattern that cannot be recorded
        self._taken = []  # subscriptions
        self._described = set()  # nodes whose parameters the bag at hand has
        self._undescribed = False  # whether there may be more
        self._times = Timekeeping()
        self._recorded = self.create_publisher(Time, topics.RECORDED, LATCHED_QOS)
        self._recorded_answers = self.create_publisher(Time, topics.RECORDED_ANSWERS, LATCHED_QOS)
        self._recorded_topics = self.create_publisher(String, topics.RECORDED_TOPICS, LATCHED_QOS)
        self._received = 0
        self._flushed = time.monotonic()

    def run(self):
        """Make the bag, wait for every topic, write down where it comes from, record until told to stop."""
        try:
            self._open(self._path)
            self.get_logger().info(plain_line(f"waiting for {self._choice}"))
            if self.spin_until(self._choice.complete):
                self._record()
        except OSError as error:
            raise self._given_up(error) from None

    def close(self):
        """Take what has arrived already, then complete the bag."""
        if self._bag is None:
            return
        try:
            last = now = time.monotonic()
            end = now + _LAST
            while now < min(last + _QUIET, end):
                arrived = self._take_all(_QUIET / 10)
                now = time.monotonic()
                last = now if arrived else last
            self._complete()
        except OSError as error:
            raise self._given_up(error) from None

    def _record(self):
        chosen = self._choice.present()
        # what is not a node never has a name
        self.spin_until(lambda: all(map(is_known, publishing_nodes(self, chosen))), _NAMES_TIMEOUT)
        self._describe(chosen)  # before the loop runs: it takes its time
        self._take_up(chosen)
        self.spin_until(lambda: all(each.get_publisher_count() for each in self._taken))
        stand_back()  # a recorder that is served at once takes the processor from the loop for every message
        self._report()  # whoever waits for a recorder starts with this
        self.get_logger().info(plain_line(f"recording {len(self._topics)} topics to {self._bag.path}"))
        looked = time.monotonic()
        while not self.stopping():
            if self._take_all():
                self._report()
            self._flush_in_time()
            seeking = self.settings["pattern"] or not set(chosen) <= set(self._topics)
            if seeking and time.monotonic() - looked > _LOOK:
                for name in self._take_up(self._choice.present()):
                    self.get_logger().info(f"{name} has appeared and is recorded")
                looked = time.monotonic()
            if self._undescribed:
                self._describe(self._topics)
            time.sleep(_REST)

    def _open(self, path):
        try:
            self._bag = BagWriter(path, self.settings["compression"], self.settings["chunk_size"] * 1024)
        except BagError as error:
            raise NodeError(str(error)) from None
        for topic in self._topics.values():
            self._announce(topic)
        write_versions(self._bag)

    def _complete(self):
        bag, self._bag = self._bag, None
        try:
            bag.close()
        except OSError as error:
            raise NodeError(f"bag {str(bag.path)!r} is not complete: {error.strerror}") from None
        self.get_logger().info(plain_line(f"{bag.counts.total()} messages in {bag.path}"))

    def _given_up(self, error):
        path, self._bag = self._bag.path, None
        return NodeError(
            f"bag {str(path)!r} can no longer be written: {error.strerror}; `trackvib bag repair` repairs it"
        )

    def _begin_epoch(self):
        """Complete the bag and begin the next one, with the same topics."""
        self._complete()
        self._epoch += 1
        self._times, self._described, self._undescribed = Timekeeping(), set(), True
        self._open(f"{self._path}_epoch_{self._epoch}")
        self.get_logger().info(plain_line(f"the simulation has restarted, recording to {self._bag.path}"))

    def _describe(self, names):
        """Write down what makes the messages of some topics, where the bag does not have it yet."""
        self._undescribed = False
        for name in publishing_nodes(self, names):
            if name in self._described:
                continue
            self._described.add(name)
            parameters = parameters_of(self, name)
            if parameters is None:
                self.get_logger().warning(f"{name} does not report its parameters; they are missing in the bag")
            write_parameters(self._bag, name, parameters)

    def _take_up(self, names):
        """Subscribe to topics that are new; returns their names."""
        new = sorted(set(names) - set(self._topics) - self._refused)
        for name in new:
            try:
                taken = subscribe(self, name, self._on_message)
            except ValueError as error:
                if name in self._choice.named:
                    raise NodeError(f"{name} cannot be recorded: {error}") from None
                self._refused.add(name)
                self.get_logger().warning(plain_line(f"{name} is not recorded: {error}"))
                continue
            if taken is None:  # should it come back, it is new again
                continue
            topic, subscription = taken
            self._topics[name] = topic
            self._taken.append(subscription)
            self._announce(topic)
            self._undescribed = True
        taken = [name for name in new if name in self._topics]
        if taken:
            self._recorded_topics.publish(String(data="\n".join(self._topics)))
        return taken

    def _announce(self, topic):
        self._times.announce(topic.type_name)
        self._bag.add_topic(topic.name, topic.type_name, topic.qos, topic.type_hash)

    def _flush_in_time(self):
        """Hand over to the operating system what a kill must not cost, wherever the node waits at the moment."""
        now = time.monotonic()
        if now - self._flushed > _FLUSH:
            self._bag.flush()
            self._flushed = now
            self.stop_serving()  # should messages never cease

    def _report(self):
        for publisher, stamp in (
            (self._recorded, self._times.complete_until),
            (self._recorded_answers, self._times.answered_until),
        ):
            seconds, nanoseconds = divmod(stamp, NANO)
            publisher.publish(Time(sec=seconds, nanosec=nanoseconds))

    def _take_all(self, timeout=0.0):
        """Write all that has arrived, or does within `timeout` [s], until a flush is due; returns whether any has."""
        before = self._received
        self.serve(timeout)
        return self._received > before

    def _on_message(self, topic, data):
        if self._bag is None:
            return
        try:
            self._write(topic, data)
        except OSError as error:
            raise self._given_up(error) from None

    def _write(self, topic, data):
        time_in_bag = self._times.add(topic.name, topic.type_name, topic.stamped, data)
        if time_in_bag is None:
            self._begin_epoch()
            time_in_bag = self._times.add(topic.name, topic.type_name, topic.stamped, data)
        self._bag.write(topic.name, time_in_bag, data)
        self._received += 1
        self._flush_in_time()
        if topic.name.endswith(topics.VEHICLE_DESCRIPTION) and topic.type_name == topics.VEHICLE_DESCRIPTION_TYPE:
            self._bag.add_attachment("vehicle.yaml", deserialize_message(data, message_type(topic.type_name)).data)


def main(args=None):
    """Run the node."""
    sys.exit(run_node(RecorderNode, args))
