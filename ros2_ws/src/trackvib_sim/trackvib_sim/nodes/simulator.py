"""The simulator node: steps the vehicle, publishes what its sensors measure, and takes the currents that answer."""

import math
import sys
import time

from builtin_interfaces.msg import Time
from mr_mount_controller.node_support import LATCHED_QOS, LOOP_QOS, LoopNode, NodeError, run_node
from mr_mount_controller.packed_message import MessageReader
from rosgraph_msgs.msg import Clock
from trackvib_msgs.msg import CoilCurrent, RoadProfile

from ..simulation.exchange import Exchange
from ..simulation.settings import NANO
from ..simulation.simulation import RunFailed
from ..vehicle.mount_audit import mount_account
from . import topics
from .output import SimulatorOutput
from .qos import CLOCK_QOS, ROAD_QOS
from .simulator_parameters import PARAMETERS, prepare
from .timing import PhaseClock

_DIAGNOSTICS_RATE = 10  # Hz of simulated time
# A message waits in a queue of 1000 at worst, so a recorder this far behind has lost nothing yet.
_RECORDER_LAG = NANO // 4  # ns of simulated time
_RECORDER_TIMEOUT = 10.0  # s of wall time
_LISTENING = 0.7  # s in which a simulator that is there already makes itself known
_SETTLING = 0.3  # s without a new partner; a controller's two subscriptions are not found in the same instant


