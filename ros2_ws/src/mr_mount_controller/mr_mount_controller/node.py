"""The controller node: answers each pair of Imu messages with the coil current that a control law chooses."""

import sys
import time
from contextlib import contextmanager
from statistics import mean
from typing import NamedTuple

from rcl_interfaces.msg import ParameterEvent
from rclpy.duration import Duration
from rclpy.parameter import Parameter as RosParameter
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent, MountDescription

from .laws import find_law, known_laws
from .laws.base import LawError, Sample
from .laws.running import answer, changed_law, law_code, make_law, run_law_on
from .mounting import MOST_COILS, described, undescribed
from .node_base.cdr import NANO
from .node_base.listener import Refused
from .node_base.loop_node import LoopNode, NodeError
from .node_base.node_process import run_node
from .node_base.packed_message import MessageReader, PackedMessage
from .node_base.parameters import Parameter
from .node_base.patience import Patience
from .node_base.plain_text import plain_line
from .node_base.qos import LATCHED_QOS, LOOP_QOS, LOOP_WRITER_QOS
from .node_base.scheduling import SCHEDULING, schedule
from .node_base.topics import CHASSIS_IMU, COIL_CURRENT, LAW_PARAMETERS, MOUNT_DESCRIPTION, POWERTRAIN_IMU

PARAMETERS = (
    Parameter("law", "passive", "Control law: the name of an installed law, or package.module:Class."),
    Parameter("sample_rate", 1000.0, "Rate of the Imu messages.", "Hz", 10.0, 10000.0),
    Parameter(
        "coils", 0, f"Number of coils; 0: wait for {MOUNT_DESCRIPTION} and take it from there.", "", 0, MOST_COILS
    ),
    Parameter("wait_for_recorder", False, "Send no answer before a recorder has subscribed to the currents."),
    *SCHEDULING,
)
_PATIENCE = 10.0  # s of wall time for those who shall hear the answers
_GREATEST = 1e6  # m/s^2 or rad/s; no sensor measures more
_CLASH = 5  # wrong steps from the very first sample on are not gaps but another rate
_MANY, _OFF = 100, 0.05  # so many steps tell a rate that is off by more than this part
_RANGES = (0.5, 1.5), (0.0, 2.5)  # periods that a step takes without a lost sample, and with one; whole ms may look so


class Reading(NamedTuple):
    """What one sensor measured over a period."""

    stamp: int  # ns
    force: tuple  # specific force, m/s^2
    angular_velocity: tuple  # rad/s


def _reading(imu):
    """Return a `Reading` of what a `MessageReader` returns; `Refused` if no sensor measures that."""
    stamp, numbers = imu
    if not all(-_GREATEST <= number <= _GREATEST for number in numbers):  # NaN is not either
        raise Refused(f"a measured number of {numbers} is not finite or beyond {_GREATEST:g}")
    return Reading(stamp, tuple(numbers[3:]), tuple(numbers[:3]))


@contextmanager
def _law_ends_node():
    try:
        yield
    except LawError as error:
        raise NodeError(str(error)) from error


