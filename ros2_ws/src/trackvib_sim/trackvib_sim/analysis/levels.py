"""Levels of both sensors over segments of any length, in blocks: memory is that of a block.

A block is filtered with so much before and after it that the filters have forgotten where that begins; the numbers are
those of the whole segment filtered in one go.
"""

from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from . import iso2631
from .absorbed_power import absorbed_power
from .iso2631 import LEAST_RATE, weighted
from .numbers import AxisNumbers, MotionSickness
from .stamps import blocks
from .vibration import band_limited

BLOCK = 120.0  # s
MARGIN = 20.0  # s; the slowest filter has fallen by exp(-35) then
MOTION_LEAD = 30.0  # s of each segment in which Wf settles, three periods of the slowest motion that it weighs
MOTION_LEAST = 60.0  # s, less than which tells nothing of such motion
RUNNING = 1.0  # s, over which a running RMS is taken
WEIGHTINGS = ("Wd", "Wd", "Wk")  # along x, y, z
BINS = 3600  # of a history, at most


class Bins(NamedTuple):
    """Equal parts of the time since the start of a bag, of whole seconds."""

    begin: int  # ns
    width: int  # ns
    count: int

    @property
    def middle(self):
        """Middle of each bin, s from the start."""
        return (np.arange(self.count) + 0.5) * (self.width / NANO)

    def sums(self, stamp, values):
        """Return how many samples (n,) are in each bin, and the sums (n, m) of their values (k, m)."""
        # a stamp is the end of the period that a sample is of
        index = (stamp - self.begin - 1) // self.width
        inside = (index >= 0) & (index < self.count)
        index, values = index[inside], values[inside]
        columns = [np.bincount(index, column, self.count) for column in values.T]
        return np.bincount(index, minlength=self.count), np.reshape(columns, (-1, self.count)).T


