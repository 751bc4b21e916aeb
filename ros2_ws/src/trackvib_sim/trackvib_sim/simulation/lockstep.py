"""Which current answers which sample: the rules of the lock-step, without any transport."""

from collections import Counter
from math import isfinite

import numpy as np

OUTCOMES = ("accepted", "late", "duplicate", "early", "not_finite", "saturated", "silent_periods", "overruns")


class Lockstep:
    """Judges each answer, the currents of all coils, against the samples that were published.

    In lock-step only the answer to the latest sample is accepted. In real time (`lockstep=False`) an answer to an
    older sample is used, too, as long as it is newer than the last one used; it counts as late all the same.

    Attributes
    ----------
    currents : (coils,) array
        The currents in force [A].
    counts : Counter
        How often each of `OUTCOMES` happened. Currents of which one is outside `usable` [A] count as saturated as well
        when they are put in force: driver or mounts will cut it.
    """

    def __init__(self, coils, initial, usable, lockstep=True):
        self.currents = np.zeros(coils)
        self.counts = Counter(dict.fromkeys(OUTCOMES, 0))
        self._usable = usable
        self._lockstep = lockstep
        self._sample = -1  # stamp of the latest sample, ns; none yet
        self._answered = -2  # stamp of the latest sample that was answered, ns; none yet
        self._put_in_force(initial)

    @property
    def answered_stamp(self):
        """Stamp of the latest sample that was answered [ns]."""
        return self._answered

    @property
    def answered(self):
        """Whether the latest sample has its answer."""
        return self._answered == self._sample

    def publish(self, stamp):
        """Note that a sample with this stamp [ns] is out."""
        self._sample = stamp

    def offer(self, stamp, currents):
        """Judge the answer (coils,) [A] to the sample with this stamp [ns]; returns one of `OUTCOMES`."""
        outcome = self._judge(stamp, currents)
        self.counts[outcome] += 1
        if outcome == "accepted" or (outcome == "late" and not self._lockstep and stamp > self._answered):
            self._answered = stamp
            self._put_in_force(currents)
        return outcome

    def fall_back(self, current):
        """Put a current [A] in force without an answer."""
        self._put_in_force(current)

    def _put_in_force(self, currents):
        self.currents[:] = currents
        low, high = self._usable
        if not all(low <= current <= high for current in self.currents.tolist()):
            self.counts["saturated"] += 1

    def _judge(self, stamp, currents):
        if stamp > self._sample:
            return "early"
        if not all(map(isfinite, currents)):
            return "not_finite"
        if stamp == self._answered:
            return "duplicate"
        return "accepted" if stamp == self._sample else "late"
