"""The simulator node: steps the vehicle, publishes what its sensors measure, and takes the currents that answer."""

import math
import sys
import time
from importlib import import_module
from importlib.util import find_spec

from geometry_msgs.msg import TwistStamped
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.listener import Refused
from mr_mount_controller.node_base.loop_node import LoopNode, NodeError, run_node
from mr_mount_controller.node_base.qos import LOOP_QOS, ROAD_QOS
from mr_mount_controller.node_base.scheduling import schedule
from trackvib_msgs.msg import RoadProfile

from ..numerics.units import NANO
from ..simulation.lockstep import Lockstep
from ..simulation.simulation import RunFailed
from .answers import Answers, misfits
from .health import health, summary
from .output import DIAGNOSTICS_RATE, SimulatorOutput
from .partners import Gathering, RecorderLag, SecondClock, view_is_reached
from .run_control import RunControl, services
from .simulator_parameters import PARAMETERS, prepare
from .timing import Lateness, PhaseClock

# where ROS 2 has the types of the standard simulation interfaces
_STANDARD = import_module(".standard_services", __package__) if find_spec("simulation_interfaces") else None
_REPEAT = 0.5  # s of wall time after which a run that stands still says so again
_ROAD_PATIENCE = 2.0  # s for the road of a run that begins anew


