"""The recorder node: writes topics to an MCAP bag as they travel, with the parameters of the nodes behind them."""

import os
import sys
import time
from datetime import datetime
from importlib import import_module

from builtin_interfaces.msg import Time
from mr_mount_controller.node_support import LATCHED_QOS, LoopNode, NodeError, run_node
from mr_mount_controller.parameters import Parameter, ParameterError
from rclpy.exceptions import InvalidTopicNameException
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.validate_topic_name import validate_topic_name

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
    Parameter(
        "bag",
        "",
        "Folder of the bag; empty for bag_<date and time> where the node was started. Each further epoch goes to one "
        "of its own, <bag>_epoch_2 and so on.",
    ),
    Parameter("topics", DEFAULT_TOPICS, "Topics to record; recording starts when all of them are there."),
)
# Their stamps are the simulation's own time, and go up by so many ns at least from message to message of one topic. If
# they do not, the simulation has begun anew.
_TIMEKEEPERS = {"sensor_msgs/msg/Imu": 1, "rosgraph_msgs/msg/Clock": 0, "nav_msgs/msg/Odometry": 0}
_DEPTH = 1000  # messages that may wait
_SERVICE_TIMEOUT = 2.0  # s, for a node to tell its parameters
_UNKNOWN = "_NODE_NAME_UNKNOWN_"  # rmw's word for it
_NAMES_TIMEOUT = 3.0  # s
_REST = 0.02  # s between looks; waking for every message would take the processor from the loop
_NICE = 10
_QUIET = 0.2  # s without a message after which nothing more is expected at the end


class RecorderNode(LoopNode):
    """Records raw messages; their time in the bag is the simulated time of their stamp.

    A bag holds one epoch: with time that goes back, its messages would be mixed with those of the run before.
    """

    def __init__(self):
        super().__init__("recorder", PARAMETERS)
        self._wanted = self._resolve(self.settings["topics"])
        self._path = self.settings["bag"] or f"bag_{datetime.now():%Y%m%dT%H%M%S}"
        self._epoch = 1
        self._bag = None
        self._topics = []  # what the bag is told of each
        self._described = False  # the bag at hand knows what makes its messages
        self._times = {}  # latest stamp of each timekeeper in this epoch, ns
        self._recorded = self.create_publisher(Time, topics.RECORDED, LATCHED_QOS)
        self._matched = []  # one function a subscription: whether a publisher is connected
        self._latest = 0  # stamp, ns
        self._received = 0

    def run(self):
        """Make the bag, wait for every topic, write down where it comes from, record until told to stop."""
        self._bag = self._new_bag(self._path)
        self.get_logger().info(f"waiting for {', '.join(sorted(self._wanted))}")
        if not self.spin_until(lambda: all(map(self.get_publishers_info_by_topic, self._wanted))):
            return
        # names of nodes come a moment after their publishers; what is not a node never has one
        self.spin_until(lambda: not any(_UNKNOWN in name for name in self._publishing_nodes()), _NAMES_TIMEOUT)
        self._describe()
        for topic in sorted(self._wanted):
            self._subscribe(topic)
        self.spin_until(lambda: all(matched() for matched in self._matched))
        self._report()  # whoever waits for a recorder starts with this
        self.get_logger().info(f"recording {len(self._wanted)} topics to {self._bag.path}")
        while not self.stopping():
            if self._take_all():
                self._report()
            if not self._described:
                self._describe()
            time.sleep(_REST)

    def _new_bag(self, path):
        try:
            return BagWriter(path)
        except BagError as error:
            raise NodeError(str(error)) from None

    def _describe(self):
        """Write down what makes the messages."""
        self._described = True
        self._bag.add_provenance("versions", versions())
        for name in self._publishing_nodes():
            self._bag.add_provenance(f"parameters of {name}", self._parameters_of(name))

    def _begin_epoch(self):
        """Complete the bag and begin the next one, with the same topics."""
        self._complete()
        self._epoch += 1
        self._bag = self._new_bag(f"{self._path}_epoch_{self._epoch}")
        for topic in self._topics:
            self._bag.add_topic(*topic)
        self._described, self._times, self._latest = False, {}, 0
        self.get_logger().info(f"the simulation has begun anew, recording to {self._bag.path}")

    def _report(self):
        seconds, nanoseconds = divmod(self._latest, NANO)
        self._recorded.publish(Time(sec=seconds, nanosec=nanoseconds))

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
        if self._bag is None:
            return
        last = time.monotonic()
        while time.monotonic() - last < _QUIET:
            self.spin_once(_QUIET / 10)
            if self._take_all():
                last = time.monotonic()
        self._complete()

    def _complete(self):
        try:
            self._bag.close()
        except OSError as error:
            raise NodeError(f"bag {str(self._bag.path)!r} is not complete: {error.strerror}") from None
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
        self._topics.append(
            (topic, type_name, [qos_record(offer) for offer in offers], str(infos[0].topic_type_hash))
        )
        self._bag.add_topic(*self._topics[-1])
        package, kind, name = type_name.split("/")
        message_type = getattr(import_module(f"{package}.{kind}"), name)
        first_field = next(iter(message_type.get_fields_and_field_types().values()))
        stamped = first_field in ("std_msgs/Header", "builtin_interfaces/Time")
        least_step = _TIMEKEEPERS.get(type_name)
        subscription = self.create_subscription(
            message_type, topic, lambda data: self._on_message(topic, stamped, least_step, data), qos, raw=True
        )
        self._matched.append(lambda: subscription.get_publisher_count() > 0)

    def _on_message(self, topic, stamped, least_step, data):
        stamp = leading_stamp(data) if stamped else 0
        if least_step is None or stamp < least_step:
            stamp = stamp or self._latest  # a stamp of zero is one that nobody filled in
        else:
            if stamp < self._times.get(topic, 0) + least_step:
                self._begin_epoch()
            self._times[topic] = stamp
            self._latest = max(self._latest, stamp)
        self._write(topic, stamp, data)
        self._received += 1

    def _write(self, topic, stamp, data):
        try:
            self._bag.write(topic, stamp, data)
        except OSError as error:
            path, self._bag = self._bag.path, None
            raise NodeError(f"bag {str(path)!r} cannot be written any more: {error.strerror}") from None

    def _resolve(self, names):
        try:
            return {self.resolve_topic_name(name) for name in names if validate_topic_name(name)}
        except InvalidTopicNameException as error:
            raise ParameterError(f"recorder: parameter 'topics' is {names!r}, accepted are names: {error}") from None

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
