"""What the simulator waits for between two periods: the answer to its sample, or the wall clock."""

from time import perf_counter

from ..numerics.units import NANO
from .timing import Lateness


class UntilAnswered:
    """Lock-step: every sample is answered before the next one is taken."""

    PHASE = "answer"  # of the `PhaseClock`

    def __init__(self, node, lockstep, silence, simulation):
        """Take the simulator's node, its `Lockstep`, `Silence` and `Simulation`."""
        self._node, self._lockstep, self._silence, self._simulation = node, lockstep, silence, simulation
        self._timeout = node.settings["answer_timeout"]  # s

    def start(self):
        """Begin with the first period."""

    def postpone(self, pause):
        """Go on after a pause [s]."""

    def told(self):
        """Return what the diagnostics have besides, by name."""
        return {}

    def wait(self):
        """Wait for the answer, while somebody does answer."""
        answered = lambda: self._lockstep.answered  # noqa: E731
        if self._silence.lasts:
            self._node.spin_once(0.0)
            if not answered():
                self._lockstep.counts["silent_periods"] += 1
            return
        if self._silence.now:
            self._node.get_logger().info("the controller answers again, waiting for every answer")
            self._silence.end()
        if not self._node.spin_until(answered, self._timeout) and not self._node.stopping():
            self._lockstep.counts["silent_periods"] += 1
            self._node.fall_silent(f"no answer to the sample at t = {self._simulation.time / NANO:.3f} s")


class UntilDue:
    """Real time: each period begins when it is due, with the latest answer that there is."""

    PHASE = "holding"

    def __init__(self, node, lockstep, silence, simulation):
        """See `UntilAnswered`."""
        self._node, self._lockstep, self._silence, self._simulation = node, lockstep, silence, simulation
        self._factor = node.settings["real_time_factor"]  # simulated over wall time
        self._timeout = node.settings["answer_timeout"] * self._factor  # s, simulated
        self._period = simulation.settings.rates.period / NANO  # s
        self._lateness = Lateness()
        self._start = perf_counter()

    def start(self):
        """Begin the schedule with simulated time zero."""
        self._start = perf_counter()

    def postpone(self, pause):
        """Have all that follows begin later by the length of a pause [s]."""
        self._start += pause

    def told(self):
        """Return quantiles of how late periods began."""
        return self._lateness.quantiles()

    def wait(self):
        """Wait until the next period is due, take what has arrived, notice silence."""
        counts = self._lockstep.counts
        if self._left() < -self._period:
            if not counts["overruns"]:
                self._node.get_logger().warning("this machine is slower than the requested pace; overruns are counted")
            counts["overruns"] += 1
        while (left := self._left()) > 0.0 and not self._node.stopping():
            self._node.spin_once(left)
        self._lateness.add(-left)
        before = None
        while before != counts:  # the latest current counts, so none may be left waiting
            before = counts.copy()
            self._node.spin_once(0.0)
        self._look_for_silence()

    def _left(self):
        """Wall time until the end of the period is due [s]."""
        return self._start + self._simulation.time / NANO / self._factor - perf_counter()

    def _look_for_silence(self):
        answered = self._lockstep.answered_stamp
        if self._simulation.time - answered <= self._timeout * NANO:
            self._silence.end()
            return
        self._lockstep.counts["silent_periods"] += 1
        if not self._silence.now:
            self._node.fall_silent(f"no answer since t = {answered / NANO:.3f} s")