class SimulatorNode(LoopNode):
    """Lock-step or real-time master of the closed loop."""

    NAME, PARAMETERS = "simulator", PARAMETERS
    SERVICES = (*services("period"), *(_STANDARD.SERVICES if _STANDARD else ()))

    def __init__(self):
        super().__init__()
        s = self.settings
        self._waits_for_answers = s["pace"] == "lockstep"
        self._second_clock = SecondClock(self, self._time)  # it listens while the simulation is prepared
        self._simulation, usable, vehicle_text, drive_text = prepare(s)
        self._simulation.load()
        self._usable = usable
        self._begin_counts()
        self._warned = False  # of several controllers
        self._misfits = set()  # sentences on listeners that cannot hear, as they were said

        self._output = SimulatorOutput(self, self._simulation, vehicle_text, drive_text)
        self._answers = Answers(self, self._simulation.mounting.coils, self._on_answer, self.listen)
        self.listen(RoadProfile, topics.ROAD_PROFILE, self._on_road, ROAD_QOS)
        self.listen(TwistStamped, topics.CMD_VEL, self._on_command, LOOP_QOS)
        self._control = RunControl(self, self._time)
        standard = (self, self._control, self._simulation, vehicle_text)
        self._standard = _STANDARD.StandardServices(*standard) if _STANDARD else None
        period = self._simulation.settings.rates.period
        self._recorder = RecorderLag(self, period, self._time, lambda: self._heard) if s["wait_for_recorder"] else None

    def prepare(self, spin, stopping):
        """Take the executor's spin function and the stop flag, beside which a service may end the node."""
        super().prepare(spin, lambda: stopping() or self._control.quit_wanted)

    def _time(self):  # ns
        return self._simulation.time

    def _begin_counts(self):
        """Begin all that a run counts."""
        coils = self._simulation.mounting.coils
        self._lockstep = Lockstep(coils, self.settings["passive_current"], self._usable, self._waits_for_answers)
        self._phases = PhaseClock("physics", "publishing", "answer", "holding")
        self._lateness = Lateness()  # of the periods in real time
        self._silent = False  # no answer came in time; the loop runs on without waiting
        self._heard = self._heard_before = -1  # latest sample that somebody has answered, now and when silence fell, ns
        self._start = time.perf_counter()  # of the schedule in real time

    def run(self):
        """Wait for the partners, then run period after period until the duration is over or a stop is asked for."""
        schedule(self.settings)
        self._second_clock.listen()
        self._second_clock.refuse()
        self._output.introduce()
        self._wait_for_partners()
        self._second_clock.refuse()
        periods = math.ceil(self.settings["duration"] * self._simulation.settings.rates.control)
        self._control.state = "running"
        self._start = time.perf_counter()
        while not self.stopping() and (periods == 0 or self._simulation.periods < periods):
            if self._control.reset_wanted:
                self._start_anew()
            elif self._control.holding:
                self._pause()
            else:
                self._one_period()
        if self._recorder:
            self._recorder.complete()
        if not self.stopping():
            self._control.state = "finished"
            self.get_logger().info(summary(self._simulation, self._lockstep, self._phases))

    def close(self):
        """Say how it ended and let the last messages arrive."""
        if self._control.state in ("running", "paused"):
            self._control.state = "stopped"
        if self._recorder:
            self._recorder.complete_in_time()
        self._publish_diagnostics()
        self._output.flush()
        if self._standard:
            self._standard.close()

    def _start_anew(self):
        """Begin the next epoch: the first run over again, with everything at its start."""
        if self._recorder:
            self._recorder.complete()
        self._output.flush()  # what belongs to the old epoch arrives before it ends
        self._second_clock.start_anew()
        self._control.begin_epoch()
        self._simulation.reset()
        if self._recorder:
            self._recorder.start_anew()
        self._output.introduce()
        self.spin_until(self._simulation.road_is_enough, _ROAD_PATIENCE)
        self._begin_counts()
        self.get_logger().info(f"epoch {self._control.epoch}: the run restarts")
        self._publish_diagnostics()

    def _pause(self):
        began = time.perf_counter()
        if self._recorder:
            self._recorder.complete()
        self._control.state = "paused"  # only now: who is told so may stop the other nodes
        self._stand_until(lambda: not self._control.holding)
        self._control.state = "running"
        self._start += time.perf_counter() - began
        self._publish_diagnostics()

    def _one_period(self):
        self._phases.start("holding")
        if not self._wait_for_road():
            return
        self._phases.start("physics")
        try:
            self._simulation.advance(self._lockstep.currents)
        except RunFailed as failure:
            self._control.state = "failed"
            raise NodeError(f"run failed: {failure}") from None
        self._phases.start("publishing")
        self._lockstep.publish(self._time())
        self._output.publish_sample()
        if self._simulation.periods % (self._simulation.settings.rates.control // DIAGNOSTICS_RATE) == 0:
            self._publish_diagnostics()
            self._second_clock.refuse()
        self._phases.start("answer" if self._waits_for_answers else "holding")
        if self._waits_for_answers:
            self._wait_for_answer()
            self._phases.start("holding")
            if self._recorder:
                self._recorder.wait()
        else:
            self._wait_for_wall_clock()
        self._phases.stop()
        self._control.end_period()

    # --- waiting ---

    def _wait_for_partners(self):
        """Wait until road, controller and recorder are there and nobody else has come for a moment."""
        others = ", a recorder" if self._recorder else ""
        others += ", a live view" if self.settings["wait_for_view"] else ""
        self.get_logger().info(
            f"waiting for a road on {topics.ROAD_PROFILE}, a controller that subscribes to {topics.CHASSIS_IMU} or "
            f"{topics.POWERTRAIN_IMU} and answers on {topics.COIL_CURRENT}{others}"
        )
        gathering = Gathering(self._present)
        self._stand_until(lambda: gathering.complete() or self._second_clock.ahead, self._tell_misfits)
        if not self.stopping():
            self.get_logger().info("all partners are present, running")

    def _present(self):
        recorder = self._recorder is None or self._recorder.reached
        view = not self.settings["wait_for_view"] or view_is_reached(self)
        listeners = sum(self._output.listeners())
        return self._simulation.road_is_enough(), self._answers.count(), listeners, recorder, view

    def _tell_misfits(self):
        """Say once who listens and cannot hear."""
        for misfit in set(misfits(self, self._output.loop_publishers)) - self._misfits:
            self._misfits.add(misfit)
            self.get_logger().warning(misfit)

    def _stand_until(self, condition, meanwhile=lambda: None):
        """Wait for a condition, a reset or a stop; every now and then say in which state and at what time."""
        while not (condition() or self._control.reset_wanted or self.stopping()):
            meanwhile()
            self._publish_diagnostics()
            self._output.publish_clock()
            self.spin_until(lambda: condition() or self._control.reset_wanted, _REPEAT)
        return condition()

    def _wait_for_road(self):
        """Return whether there is road for the next period; in lock-step wait for it."""
        if self._simulation.road_is_enough():
            return True
        where = f"at {self._simulation.distance:.1f} m (t = {self._time() / NANO:.3f} s)"
        if not self._waits_for_answers:
            self._control.state = "failed"
            raise NodeError(f"no road ahead {where}")
        self.get_logger().warning(f"no road ahead {where}, waiting for {topics.ROAD_PROFILE}")
        self._output.publish_odometry()
        self._control.state = "waiting"
        there = self._stand_until(self._simulation.road_is_enough)
        self._control.state = "running"
        return there

    def _wait_for_answer(self):
        answered = lambda: self._lockstep.answered  # noqa: E731
        if self._silent and self._heard == self._heard_before:
            self.spin_once(0.0)
            if not answered():
                self._lockstep.counts["silent_periods"] += 1
            return
        if self._silent:
            self.get_logger().info("the controller answers again, waiting for every answer")
        self._silent = False
        if not self.spin_until(answered, self.settings["answer_timeout"]) and not self.stopping():
            self._lockstep.counts["silent_periods"] += 1
            self._on_silence(f"no answer to the sample at t = {self._time() / NANO:.3f} s")

    def _wait_for_wall_clock(self):
        due = self._start + self._time() / NANO / self.settings["real_time_factor"]
        counts = self._lockstep.counts
        if time.perf_counter() > due + self._simulation.settings.rates.period / NANO:
            if not counts["overruns"]:
                self.get_logger().warning("this machine is slower than the requested pace; overruns are counted")
            counts["overruns"] += 1
        while (left := due - time.perf_counter()) > 0.0 and not self.stopping():
            self.spin_once(left)
        self._lateness.add(-left)
        before = None
        while before != counts:  # the latest current counts, so none may be left waiting
            before = counts.copy()
            self.spin_once(0.0)
        timeout = self.settings["answer_timeout"] * self.settings["real_time_factor"]
        silent = self._time() - self._lockstep.answered_stamp > timeout * NANO
        counts["silent_periods"] += silent
        if silent and not self._silent:
            self._on_silence(f"no answer since t = {self._lockstep.answered_stamp / NANO:.3f} s")
        self._silent = silent

    def _on_silence(self, what):
        policy = self.settings["on_silence"]
        self._silent, self._heard_before = True, self._heard
        if policy == "stop":
            self._control.state = "failed"
            raise NodeError(f"{what}; on_silence is 'stop'")
        if policy == "passive":
            self._lockstep.fall_back(self.settings["passive_current"])
        action = "holding the last current" if policy == "hold" else "falling back to the passive current"
        self.get_logger().warning(f"{what}; {action} until the controller answers again")
        self._publish_diagnostics()

    # --- messages ---

    def _on_answer(self, answer):
        _, stamp, currents = answer
        # who is late is on the way back; who repeats itself or makes no sense is not
        if self._lockstep.offer(stamp, currents) in ("accepted", "late"):
            self._heard = max(self._heard, stamp)

    def _on_road(self, patch):
        try:
            self._simulation.road.add(patch.start, patch.spacing, patch.left, patch.right)
        except ValueError as error:
            raise Refused(str(error)) from None

    def _on_command(self, message):
        speed, yaw_rate = message.twist.linear.x, message.twist.angular.z
        try:
            self._simulation.command(speed, yaw_rate)
        except ValueError as error:
            raise Refused(str(error)) from None
        self._output.publish_command(speed, yaw_rate)

    def _publish_diagnostics(self):
        controllers = self._answers.count()
        if controllers > 1 and not self._warned:
            self._warned = True
            self.get_logger().warning(f"{controllers} nodes answer on {topics.COIL_CURRENT}; the first answer is used")
        level, values = health(self._control, self._simulation, self._lockstep, self._phases, self._silent, controllers)
        values |= self._lateness.quantiles()
        values["refused"] = self.refused
        values["duration"] = self.settings["duration"]
        self._output.publish_diagnostics(level, values["state"], values)


def main(args=None):
    """Run the node."""
    sys.exit(run_node(SimulatorNode, args))
