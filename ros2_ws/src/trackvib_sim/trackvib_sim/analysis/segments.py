"""Segments without a gap, found from stamps alone. Everything is looked at in blocks: bags may be long."""

from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from .numbers import Gap, Timing

MOST_GAPS = 1000  # that are listed
TOLERANCE = 0.5  # of a period, by which a step may differ from it
LOOKED_AT = 100_000  # steps from which the median is taken
BLOCK = 1_000_000  # samples


class Segment(NamedTuple):
    """Samples of both sensors, at the same stamps, each one period after the one before."""

    chassis: int  # index of the first
    powertrain: int
    size: int
    measured: int  # how many of them are passed before the rest counts


def blocks(size, length):
    """Iterate over slices of at most `length` that make up a range of `size`."""
    return (slice(begin, min(begin + length, size)) for begin in range(0, size, length))


def period_of(stamp):
    """Return the median step [ns] of stamps (k,), of many of them from a sample; nan of fewer than two."""
    if len(stamp) < 2:
        return float("nan")
    looked_at = np.linspace(0, len(stamp) - 2, min(len(stamp) - 1, LOOKED_AT)).astype(np.int64)
    return float(np.median(stamp[looked_at + 1] - stamp[looked_at]))


def timing(stamp, begin):
    """Return the `Timing` of stamps (k,) [ns] and where they break.

    Parameters
    ----------
    stamp : (k,) int
    begin : int
        Start of the bag, ns.

    Returns
    -------
    Timing
    breaks : (b,) int
        Index of the first sample after each step that is not one period long.
    """
    period = period_of(stamp)
    found = [np.empty(0, np.int64)]
    for block in blocks(len(stamp) - 1, BLOCK):
        step = np.diff(stamp[block.start : block.stop + 1])
        # the comparison is false for a period of nan or zero
        found.append(block.start + 1 + np.flatnonzero(~(np.abs(step - period) < TOLERANCE * period)))
    breaks = np.concatenate(found)
    step = stamp[breaks] - stamp[breaks - 1]
    gap = step > period
    missing = np.round(step[gap] / period).astype(np.int64) - 1
    listed = [
        Gap(float(stamp[after - 1] - begin) / NANO, float(length) / NANO, int(count))
        for after, length, count in zip(breaks[gap][:MOST_GAPS], step[gap], missing, strict=False)
    ]
    return Timing(
        samples=len(stamp),
        period=period / NANO,
        first=float(stamp[0] - begin) / NANO,
        last=float(stamp[-1] - begin) / NANO,
        missing=int(missing.sum()),
        repeated=int(((step >= 0) & (step <= period)).sum()),
        backward=int((step < 0).sum()),
        gap_count=int(gap.sum()),
        gaps=tuple(listed),
    ), breaks


def common_segments(stamps, breaks, period, begin, settle, lead, shortest):
    """Return the `Segment`s of two sensors that are long enough to be measured, until time goes back.

    Parameters
    ----------
    stamps : pair of (k,) int
        Of chassis and powertrain, ns.
    breaks : pair of (b,) int
        As `timing` returns them.
    period : float
        ns
    begin : int
        Start of the bag, ns.
    settle : float
        Time after the start that does not count, s.
    lead : float
        Time after the begin of each segment that does not count, s.
    shortest : float
        Least time to be measured of a segment, s.
    """
    chassis, powertrain = (
        _ends(stamp, each, (lead + shortest) * NANO) for stamp, each in zip(stamps, breaks, strict=True)
    )
    found, i, j = [], 0, 0
    while i < len(chassis) and j < len(powertrain):
        (a, a_end), (b, b_end) = chassis[i], powertrain[j]
        offset = round((stamps[0][a] - stamps[1][b]) / period)  # by how many samples the chassis begins later
        a, b = a + max(-offset, 0), b + max(offset, 0)
        size = min(a_end - a, b_end - b)
        if size > 0:
            first = int(stamps[0][a])
            # samples count from the first whose stamp is beyond both; the thousandth is for what rounding leaves
            passed = max(lead * NANO, begin + settle * NANO - first + period)
            measured = max(int(passed / period + 1e-3), 0)
            if size - measured + 1e-3 >= shortest * NANO / period:
                found.append(Segment(a, b, size, measured))
        if stamps[0][a_end - 1] < stamps[1][b_end - 1]:
            i += 1
        else:
            j += 1
    return found


def _ends(stamp, breaks, shortest):
    """Return first index and end of the segments that last `shortest` [ns] at least, until one lies before another."""
    ends = np.column_stack((np.append(0, breaks), np.append(breaks, len(stamp))))
    first, last = stamp[ends[:, 0]], stamp[ends[:, 1] - 1]
    long = last - first >= 0.99 * shortest
    ends, first, last = ends[long], first[long], last[long]
    back = np.flatnonzero(first[1:] <= last[:-1])
    return ends[: back[0] + 1 if back.size else None].tolist()