def build_bins(begin, last):
    """Return the `Bins` of the time [ns] from `begin` to `last`: seconds, or longer ones of a long bag."""
    length = max(last - begin, 1)
    width = -(-length // (BINS * NANO)) * NANO
    return Bins(begin, width, -(-length // width))


class PartLevels(NamedTuple):
    """Levels of one sensor in n parts of a run; nan where there is nothing."""

    count: np.ndarray  # (n,) samples
    rms: np.ndarray  # (n, 3) band-limited, m/s^2
    rms_weighted: np.ndarray  # (n, 3) m/s^2
    absorbed_power: np.ndarray  # (n,) mean, W


class _Sums:
    """Sums over the samples of each of some parts, which are `Bins` or `parts.Parts`."""

    def __init__(self, parts):
        self._parts = parts
        self._count, self._total = np.zeros(parts.count), np.zeros((parts.count, 7))

    def add(self, stamp, powers):
        count, total = self._parts.sums(stamp, powers)
        self._count += count
        self._total += total

    def levels(self):
        mean = self._total / np.where(self._count > 0, self._count, np.nan)[:, None]
        return PartLevels(self._count, np.sqrt(mean[:, :3]), np.sqrt(mean[:, 3:6]), mean[:, 6])


class Levels:
    """What has been summed up of one sensor: over all that counts, over parts of it by name, and in bins of the bag."""

    def __init__(self, rate, bins, parts=MappingProxyType({})):
        self.rate = self._rate = rate  # of the samples, Hz
        self._bins, self._parts = _Sums(bins), {name: _Sums(each) for name, each in parts.items()}
        self._count = 0
        self._origin = None
        self._raw, self._raw_squared, self._limited = np.zeros((3, 3))
        self._squared, self._fourth = np.zeros((2, 3))
        self._peak, self._weighted_peak, self._running = np.zeros((3, 3))
        self._absorbed = 0.0
        self._motion_count, self._motion = 0, 0.0

    def add(self, stamp, acceleration, measured):
        """Add a segment, and say after each block how much of it is done.

        Parameters
        ----------
        stamp : (k,) int
            ns
        acceleration : (k, 3) array
            Specific force, m/s^2.
        measured : int
            How many samples are passed before they count.
        """
        margin, running = round(MARGIN * self._rate), round(RUNNING * self._rate)
        for block in blocks(len(stamp), round(BLOCK * self._rate)):
            begin = max(block.start - margin, 0)
            around = np.array(acceleration[begin : block.stop + margin])
            limited = band_limited(around, self._rate)
            perceived, absorbed = self._perceived(around)
            powers = np.column_stack((np.square(limited), np.square(perceived), absorbed))
            inner = slice(block.start - begin, block.stop - begin)
            self._bins.add(stamp[block], powers[inner])
            first = max(block.start, measured) - begin
            if first < inner.stop:
                counting = slice(first, inner.stop)
                for each in self._parts.values():
                    each.add(stamp[begin + first : block.stop], powers[counting])
                self._absorbed += absorbed[counting].sum()
                self._measure(*(each[counting] for each in (around, limited, perceived)))
                before = max(first + 1 - running, measured - begin)
                self._run(np.square(perceived[before : inner.stop]), running)
            self._add_motion(acceleration, block, measured)
            yield block.stop

    def _add_motion(self, acceleration, block, measured):
        """Add what of a block of a segment counts for motion sickness; its filter remembers longer than the others."""
        first = max(block.start, measured, round(MOTION_LEAD * self._rate))
        if first >= block.stop or self._rate < LEAST_RATE:
            return
        margin = round(iso2631.WEIGHTINGS["Wf"].memory * self._rate)
        begin = max(block.start - margin, 0)
        around = np.array(acceleration[begin : block.stop + round(MARGIN * self._rate), 2])
        self._motion += np.square(weighted(around, "Wf", self._rate)[first - begin : block.stop - begin]).sum()
        self._motion_count += block.stop - first

    def _perceived(self, acceleration):
        """Return weighted accelerations (k, 3) and the absorbed power (k,); nan where samples come too slowly."""
        if self._rate < LEAST_RATE:
            return np.full_like(acceleration, np.nan), np.full(len(acceleration), np.nan)
        columns = [weighted(column, name, self._rate) for column, name in zip(acceleration.T, WEIGHTINGS, strict=True)]
        return np.stack(columns, axis=1), absorbed_power(acceleration[:, 2], self._rate)

    def _measure(self, raw, limited, perceived):
        if self._origin is None:
            self._origin = raw[0]  # sums of squares about some typical value keep their digits
        raw, squared = raw - self._origin, np.square(perceived)
        self._count += len(raw)
        self._raw += raw.sum(axis=0)
        self._raw_squared += np.square(raw).sum(axis=0)
        self._limited += np.square(limited).sum(axis=0)
        self._squared += squared.sum(axis=0)
        self._fourth += np.square(squared).sum(axis=0)
        self._peak = np.maximum(self._peak, np.abs(limited).max(axis=0))
        self._weighted_peak = np.maximum(self._weighted_peak, np.abs(perceived).max(axis=0))

    def _run(self, squared, running):
        total = np.cumsum(squared, axis=0)
        total[running:] -= total[:-running].copy()
        if len(total) >= running:
            self._running = np.maximum(self._running, total[running - 1 :].max(axis=0))

    def numbers(self):
        """Return the `AxisNumbers` of x, y and z."""
        n, rate = self._count, self._rate
        mean = self._raw / n
        rms_weighted = np.sqrt(self._squared / n)
        with np.errstate(invalid="ignore"):  # the crest of nothing is nan
            columns = (
                self._origin + mean,
                np.sqrt(np.maximum(self._raw_squared / n - mean**2, 0.0)),
                np.sqrt(self._limited / n),
                self._peak,
                rms_weighted,
                self._weighted_peak / rms_weighted,
                np.sqrt(self._running / round(RUNNING * rate)),
                (self._fourth / rate) ** 0.25,
            )
        return [AxisNumbers(*map(float, numbers)) for numbers in zip(*columns, strict=True)]

    def absorbed_power(self):
        """Return the mean absorbed power of the vertical [W]."""
        return float(self._absorbed / self._count)

    def motion_sickness(self):
        """Return the `MotionSickness`; None of too little time."""
        seconds = self._motion_count / self._rate
        if not seconds >= MOTION_LEAST:
            return None
        return MotionSickness(
            float(np.sqrt(self._motion / self._motion_count)), float(np.sqrt(self._motion / self._rate)), seconds
        )

    def history(self):
        """Return the `PartLevels` in the bins of the bag, over all samples."""
        return self._bins.levels()

    def parts(self):
        """Return the `PartLevels` of the parts by name, over the samples that count."""
        return {name: each.levels() for name, each in self._parts.items()}