class SimulatorNode(LoopNode):
    """Lock-step or real-time master of the closed loop."""

    def __init__(self):
        super().__init__("simulator", PARAMETERS)
        s = self.settings
        self._lockstep = s["pace"] == "lockstep"
        self._simulation, usable, vehicle_text = prepare(s)
        self._exchange = Exchange(s["passive_current"], usable, self._lockstep)
        self._phases = PhaseClock("physics", "publishing", "answer", "holding")
        self._clock_ahead = False  # somebody else's clock; of two simulators the one that is behind gives way
        self._silent = False  # no answer came in time; the loop runs on without waiting
        self._heard = False  # some answer came since
        self._warned = False  # of several controllers
        self._recorded = None  # time up to which the recorder has written, ns; unknown without one
        self._state = "waiting"

        self._output = SimulatorOutput(self, self._simulation, vehicle_text)
        self._answer = MessageReader(CoilCurrent, {"sample_stamp": "iI", "current": "2d"})
        self._answers = self.create_subscription(CoilCurrent, topics.COIL_CURRENT, self._on_answer, LOOP_QOS, raw=True)
        self.create_subscription(RoadProfile, topics.ROAD_PROFILE, self._on_road, ROAD_QOS)
        self.create_subscription(Clock, topics.CLOCK, self._on_clock, CLOCK_QOS)
        if s["wait_for_recorder"]:
            self.create_subscription(Time, topics.RECORDED, self._on_recorded, LATCHED_QOS)

    def run(self):
        """Wait for the partners, then run period after period until the duration is over or a stop is asked for."""
        self.spin_until(lambda: self._clock_ahead, _LISTENING)
        self._refuse_second_clock()
        self._output.introduce()
        self._wait_for_partners()
        self._refuse_second_clock()
        periods = math.ceil(self.settings["duration"] * self._simulation.settings.rates.control)
        start = time.perf_counter()
        self._state = "running"
        while not self.stopping() and (periods == 0 or self._simulation.periods < periods):
            self._one_period(start)
        if not self.stopping():
            self._state = "finished"
            self.get_logger().info(self._summary())

    def close(self):
        """Say how it ended and let the last messages arrive."""
        if self._state == "running":
            self._state = "stopped"
        self._publish_diagnostics()
        self._output.flush()

    def _one_period(self, start):
        self._phases.start("holding")
        if not self._wait_for_road():
            return
        self._phases.start("physics")
        try:
            self._simulation.advance(self._exchange.currents)
        except RunFailed as failure:
            self._state = "failed"
            raise NodeError(f"run failed: {failure}") from None
        self._phases.start("publishing")
        self._exchange.publish(self._simulation.time)
        self._output.publish_sample()
        if self._simulation.periods % (self._simulation.settings.rates.control // _DIAGNOSTICS_RATE) == 0:
            self._publish_diagnostics()
            self._refuse_second_clock()
        self._phases.start("answer" if self._lockstep else "holding")
        if self._lockstep:
            self._wait_for_answer()
            self._phases.start("holding")
            self._wait_for_recorder()
        else:
            self._wait_for_wall_clock(start)
        self._phases.stop()

    # --- waiting ---

    def _wait_for_partners(self):
        """Wait until road, controller and recorder are there and nobody else has come for a moment."""
        recorder = self.settings["wait_for_recorder"]
        missing = [
            f"a road on {topics.ROAD_PROFILE}",
            f"a controller that listens to {topics.CHASSIS_IMU} or {topics.POWERTRAIN_IMU} and answers on "
            f"{topics.COIL_CURRENT}",
        ]
        self.get_logger().info("waiting for " + ", ".join([*missing, "a recorder"][: 2 + recorder]))
        seen, since = None, 0.0

        def complete():
            nonlocal seen, since
            listeners = self._output.listeners()
            now = (self._simulation.road_is_enough(), self._answers.get_publisher_count(), *listeners)
            if now != seen:
                seen, since = now, time.monotonic()
            there = now[0] and now[1] > 0 and max(listeners) > 0 and (not recorder or self._recorded is not None)
            return there and time.monotonic() - since > _SETTLING

        self.spin_until(lambda: complete() or self._clock_ahead)
        if not self.stopping():
            self.get_logger().info("all partners are there, running")

    def _refuse_second_clock(self):
        if self._clock_ahead:
            raise NodeError(f"another simulator drives {topics.CLOCK} in this ROS domain; set another ROS_DOMAIN_ID")

    def _wait_for_road(self):
        """Return whether there is road for the next period; in lock-step wait until there is or a stop is asked for."""
        if self._simulation.road_is_enough():
            return True
        where = f"at {self._simulation.distance:.1f} m (t = {self._simulation.time / NANO:.3f} s)"
        if not self._lockstep:
            self._state = "failed"
            raise NodeError(f"no road ahead {where}")
        self.get_logger().warning(f"no road ahead {where}, waiting for {topics.ROAD_PROFILE}")
        self._output.publish_odometry()
        return self.spin_until(self._simulation.road_is_enough)

    def _wait_for_answer(self):
        answered = lambda: self._exchange.answered  # noqa: E731
        if self._silent and not self._heard:
            self.spin_once(0.0)
            if not answered():
                self._exchange.counts["silent_periods"] += 1
            return
        if self._silent:
            self.get_logger().info("the controller is heard again, waiting for every answer")
        self._silent = self._heard = False
        if not self.spin_until(answered, self.settings["answer_timeout"]) and not self.stopping():
            self._exchange.counts["silent_periods"] += 1
            self._on_silence(f"no answer to the sample at t = {self._simulation.time / NANO:.3f} s")

    def _wait_for_recorder(self):
        """Hold the loop while the recorder is too far behind, so that no message is lost however slow it is."""
        near = lambda: self._simulation.time - self._recorded <= _RECORDER_LAG  # noqa: E731
        if self._recorded is None or near() or self.spin_until(near, _RECORDER_TIMEOUT) or self.stopping():
            return
        self._recorded = None
        self.get_logger().warning("the recorder does not keep up, no longer waiting for it; messages may be lost")

    def _wait_for_wall_clock(self, start):
        due = start + self._simulation.time / NANO / self.settings["real_time_factor"]
        counts = self._exchange.counts
        if time.perf_counter() > due + self._simulation.settings.rates.period / NANO:
            if not counts["overruns"]:
                self.get_logger().warning("this machine is slower than the pace asked for; overruns are counted")
            counts["overruns"] += 1
        while (left := due - time.perf_counter()) > 0.0 and not self.stopping():
            self.spin_once(left)
        before = None
        while before != counts:  # the latest current counts, so none may be left waiting
            before = counts.copy()
            self.spin_once(0.0)
        timeout = self.settings["answer_timeout"] * self.settings["real_time_factor"]
        silent = self._simulation.time - self._exchange.answered_stamp > timeout * NANO
        counts["silent_periods"] += silent
        if silent and not self._silent:
            self._on_silence(f"no answer since t = {self._exchange.answered_stamp / NANO:.3f} s")
        self._silent = silent

    def _on_silence(self, what):
        policy = self.settings["on_silence"]
        self._silent, self._heard = True, False
        if policy == "stop":
            self._state = "failed"
            raise NodeError(f"{what}; on_silence is 'stop'")
        if policy == "passive":
            self._exchange.fall_back(self.settings["passive_current"])
        action = "holding the last current" if policy == "hold" else "falling back to the passive current"
        self.get_logger().warning(f"{what}; {action} until the controller is heard again")
        self._publish_diagnostics()

    # --- messages ---

    def _on_answer(self, data):
        seconds, nanoseconds, *currents = self._answer.read(data)
        # who is late is on the way back; who repeats itself or makes no sense is not
        self._heard |= self._exchange.offer(seconds * NANO + nanoseconds, currents) in ("accepted", "late")

    def _on_clock(self, message):
        self._clock_ahead |= message.clock.sec * NANO + message.clock.nanosec > self._simulation.time

    def _on_recorded(self, time_written):
        self._recorded = time_written.sec * NANO + time_written.nanosec

    def _on_road(self, patch):
        try:
            self._simulation.road.add(patch.start, patch.spacing, patch.left, patch.right)
        except ValueError as error:
            self.get_logger().error(f"road patch refused: {error}")

    def _publish_diagnostics(self):
        counts = self._exchange.counts
        level = "ok"
        controllers = self._answers.get_publisher_count()
        if controllers > 1 and not self._warned:
            self._warned = True
            self.get_logger().warning(f"{controllers} nodes answer on {topics.COIL_CURRENT}; the first answer counts")
        if self._silent or counts["saturated"] or controllers > 1:
            level = "warning"
        if self._state == "failed":
            level = "error"
        mounts = mount_account(self._simulation.state.audit)
        values = {
            "state": self._state,
            "time": self._simulation.time / NANO,
            "duration": self.settings["duration"],
            "controllers": controllers,
            "real_time_factor": round(self._phases.factor(self._simulation.time / NANO), 3),
            **counts,
            **{f"mount_{part}_J": energy for part, energy in mounts._asdict().items()},
            **{f"{phase}_us_per_period": cost for phase, cost in self._phases.costs().items()},
        }
        self._output.publish_diagnostics(level, self._state, values)

    def _summary(self):
        simulated = self._simulation.time / NANO
        costs = ", ".join(f"{phase} {cost:.0f} us" for phase, cost in self._phases.costs().items())
        counts = ", ".join(f"{count} {name}" for name, count in self._exchange.counts.items() if count)
        pace = f"{simulated:g} s simulated at {self._phases.factor(simulated):.2f} x real time; a period: {costs}"
        return f"{pace}; answers: {counts}"


def main(args=None):
    """Run the node."""
    sys.exit(run_node(SimulatorNode, args))
