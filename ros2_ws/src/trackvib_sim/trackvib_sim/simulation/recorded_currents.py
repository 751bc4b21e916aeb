"""Which current was in force in which period of a recorded run in lock-step."""

from copy import deepcopy

import numpy as np

from ..numerics.units import NANO
from ..vehicle.coil import drive_coils


class NotTold(ValueError):
    """The recording does not tell a current; the message says which."""


def currents_in_force(simulation, recording, on_silence):
    """Yield the demanded current (coils,) [A] in force in each period of a `bags.recording.Recording`.

    Before the next one is asked for, the simulation must have done the period.

    A period runs on the answer to the sample before it, the first one on the passive current. Where the simulator
    counted silence the answer may have come too late, or never, and `on_silence` decided; and of two answers the first
    one counted, which in the bag need not be the first. The recorded current in the coils tells which it was.

    Parameters
    ----------
    simulation : Simulation
        Not yet advanced; its coils show what currents have been in force.
    recording : bags.recording.Recording
        With mount states.
    on_silence : str
        "hold", "passive" or "stop".

    Raises
    ------
    NotTold
        When a current is asked for that the recording should tell but does not.
    """
    answers, counts = _RecordedAnswers(recording.answers), recording.loop_counts
    passive = held = np.full(simulation.mounting.coils, simulation.settings.passive_current)
    while True:
        yield held
        stamp = simulation.time
        candidates = answers.to(stamp)
        if not candidates and not _all_recorded(stamp, answers, counts):
            raise NotTold(
                f"no answer to the sample at t = {stamp / NANO:.3f} s is recorded, but the simulator may have had one"
            )
        if _silence_at(stamp, counts):
            candidates.append(passive if on_silence == "passive" else held)
        if not candidates:
            raise NotTold(f"no answer to the sample at t = {stamp / NANO:.3f} s is recorded, and no silence either")
        held = candidates[0] if len(candidates) == 1 else _likeliest(simulation, recording.mounts, candidates)


class _RecordedAnswers:
    """Answers by the sample to which they were given."""

    def __init__(self, answers):
        if answers is None:
            self._stamps, self._current = np.empty(0, np.int64), np.empty((0, 0))
            return
        order = np.argsort(answers.sample_stamp, kind="stable")  # of one sample, in the order of arrival
        self._stamps, self._current = answers.sample_stamp[order], answers.current[order]

    def to(self, stamp):
        """Return the different currents (coils,) [A] that were given to the sample of a stamp [ns], in their order."""
        different = []
        for current in self._current[slice(*np.searchsorted(self._stamps, (stamp, stamp + 1)))]:
            if np.isfinite(current).all() and not any(np.array_equal(current, known) for known in different):
                different.append(current)
        return different

    def count(self, stamp):
        """Return how many there are to samples up to a stamp [ns]."""
        return np.searchsorted(self._stamps, stamp, "right")


def _silence_at(stamp, counts):
    """Whether the simulator counted silent periods between what it reported before and after a stamp [ns]."""
    if not counts.stamp.size:
        return False
    before, after = np.searchsorted(counts.stamp, stamp, "left"), np.searchsorted(counts.stamp, stamp, "right")
    silent = counts.silent_periods
    return silent[min(after, len(silent) - 1)] > (silent[before - 1] if before else 0)


def _all_recorded(stamp, answers, counts):
    """Whether the simulator, when it reported next after a stamp [ns], had no more answers than are recorded.

    The last answers of a controller that is killed need not reach everybody.
    """
    if not counts.stamp.size:
        return False
    next_time = min(np.searchsorted(counts.stamp, stamp, "right"), len(counts.stamp) - 1)
    return counts.answers[next_time] <= answers.count(counts.stamp[next_time])


def _likeliest(simulation, mounts, candidates):
    """Return the one of several currents for the next period under which the coils come next to the record."""
    coil, rates = simulation.system.coil, simulation.settings.rates
    # a demand is seen once the driver's delay is over
    periods = 1 + coil.delay // rates.steps
    stamp = simulation.time + periods * rates.period
    row = np.searchsorted(mounts.stamp, stamp)
    if row == len(mounts.stamp) or mounts.stamp[row] != stamp:
        return candidates[0]

    def distance(current):
        coils = deepcopy(simulation.state.coils)
        for _ in range(periods * rates.steps):
            drive_coils(coil, current, coils)
        return np.abs(coils.current - mounts.current[row]).sum()

    return min(candidates, key=distance)
