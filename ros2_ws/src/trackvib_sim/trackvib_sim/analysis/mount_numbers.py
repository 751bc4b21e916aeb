"""Numbers that need no filter: of mounts, currents and speed. In blocks, as `levels`."""

from math import nan
from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from .numbers import AXES, Current, MountAxis, MountNumbers
from .stamps import BLOCK, TOLERANCE, blocks, period_of

_NO_COIL = Current(*[nan] * 5)


class Moments(NamedTuple):
    """Of some columns of numbers, over all samples that count."""

    count: int
    mean: np.ndarray  # (m,)
    square: np.ndarray  # (m,) mean of the squares
    deviation: np.ndarray  # (m,) standard deviation
    least: np.ndarray  # (m,)
    greatest: np.ndarray  # (m,)

    @property
    def reach(self):
        """Greatest distance (m,) from the mean."""
        return np.maximum(self.greatest - self.mean, self.mean - self.least)


def moments(stamp, values, after):
    """Return the `Moments` of columns (k, m) over the samples with stamps (k,) later than `after` [ns].

    All are nan where there is no such sample.
    """
    columns = values.shape[1]
    count, origin, total, squares = 0, np.zeros(columns), np.zeros(columns), np.zeros(columns)
    least, greatest = np.full(columns, np.inf), np.full(columns, -np.inf)
    for block in blocks(len(stamp), BLOCK):
        counting = values[block][stamp[block] > after]
        if not len(counting):
            continue
        if not count:
            origin = counting[0].copy()  # sums of squares about some typical value keep their digits
        least = np.minimum(least, counting.min(axis=0))
        greatest = np.maximum(greatest, counting.max(axis=0))
        counting = counting - origin
        count += len(counting)
        total += counting.sum(axis=0)
        squares += np.square(counting).sum(axis=0)
    if not count:
        return Moments(0, *np.full((5, columns), np.nan))
    offset = total / count
    variance = np.maximum(squares / count - offset**2, 0.0)
    mean = origin + offset
    return Moments(count, mean, variance + mean**2, np.sqrt(variance), least, greatest)


def currents(stamp, current, names, after):
    """Return the `Current` by name of coil, of stamps (k,) [ns] and currents (k, m) [A] later than `after` [ns]."""
    found, slew = moments(stamp, current, after), _slew(stamp, current, after)
    columns = (found.mean, np.sqrt(found.square), found.least, found.greatest, slew)
    return {name: Current(*map(float, coil)) for name, *coil in zip(names, *columns, strict=False)}


def _slew(stamp, current, after):
    """Greatest change (m,) from a sample to the next, over the time between; not across gaps."""
    period, slew = period_of(stamp), np.full(current.shape[1], np.nan)
    for block in blocks(len(stamp) - 1, BLOCK):
        samples = slice(block.start, block.stop + 1)
        step = np.diff(stamp[samples])
        near = (np.abs(step - period) < TOLERANCE * period) & (stamp[samples][:-1] > after)
        if near.any():
            change = np.abs(np.diff(current[samples], axis=0))[near] / (step[near, None] / NANO)
            slew = np.fmax(slew, change.max(axis=0))
    return slew


def mount_numbers(mounts, names, after):
    """Return the `MountNumbers` by name of mount over the samples of `recording.Mounts` later than `after` [ns]."""
    current = currents(mounts.stamp, mounts.current, names, after)
    deflection, force = (
        moments(mounts.stamp, each.reshape(len(each), -1), after) for each in (mounts.deflection, mounts.force)
    )
    power = moments(mounts.stamp, mounts.dissipated_power, after)
    columns = (
        deflection.mean, deflection.deviation, deflection.reach, force.mean, force.deviation, force.reach,
    )  # fmt: skip
    axes = [MountAxis(*map(float, numbers)) for numbers in zip(*columns, strict=True)]
    energy = power.mean * power.count * period_of(mounts.stamp) / NANO
    return {
        name: MountNumbers(
            dict(zip(AXES, axes[3 * k : 3 * k + 3], strict=True)),
            current.get(name, _NO_COIL),
            float(energy[k]),
            float(power.mean[k]),
        )
        for k, name in enumerate(names)
    }
