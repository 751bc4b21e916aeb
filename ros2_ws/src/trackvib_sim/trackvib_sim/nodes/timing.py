"""Where the wall time of a control period goes, and how late it begins in real time."""

from math import log
from time import perf_counter

import numpy as np

_LEAST, _STEP, _BINS = 1e-6, 0.02, 900  # s, and by which part one bin of latenesses ends after another: up to 65 s
_QUANTILES = (50, 99, 99.9)  # %


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


class Lateness:
    """Counts how late periods begin, to 2 %: a long run takes no more room than a short one."""

    def __init__(self):
        self._counts = np.zeros(_BINS, dtype=np.int64)

    def add(self, late):
        """Take note of a period that begins so much after its time [s]."""
        self._counts[min(int(log(max(late, _LEAST) / _LEAST) / _STEP), _BINS - 1)] += 1

    def quantiles(self):
        """Return by name the lateness [us] that so many percent of the periods stay below; nothing where none was."""
        total = np.cumsum(self._counts)
        if not total[-1]:
            return {}
        places = np.searchsorted(total, [share / 100.0 * total[-1] for share in _QUANTILES])
        ends = 1e6 * _LEAST * np.exp(_STEP * (places + 1))
        return {f"late_us_p{share}": round(float(end), 1) for share, end in zip(_QUANTILES, ends, strict=True)}
