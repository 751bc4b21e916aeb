"""Which current was in force in which period of a recorded run in lock-step."""

from collections import defaultdict
from copy import deepcopy

import numpy as np

from ..vehicle.coil import drive_coils
from .settings import NANO


class NotTold(ValueError):
    """The recording does not tell a current; the message says which."""


def currents_in_force(simulation, recording, on_silence):
    """Yield the demanded currents (2,) [A] in force in each period of a `bags.replaying.RecordedDrive`.

    A period runs on the answer to the sample before it, the first one on the passive current. Where the simulator
    counted silence the answer may have come too late, or never, and `on_silence` decided; and of two answers the first
    one counted, which in the bag need not be the first. The recorded current in the coils tells which it was.

    Parameters
    ----------
    simulation : Simulation
        Not yet advanced.
    recording : bags.replaying.RecordedDrive
    on_silence : str
        "hold", "passive" or "stop".

    Raises
    ------
    NotTold
        When a current is asked for that the recording should tell but does not.
    """
    answers = defaultdict(list)  # to each sample, in the order of arrival
    for stamp, current in zip(recording.answered.tolist(), recording.current, strict=True):
        if np.isfinite(current).all() and not any(np.array_equal(current, known) for known in answers[stamp]):
            answers[stamp].append(current)
    period, coils = simulation.settings.rates.period, _Coils(simulation, recording.mounts)
    passive = held = np.full(2, simulation.settings.passive_current)
    stamp = 0
    while True:
        coils.force(held)
        yield held
        stamp += period
        candidates = answers[stamp].copy()
        if _silence_at(stamp, recording.told):
            candidates.append(passive if on_silence == "passive" else held)
        if not candidates or not (answers[stamp] or _all_recorded(stamp, recording)):
            raise NotTold(
                f"no answer to the sample at t = {stamp / NANO:.3f} s is recorded, but the simulator may have had one"
            )
        held = candidates[0] if len(candidates) == 1 else coils.likeliest(candidates)


def _silence_at(stamp, told):
    """Whether the simulator counted silent periods between what it told before and after a stamp [ns]."""
    times, counts = told[:, 0], told[:, 1]
    before, after = np.searchsorted(times, stamp, "left"), np.searchsorted(times, stamp, "right")
    if not len(counts):
        return False
    return counts[min(after, len(counts) - 1)] > (counts[before - 1] if before else 0)


def _all_recorded(stamp, recording):
    """Whether the simulator, when it told next after a stamp [ns], had no more answers than are recorded up to then.

    The last answers of a controller that is killed need not reach everybody.
    """
    after = np.searchsorted(recording.told[:, 0], stamp, "right")
    time, _, had = recording.told[min(after, len(recording.told) - 1)]
    return had <= np.count_nonzero(recording.answered <= time)


class _Coils:
    """Driver and coils alone, on the currents that were in force, to be set beside what `mount_state` says of them."""

    def __init__(self, simulation, mounts):
        self._coil, self._steps = simulation.system.coil, simulation.settings.rates.steps
        self._period, self._mounts = simulation.settings.rates.period, mounts
        self._state = deepcopy(simulation.state.coils)
        self._waiting = []  # currents in force, a period each, that the coils have not followed yet
        self._periods = 0

    def force(self, current):
        """Put a current (2,) [A] in force for the next period."""
        self._waiting.append(current)
        self._periods += 1

    def likeliest(self, candidates):
        """Return the one of several currents for the next period under which the coils come next to the record."""
        for current in self._waiting:
            self._drive(self._state, current, 1)
        self._waiting.clear()
        # a demand is seen once the driver's delay is over
        periods = 1 + self._coil.delay // self._steps
        row = np.flatnonzero(self._mounts.stamp == (self._periods + periods) * self._period)
        if not row.size:
            return candidates[0]
        return min(candidates, key=lambda current: self._distance(current, periods, self._mounts.values[row[0], :2]))

    def _distance(self, current, periods, recorded):
        state = deepcopy(self._state)
        self._drive(state, current, periods)
        return float(np.abs(state.current - recorded).sum())

    def _drive(self, state, current, periods):
        for _ in range(periods * self._steps):
            drive_coils(self._coil, current, state)
