"""The stamps of one sensor, mended: on a robust line, where a sensor that samples evenly must have them."""

from typing import NamedTuple

import numpy as np

from ...numerics.units import NANO
from ..stamp_numbers import Clock
from ..stamps import BLOCK, blocks, period_of
from .counting import count_samples
from .line import line_through
from .order import time_order
from .settings import find_settings, standing_apart, without_settings

EVEN = 0.01  # of a period, by which steps of even stamps may differ from it
PAUSE = 0.5  # s without a sample, after which the count begins anew
OUTLIER = 5.0  # standard deviations
LEAST_SAMPLES = 8
LEAST_SPAN = 0.1  # of the recorder's time, that stamps must reach over when jumps are taken back
WITHIN = 64  # samples to either side of a small jump, over which its size is taken


class NoClock(ValueError):
    """Stamps that cannot be a time base; the message says why by counts."""


class Mended(NamedTuple):
    """Samples of a sensor in their order of time."""

    order: np.ndarray  # (n,) index among the messages
    stamp: np.ndarray  # (n,) when each was taken, ns
    clock: Clock | None  # None where nothing but gaps was found


def is_even(stamp):
    """Return whether stamps (k,) [ns] go on by one period each, or by whole ones where samples are missing."""
    period = period_of(stamp)
    if not period > 0.0:
        return False
    longer = 0
    for block in blocks(len(stamp) - 1, BLOCK):
        step = np.diff(stamp[block.start : block.stop + 1]) / period
        other = np.abs(step - 1.0) > EVEN
        if (np.abs(step[other] - np.round(step[other])) > EVEN).any() or (step < 0.5).any():
            return False
        longer += int(np.count_nonzero(other))
    return longer == 0


def mend(stamp, logged, force, name):
    """Return the `Mended` samples of a sensor.

    Parameters
    ----------
    stamp : (k,) int
        ns
    logged : (k,) int, or None
        When each message was recorded, ns, if known.
    force : (k, 3) array
    name : str
        Of the topic, for messages.

    Raises
    ------
    NoClock
        The stamps are zero, or do not go on evenly.
    """
    count = len(stamp)
    stamp = np.array(stamp)
    logged = None if logged is None or _tells_nothing(stamp, logged) else np.array(logged)
    if not stamp.any():
        raise NoClock(f"all {count} header stamps of {name} are zero")
    order = time_order(stamp, logged, force)
    order = np.arange(count) if order is None else order
    copies = count - len(order)
    stamp, logged = stamp[order], None if logged is None else logged[order]
    rough = _rough_period(stamp, logged, name)
    apart = standing_apart(stamp, logged, rough)
    order, stamp, logged = order[~apart], stamp[~apart], None if logged is None else logged[~apart]
    settings = find_settings(stamp, logged, rough)
    told, stamp = stamp, without_settings(stamp, settings)
    if logged is not None and np.ptp(stamp) < LEAST_SPAN * np.ptp(logged):
        raise NoClock(f"stamps of {name} do not increase: {in_steps(told)}")
    disordered = np.zeros(len(stamp), bool)
    mended, kept = np.empty(len(stamp), np.int64), np.ones(len(stamp), bool)
    parts, small = [], []
    broken = [setting.after for setting in settings if not setting.witnessed]
    pauses = np.flatnonzero(np.diff(stamp) > PAUSE * NANO) + 1
    edges = np.unique(np.concatenate(([0], pauses, broken, [len(stamp)]))).astype(int)
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        part = slice(begin, end)
        if end - begin < LEAST_SAMPLES:
            kept[part] = False
            continue
        found = _mend_part(stamp[part], None if logged is None else logged[part], name)
        mended[part], kept[part] = found.stamp, found.kept
        if found.order is not None:
            disordered[part] = found.order != np.arange(end - begin)
            order[part], told[part] = order[part][found.order], told[part][found.order]
        parts.append(found)
        small += [(step / NANO, logged is not None) for step in found.settings]
    if not parts:
        raise NoClock(f"{name} has no {LEAST_SAMPLES} consecutive samples: {in_steps(stamp)}")
    rest = np.concatenate([part.rest for part in parts])
    untouched = len(told) == count and not settings and not small and not disordered.any() and kept.all()
    if untouched and np.abs(rest).max() < EVEN * rough and (order == np.arange(count)).all():
        return Mended(order, told, None)
    clock = Clock(
        rate=NANO * len(rest) / sum(part.period * len(part.rest) for part in parts),
        jitter=float(np.sqrt(np.mean(np.square(rest)))) / NANO,
        correction=float(np.abs(rest).max()) / NANO,
        lost=sum(part.lost for part in parts),
        repeated=int(np.count_nonzero(np.diff(told) == 0)),
        disordered=int(disordered.sum()),
        copies=copies,
        left_out=int(apart.sum() + np.count_nonzero(~kept)),
        settings=(*((float(each.step) / NANO, each.witnessed) for each in settings), *small),
        counted_by_log=any(part.by_log for part in parts),
        steps=in_steps(told),
    )
    return Mended(order[kept], mended[kept], clock)


