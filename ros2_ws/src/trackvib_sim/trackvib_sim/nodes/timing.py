"""Where the wall time of a control period goes."""

from time import perf_counter


class PhaseClock:
    """Adds up the wall time spent in named phases."""

    def __init__(self, *phases):
        self._spent = dict.fromkeys(phases, 0.0)
        self._phase = None
        self._since = 0.0
        self._periods = 0

    def start(self, phase):
        """End the phase that runs and start another."""
        now = perf_counter()
        if self._phase is not None:
            self._spent[self._phase] += now - self._since
        self._phase, self._since = phase, now

    def stop(self):
        """End the phase that runs, and with it a period."""
        self.start(None)
        self._periods += 1

    def costs(self):
        """Return the mean wall time of each phase in a period [us], in order."""
        return {phase: round(1e6 * spent / max(self._periods, 1), 1) for phase, spent in self._spent.items()}

    def factor(self, simulated):
        """Return simulated time [s] per wall time spent; 0 before anything was."""
        return simulated / self.total() if self._periods else 0.0

    def total(self):
        """Return all wall time spent [s]."""
        return sum(self._spent.values())
