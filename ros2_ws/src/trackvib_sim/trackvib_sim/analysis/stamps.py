"""What the stamps of a recording tell: period, gaps, start, losses. In blocks: bags may be long."""

import numpy as np

from ..numerics.units import NANO
from .stamp_numbers import Gap, Timing

MOST_GAPS = 1000  # that are listed
TOLERANCE = 0.5  # of a period, by which a step may differ from it
LOOKED_AT = 100_000  # steps from which the median is taken
BLOCK = 1_000_000  # samples
MOST_LOST = 1000  # times the samples that are there


def blocks(size, length):
    """Iterate over slices of at most `length` that make up a range of `size`."""
    return (slice(begin, min(begin + length, size)) for begin in range(0, size, length))


def period_of(stamp):
    """Return the usual step [ns] of stamps (k,), of many of them from a sample; nan of fewer than two.

    It is the mean of those steps that are near the median, so that whole nanoseconds do not add up.
    """
    if len(stamp) < 2:
        return float("nan")
    looked_at = np.linspace(0, len(stamp) - 2, min(len(stamp) - 1, LOOKED_AT)).astype(np.int64)
    step = stamp[looked_at + 1] - stamp[looked_at]
    median = np.median(step)
    return float(step[np.abs(step - median) <= TOLERANCE * median].mean()) if median > 0 else float(median)


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


def start_of(recording):
    """Return the time [ns] at which a recording starts: 0 of a whole run, else one period before its first sample.

    Raises
    ------
    ValueError
        The stamps of the chassis do not go on.
    """
    odometry, chassis = recording.odometry, recording.chassis.stamp
    period = period_of(chassis)
    if not period > 0.0:
        raise ValueError(f"stamps of chassis/imu advance by {period:g} ns from sample to sample, must be above 0")
    if odometry is not None and odometry.stamp[0] == 0:  # of the vehicle before the first period
        return 0
    return int(min(chassis[0], recording.powertrain.stamp[0])) - round(period)


def losses(recording):
    """Count, from stamps alone, what is missing between the start and the last sample that anything speaks of.

    Of answers that are not in the bag nothing is counted: None.

    Raises
    ------
    ValueError
        The stamps are no time base: they reach over much more time than samples can fill.
    """
    chassis, powertrain = recording.chassis.stamp, recording.powertrain.stamp
    nobody = recording.answers is None
    answered = np.empty(0, np.int64) if nobody else recording.answers.sample_stamp
    begin, period = start_of(recording), period_of(chassis)
    told = round(float(recording.diagnostics.get("time", 0.0)) * NANO)  # by the simulator at its end
    last = max(told, *(int(stamp.max()) for stamp in (chassis, powertrain, answered) if stamp.size))
    expected = round((last - begin) / period)
    if not 0 < expected <= MOST_LOST * len(chassis):
        reach = f"{(last - begin) / NANO:g} s in steps of {period / NANO:g} s"
        raise ValueError(f"stamps cover {reach}, which {len(chassis)} samples of chassis/imu cannot fill")
    counted = {}
    for name, stamp in (("chassis", chassis), ("powertrain", powertrain), ("answered", answered)):
        seen, inside = np.zeros(expected, bool), 0
        for block in blocks(len(stamp), BLOCK):
            index = np.round((stamp[block] - begin) / period).astype(np.int64) - 1
            index = index[(index >= 0) & (index < expected)]
            seen[index] = True
            inside += len(index)
        counted[name] = int(np.count_nonzero(seen))
    return {
        "samples": expected,
        "lost_chassis": expected - counted["chassis"],
        "lost_powertrain": expected - counted["powertrain"],
        "unanswered": None if nobody else expected - counted["answered"],
        "answered_twice": None if nobody else inside - counted["answered"],  # of answers, which come last
    }
