"""Which sample is which: lost samples told from jitter, bursts and coarse stamps.

Where samples are lost, the stamps run ahead of the count for good; where stamps are late, early, coarse or repeated,
they come back. So a step is what medians over many samples before and after it differ by. A rate that drifts is
neither: stamps are compared with a count whose period follows it.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

STEADY = 0.1  # of a period: within it a step is a regular one
MOSTLY = 0.6  # share of regular steps by which stamps are sharp
AROUND, MOST_AROUND = 4, 1024  # samples to either side that a median is over
NOISE = 0.06  # of a period, that a median may scatter by
LEAST = 0.6  # of a period, by which medians must differ
CLOSE = 0.25  # of a period, by which that may differ from a whole number
BEATS = 8  # regular places at which coarse stamps make a longer or shorter step
BLURRED = 20.0  # periods, by which stamps may scatter
FOLLOWED = 64  # samples over which the period may be another, at least
SURE = 5.0  # times what levels differ by anywhere, beyond which stamps that wander at random make a step


class Count(NamedTuple):
    """The samples of a stretch as their stamps tell them."""

    period: float  # about it, in the unit of the stamps
    index: np.ndarray  # (k,) number of each sample, from 0; lost ones are counted in
    lost: int
    scatter: float  # robust standard deviation of the stamps about even ones, periods
    unsure: np.ndarray  # (k,) bool, near samples that are lost nobody knows exactly where
    places: np.ndarray  # (p,) indices before which any step was found
    steps: np.ndarray  # (p,) of how many periods


def count_samples(time):
    """Return the `Count` of times (k,), one a sample, in their order; None where they do not go on evenly at all."""
    step = np.diff(time)
    period, sharp, beat = _period(time, step)
    if not period > 0.0:
        return None
    scatter, around = _scatter((time - time[0]) / period - np.arange(len(time))), AROUND
    if not sharp:
        if scatter > BLURRED:
            return None
        around = int(np.clip(max((1.25 * scatter / NOISE) ** 2, 3.0 * beat), 16, MOST_AROUND))
    places, steps = _steps((time - _followed(time, period, max(FOLLOWED, around))) / period, around, sharp)
    lost = steps > 0
    before, unsure = np.zeros(len(time), np.int64), np.zeros(len(time), bool)
    np.add.at(before, places[lost], steps[lost])
    for place in () if sharp else places[lost].tolist():
        unsure[max(place - around // 2, 0) : place + around // 2] = True
    return Count(period, np.arange(len(time)) + np.cumsum(before), int(before.sum()), scatter, unsure, places, steps)


def _period(time, step):
    """Return about the period of times (k,), whether most steps are one period long, and the samples of a beat."""
    usual = float(np.median(step))
    regular = np.abs(step - usual) <= STEADY * usual
    beat = _beat(step, usual, regular)
    if usual > 0.0 and regular.mean() >= MOSTLY and not beat:
        return float(step[regular].mean()), True, 0.0
    return _mean_step(time), False, beat


def _mean_step(time):
    """Return the median of mean steps over many samples: lost ones are in few of these, bursts are averaged."""
    many = int(np.clip(len(time) // 8, 1, 256))
    middles = time[: len(time) // many * many].reshape(-1, many).mean(axis=1)
    return float(np.median(np.diff(middles))) / many


def _followed(time, period, width):
    """Return even times (k,) whose period drifts as that of the times does: the median of mean steps round about."""
    middles = time[: len(time) // width * width].reshape(-1, width).mean(axis=1)
    if len(middles) < 3:
        return time[0] + period * np.arange(len(time))
    mean = ndimage.median_filter(np.diff(middles) / width, 5, mode="nearest")  # a lost sample is in two of them
    step = np.interp(np.arange(len(time) - 1), width * (1.0 + np.arange(len(mean))), mean)
    return time[0] + np.append(0.0, np.cumsum(step))


def _beat(step, usual, regular):
    """Return after how many samples coarse stamps at another rate make a longer or shorter step; 0 if they do not.

    Such steps come as regularly as can be, those of lost samples never.
    """
    grain = np.abs(step - usual)[~regular]
    if len(grain) < BEATS or not _mostly_alike(grain, 0.01):
        return 0.0
    apart = np.diff(np.flatnonzero(~regular))
    return float(np.median(apart)) if _mostly_alike(apart, 0.02, 1.0) else 0.0


def _mostly_alike(values, relative, absolute=0.0):
    middle = np.median(values)
    return bool((np.abs(values - middle) <= absolute + relative * np.abs(middle)).mean() >= 0.9)


def _scatter(ahead):
    """Return by how much, robustly, values scatter about what they are over a few dozen samples."""
    width = min(64, len(ahead))
    parts = ahead[: len(ahead) // width * width].reshape(-1, width)
    # a straight line through each part: the period is only about right
    slope = (parts[:, width // 2 :].mean(axis=1) - parts[:, : width // 2].mean(axis=1)) / (width / 2)
    rest = parts - slope[:, None] * np.arange(width)
    rest -= np.median(rest, axis=1)[:, None]
    return float(np.median(1.4826 * np.median(np.abs(rest), axis=1)))


def _steps(ahead, around, sharp):
    """Return before which samples, and by how many periods, stamps run ahead of the count, or fall back, for good."""
    if len(ahead) <= 4 * around:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    if sharp:
        level = ndimage.median_filter(ahead, 2 * around + 1, mode="reflect")
    else:  # the mean of medians: those of bursts and coarse stamps are whole periods themselves
        medians = ndimage.median_filter(ahead, around // 2 * 2 + 1, mode="reflect")
        level = ndimage.uniform_filter1d(medians, around, mode="reflect")
    apart = around + 1
    change = np.zeros(len(ahead))
    change[apart:-apart] = level[2 * apart :] - level[: -2 * apart]
    usual = 1.4826 * float(np.median(np.abs(change)))
    regions, count = ndimage.label(np.abs(change) > max(LEAST, SURE * usual))
    places, steps = [], []
    for (region,) in ndimage.find_objects(regions) if count else ():
        before, after = max(region.start - apart, 0), min(region.stop + apart, len(ahead)) - 1
        number = round(float(level[after] - level[before]))
        if not number:
            continue
        inside = np.diff(ahead[before : after + 1])
        if sharp and (inside * np.sign(number)).max() < 0.5:  # many small steps are a rate that wanders
            continue
        single = np.round(inside).astype(np.int64)
        if sharp and single[single > 0].sum() == number > 0:
            where = np.flatnonzero(single > 0)
            places += (before + 1 + where).tolist()
            steps += single[where].tolist()
        else:
            places.append(before + 1 + int(np.argmax(inside * np.sign(number))) if sharp else (before + after) // 2)
            steps.append(number)
    return np.array(places, np.int64), np.array(steps, np.int64)
