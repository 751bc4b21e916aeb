"""The simulator node: steps the vehicle, publishes what its sensors measure, and takes the currents that answer."""

import math
import sys
import time
from importlib import import_module
from importlib.util import find_spec

from geometry_msgs.msg import TwistStamped
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.listener import Refused
from mr_mount_controller.node_base.loop_node import LoopNode, NodeError
from mr_mount_controller.node_base.node_process import run_node
from mr_mount_controller.node_base.qos import LOOP_QOS, ROAD_QOS
from mr_mount_controller.node_base.scheduling import schedule
from trackvib_msgs.msg import RoadProfile

from ..numerics.units import NANO
from ..simulation.lockstep import Lockstep
from ..simulation.simulation import RunFailed
from .answers import Answers, DeafListeners
from .health import health, summary
from .output import DIAGNOSTICS_RATE, SimulatorOutput
from .pace import UntilAnswered, UntilDue
from .partners import Gathering, RecorderLag, SecondClock, view_is_reached
from .run_control import RunControl, services
from .silence import Silence
from .simulator_parameters import PARAMETERS, prepare
from .timing import PhaseClock

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
        self._simulation, self._usable, vehicle_text, drive_text = prepare(s)
        self._simulation.load()
        self._begin_counts()
        self._warned = False  # of several controllers

        self._output = SimulatorOutput(self, self._simulation, vehicle_text, drive_text)
        self._deaf = DeafListeners(self, self._output.loop_publishers)
        self._answers = Answers(self, self._simulation.mounting.coils, self._on_answer, self.listen)
        self.listen(RoadProfile, topics.ROAD_PROFILE, self._on_road, ROAD_QOS)
        self.listen(TwistStamped, topics.CMD_VEL, self._on_command, LOOP_QOS)
        self._control = RunControl(self, self._time)
        standard = (self, self._control, self._simulation, vehicle_text)
        self._standard = _STANDARD.StandardServices(*standard) if _STANDARD else None
        follow = self._simulation.settings.rates.period, self._time, lambda: self._silence.heard
        self._recorder = RecorderLag(self, *follow) if s["wait_for_recorder"] else None

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
        self._silence = Silence(self.settings["on_silence"], self.settings["passive_current"], self._lockstep)
        kind = UntilAnswered if self._waits_for_answers else UntilDue
        self._pace = kind(self, self._lockstep, self._silence, self._simulation)

    def run(self):
        """Wait for the partners, then run period after period until the duration is over or a stop is asked for."""
        schedule(self.settings)
        gathering = Gathering(lambda: (self._answers.count(), sum(self._output.listeners())), self._ready)
        self._second_clock.listen(gathering.look)
        self._output.introduce()
        self._wait_for_partners(gathering)
        self._second_clock.refuse()
        periods = math.ceil(self.settings["duration"] * self._simulation.settings.rates.control)
        self._control.state = "running"
        self._pace.start()
        try:
            while not self.stopping() and (periods == 0 or self._simulation.periods < periods):
                if self._control.reset_wanted:
                    self._start_anew()
                elif self._control.holding:
                    self._pause()
                else:
                    self._one_period()
        except NodeError:
            self._control.state = "failed"
            raise
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
        self._pace.postpone(time.perf_counter() - began)
        self._publish_diagnostics()

    def _one_period(self):
        self._phases.start("holding")
        if not self._wait_for_road():
            return
        self._phases.start("physics")
        try:
            self._simulation.advance(self._lockstep.currents)
        except RunFailed as failure:
            raise NodeError(f"run failed: {failure}") from None
        self._phases.start("publishing")
        self._lockstep.publish(self._time())
        self._output.publish_sample()
        if self._simulation.periods % (self._simulation.settings.rates.control // DIAGNOSTICS_RATE) == 0:
            self._publish_diagnostics()
            self._second_clock.refuse()
        self._phases.start(self._pace.PHASE)
        self._pace.wait()
        self._phases.start("holding")
        if self._recorder and self._waits_for_answers:
            self._recorder.wait()
        self._phases.stop()
        self._control.end_period()

    # --- waiting ---

    def _wait_for_partners(self, gathering):
        """Wait until road, controller and recorder are there and nobody else has come for a moment."""
        others = ", a recorder" * bool(self._recorder) + ", a live view" * self.settings["wait_for_view"]
        self.get_logger().info(
            f"waiting for a road on {topics.ROAD_PROFILE}, a controller that subscribes to {topics.CHASSIS_IMU} or "
            f"{topics.POWERTRAIN_IMU} and answers on {topics.COIL_CURRENT}{others}"
        )
        self._stand_until(lambda: gathering.complete() or self._second_clock.ahead, self._deaf.tell)
        if not self.stopping():
            self.get_logger().info("all partners are present, running")

    def _ready(self):
        recorder = self._recorder is None or self._recorder.reached
        view = not self.settings["wait_for_view"] or view_is_reached(self)
        return self._simulation.road_is_enough() and recorder and view

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
            raise NodeError(f"no road ahead {where}")
        self.get_logger().warning(f"no road ahead {where}, waiting for {topics.ROAD_PROFILE}")
        self._output.publish_odometry()
        self._control.state = "waiting"
        there = self._stand_until(self._simulation.road_is_enough)
        self._control.state = "running"
        return there

    def fall_silent(self, what):
        """Do what `on_silence` wants, after `what` was missed; raises `NodeError` where that is to stop."""
        self.get_logger().warning(self._silence.begin(what))
        self._publish_diagnostics()

    # --- messages ---

    def _on_answer(self, answer):
        _, stamp, currents = answer
        # who is late is on the way back; who repeats itself or makes no sense is not
        if self._lockstep.offer(stamp, currents) in ("accepted", "late"):
            self._silence.hear(stamp)

    def _on_road(self, patch):
        try:
            self._simulation.road.add(patch.start, patch.spacing, patch.left, patch.right)
        except ValueError as error:
            raise Refused(str(error)) from None

    def _on_command(self, message):
        command = message.twist.linear.x, message.twist.angular.z
        try:
            self._simulation.command(*command)
        except ValueError as error:
            raise Refused(str(error)) from None
        self._output.publish_command(*command)

    def _publish_diagnostics(self):
        controllers = self._answers.count()
        if controllers > 1 and not self._warned:
            self._warned = True
            self.get_logger().warning(f"{controllers} nodes answer on {topics.COIL_CURRENT}; the first answer is used")
        level, values = health(
            self._control, self._simulation, self._lockstep, self._phases, self._silence.now, controllers
        )
        values |= {**self._pace.told(), "refused": self.refused, "duration": self.settings["duration"]}
        self._output.publish_diagnostics(level, values["state"], values)


def main(args=None):
    """Run the node."""
    sys.exit(run_node(SimulatorNode, args))