class _Part(NamedTuple):
    """What became of samples without a pause."""

    stamp: np.ndarray  # (k,) ns
    kept: np.ndarray  # (k,) bool
    order: np.ndarray | None  # (k,) in which they are to stand, if not as they do
    period: float  # ns, on the whole
    rest: np.ndarray  # (k,) by which the stamps are off the line, ns
    lost: int
    by_log: bool  # whether they were counted by the recorder's clock
    settings: list  # by how much the clock was set where that is little, ns


def _mend_part(stamp, logged, name):
    """Return the `_Part` of samples without a pause."""
    time = (stamp - stamp[0]).astype(float)
    found = count_samples(time)
    by_log = None if logged is None else count_samples((logged - logged[0]).astype(float))
    witnessed = by_log is not None and (
        found is None
        or (by_log.scatter <= max(found.scatter, 0.1) and by_log.lost < found.lost)
        or by_log.scatter < 0.5 * found.scatter
    )
    if witnessed:
        found = by_log
    if found is None:
        raise NoClock(f"stamps of {name} are not evenly spaced: {in_steps(stamp)}")
    index, grain = found.index, float(np.gcd.reduce(np.diff(stamp)))
    time, index, settings = _without_small_settings(time, index, found.period, grain, logged is not None)
    line = line_through(time, index, found.period, NANO, grain)
    rest = time - line.at(index)
    order = _by_stamp(time, rest, line.period)
    if order is not None:
        rest = time[order] - line.at(index)
    mended = stamp[0] + np.round(line.at(index)).astype(np.int64)
    period = float(np.ptp(line.at(index[[0, -1]]))) / (index[-1] - index[0])
    return _Part(mended, ~found.unsure, order, period, rest, found.lost, witnessed, settings)


def _without_small_settings(time, index, period, grain, witnessed):
    """Return times and numbers of samples as if nobody had set the clock, and by how much it was.

    It was where the times step otherwise than the count of the samples. Where the recorder's clock is no witness nobody
    knows how much time passed: two periods, which end a stretch.
    """
    found = count_samples(time - period * (index - np.arange(len(time))))  # as if no sample were lost
    places = () if found is None else found.places[np.abs(found.steps) * period > 1.5 * grain]
    settings = []
    for place in places:
        rest = (time - period * index)[max(place - WITHIN, 0) : place + WITHIN]
        middle = min(place, WITHIN)
        step = float(np.median(rest[middle:]) - np.median(rest[:middle]))
        behind = np.arange(len(time)) >= place
        index = index + behind * (0 if witnessed else 1)
        time = time - behind * (step - (0.0 if witnessed else period))
        settings.append(step)
    return time, index, settings


def _by_stamp(time, rest, period):
    """Return the order of a part's stamps where that puts them on the line, which they are off as they stand."""
    if not (np.diff(time) < 0).any():
        return None
    width = max(0.5 * period, OUTLIER * 1.4826 * float(np.median(np.abs(rest - np.median(rest)))))
    order = np.argsort(time, kind="stable")
    line = time - rest
    off, still_off = (int(np.count_nonzero(np.abs(each) > width)) for each in (rest, time[order] - line))
    return order if off and still_off <= 0.1 * off else None


def _rough_period(stamp, logged, name):
    """Return about the period [ns] of stamps that may jump and repeat."""
    many = int(np.clip(len(stamp) // 8, 1, 256))
    for times in (stamp, logged):
        if times is not None and len(times) > 1:
            period = float(np.median(times[many:] - times[:-many])) / many
            if period > 0.0:
                return period
    raise NoClock(f"stamps of {name} do not increase: {in_steps(stamp)}")


def _tells_nothing(stamp, logged):
    """Return whether times at which messages were recorded say nothing beyond their stamps."""
    return len(logged) < 2 or np.ptp(logged) == 0 or np.ptp(stamp - logged) == 0


def in_steps(stamp):
    """Return in words which steps stamps make."""
    if len(stamp) < 2:
        return f"there are {len(stamp)}"
    step = np.diff(stamp) / NANO * 1e3
    steps, counts = np.unique(np.round(step, 3), return_counts=True)
    most = np.sort(np.argsort(counts)[::-1][:3])
    if counts[most].sum() < 0.5 * len(step):
        return f"{len(step)} steps from {step.min():.4g} to {step.max():.4g} ms, median {np.median(step):.4g} ms"
    words = [f"{counts[k]} of {steps[k]:g} ms" for k in most]
    return f"{len(step)} steps, {', '.join(words)}{', others' if len(steps) > 3 else ''}"