class ControllerNode(LoopNode):
    """Runs one law on the Imu messages of chassis and powertrain that carry the same stamp."""

    NAME, PARAMETERS = "controller", PARAMETERS

    def __init__(self):
        super().__init__()
        law = find_law(self.settings["law"])
        values = self.declare_changeable(law.parameters, self._change_law)
        self._period = round(NANO / self.settings["sample_rate"])
        self._law = make_law(law, self._period / NANO, values)
        self._chassis = self._powertrain = None  # latest readings
        self._last = None  # stamp answered last, ns
        self._sample = None  # the sample answered last
        self._steps = self._gaps = 0  # between samples, and those among them that were not about one period
        self._first = []  # steps, ns
        self._answer = None  # as it is sent, once the number of coils is known
        self._sent = b""  # the answer to `_sample`
        self._mounting = None  # not known yet
        self._missed = False  # whether somebody was told so
        self._currents = self.create_publisher(CoilCurrent, COIL_CURRENT, LOOP_WRITER_QOS)
        self._changes = self.create_publisher(ParameterEvent, LAW_PARAMETERS, LOOP_WRITER_QOS)
        for topic, on_imu in ((CHASSIS_IMU, self._on_chassis), (POWERTRAIN_IMU, self._on_powertrain)):
            imu = MessageReader(Imu, "header.stamp", {"angular_velocity": 3, "linear_acceleration": 3})
            self.listen(Imu, topic, on_imu, LOOP_QOS, imu.read)
        if self.settings["coils"]:
            self._begin_on(undescribed(self.settings["coils"]))
        else:
            self.listen(MountDescription, MOUNT_DESCRIPTION, self._on_description, LATCHED_QOS)

    @classmethod
    def parameters_by_title(cls):
        """Return those of the node, and those of each known law beside them."""
        laws = {name: find_law(name).parameters for name in known_laws()}
        of_laws = {f"with law:={name}, may change while it runs": own for name, own in laws.items() if own}
        return {**super().parameters_by_title(), **of_laws}

    def run(self):
        """Say what runs, wait for a simulator or vehicle, answer until told to stop."""
        schedule(self.settings)
        described_too = "" if self.settings["coils"] else f" and {MOUNT_DESCRIPTION}"
        self.get_logger().info(f"law '{self.settings['law']}', waiting for accelerations{described_too}")
        super().run()

    def close(self):
        """Let the last answer arrive, say what was done."""
        self._currents.wait_for_all_acked(Duration(seconds=1))
        if self._gaps:
            self.get_logger().warning(f"{self._gaps} gaps between the stamps of the samples")

    def _on_description(self, message):
        try:
            mounting = described(message)
        except ValueError as error:
            raise Refused(str(error)) from None
        if mounting != self._mounting:  # else a simulator says it again
            self._begin_on(mounting)
            self._pair()

    def _begin_on(self, mounting):
        self._mounting, self._last, self._sample = mounting, None, None
        with _law_ends_node():
            run_law_on(self._law, mounting)
        answer = CoilCurrent(current=[0.0] * mounting.coils)
        self._answer = PackedMessage(answer, {"current": (mounting.coils,)}, ("header.stamp", "sample_stamp"))
        self.get_logger().info(f"coils: {', '.join(mounting.names[: mounting.coils]) or 'none'}")

    def _change_law(self, values):
        """Go on with other values of the law's parameters, from the next sample on."""
        self._law = changed_law(self._law, values)
        event = ParameterEvent(node=self.get_fully_qualified_name())
        event.stamp.sec, event.stamp.nanosec = divmod(self._last or 0, NANO)
        event.changed_parameters = [
            RosParameter(name, value=value).to_parameter_msg() for name, value in values.items()
        ]
        self._changes.publish(event)
        told = ", ".join(f"{name} {value!r}" for name, value in values.items())
        self.get_logger().info(plain_line(f"law changed after t = {(self._last or 0) / NANO:.3f} s: {told}"))

    def _on_chassis(self, imu):
        self._chassis = _reading(imu)
        self._pair()

    def _on_powertrain(self, imu):
        self._powertrain = _reading(imu)
        self._pair()

    def _pair(self):
        chassis, powertrain = self._chassis, self._powertrain
        if chassis is None or powertrain is None or chassis.stamp != powertrain.stamp:
            return
        if self._mounting is None:
            self._miss_description()
            return
        self._chassis = self._powertrain = None
        stamp = chassis.stamp
        sample = Sample(
            stamp / NANO, chassis.force, chassis.angular_velocity, powertrain.force, powertrain.angular_velocity
        )
        if sample == self._sample:
            # Sent twice, or the first of a new run after the first of the old one. The law has had it, and nothing
            # after it, so the answer is the same.
            self._currents.publish(self._sent)
            return
        if self._last is None:
            self._wait_for_listeners()
        elif stamp <= self._last:
            self.get_logger().info("the sample stamps start again: law reset")
            with _law_ends_node(), law_code(self._law, f"when it was reset at t = {sample.time:.3f} s"):
                self._law.reset()
            self._wait_for_listeners()
        else:
            self._check_step(stamp - self._last)
        self._last, self._sample = stamp, sample
        with _law_ends_node():
            currents = answer(self._law, sample)
        self._sent = self._answer.fill(stamp, current=currents)
        self._currents.publish(self._sent)

    def _miss_description(self):
        if not self._missed:
            self._missed = True
            self.get_logger().warning(
                f"accelerations arrive, but no node publishes {MOUNT_DESCRIPTION} with the number of coils; "
                "without it, set parameter coils"
            )

    def _check_step(self, step):
        """Count a gap between samples; raise `NodeError` if they come at another rate altogether.

        Stamps of a vehicle waver, so only many steps tell a rate that is not far off.
        """
        self._steps += 1
        if len(self._first) < _MANY:
            self._first.append(step)
            if len(self._first) == _MANY:
                self._judge_rate()
        if 2 * abs(step - self._period) < self._period:
            return
        self._gaps += 1
        if self._gaps == self._steps == _CLASH:
            self._clash(step)
        if self._gaps == 1:
            self.get_logger().warning(f"samples {step / NANO} s apart, expected {self._period / NANO} s")

    def _judge_rate(self):
        """Raise `NodeError` if the first steps come at another rate, with what may be lost samples and without."""
        even, near = ([step for step in self._first if low <= step / self._period <= high] for low, high in _RANGES)
        if even and all(abs(mean(steps) / self._period - 1.0) > _OFF for steps in (even, near)):
            self._clash(mean(even))

    def _clash(self, step):
        raise NodeError(
            f"samples arrive {step / NANO} s apart ({NANO / step:g} Hz), sample_rate is "
            f"{self.settings['sample_rate']:g} Hz: the two rates conflict"
        )

    def _wait_for_listeners(self):
        self.get_logger().info("first sample received, sending answers")
        self._steps = self._gaps = 0
        self._first = []
        wanted = 1 + self.settings["wait_for_recorder"]
        # no callbacks are served here: the sample at hand is the one to answer
        heard = self._currents.get_subscription_count
        patience = Patience(lambda _: time.sleep(0.01))
        if not patience.wait_until(lambda: heard() >= wanted or self.stopping(), _PATIENCE):
            self.get_logger().warning(f"{heard()} of {wanted} have subscribed to the currents, sending answers anyway")


def main(args=None):
    """Run the node."""
    sys.exit(run_node(ControllerNode, args))
