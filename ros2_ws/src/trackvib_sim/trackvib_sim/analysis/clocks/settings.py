"""Clocks that were set while a sensor was recorded: stamps jump, sampling goes on."""

from typing import NamedTuple

import numpy as np

from ...numerics.units import NANO

LEAST = 0.25  # s; smaller jumps are looked for among the samples that are lost (`counting`)
PERIODS = 20.0  # likewise
APART = 3600.0  # s ahead, beyond which a few samples by themselves are a clock that was not set yet
SHORT = 3.0  # s; of less nothing can be measured


class Setting(NamedTuple):
    """A place where a clock was set."""

    after: int  # index of the first sample behind it
    step: int  # by which the clock was set, ns
    witnessed: bool  # whether the recorder's clock went on, so that no time is lost between


def standing_apart(stamp, logged, period):
    """Return which samples (k,) are a few by themselves between jumps of the clock: nothing can be measured in them.

    They are stamped before the clock was set at all, or while it was wrong. Arguments as of `find_settings`.
    """
    places, jump, passed = _jumps(stamp, logged, period)
    unexplained = ~_set(jump, passed, period)
    if not (jump[unexplained] < 0).any():  # else any other jump may be the first half of that
        unexplained &= jump > APART * NANO
    edges = np.concatenate(([0], places[unexplained], [len(stamp)]))
    few = np.diff(edges) < SHORT * NANO / period
    return np.repeat(few & (len(edges) > 2), np.diff(edges))


def find_settings(stamp, logged, period):
    """Return the `Setting`s of stamps.

    Parameters
    ----------
    stamp : (k,) int
        ns
    logged : (k,) int, or None
        When each message was recorded, ns, if that is known and tells anything else.
    period : float
        About that of the samples, ns.
    """
    places, jump, passed = _jumps(stamp, logged, period)
    witnessed = _set(jump, passed, period)
    # how much time passed at a jump back nobody else knows: two periods, which end a stretch
    step = jump - np.where(witnessed, np.maximum(passed, round(period)), round(2.0 * period))
    real = witnessed | (jump < 0)
    return [
        Setting(*each) for each in zip(*(column[real].tolist() for column in (places, step, witnessed)), strict=True)
    ]


def _jumps(stamp, logged, period):
    """Return indices of the samples behind jumps, by how much [ns], and how much passed by the recorder's clock."""
    step = np.diff(stamp)
    after = np.flatnonzero(np.abs(step) > max(LEAST * NANO, PERIODS * period)) + 1
    jump = step[after - 1]
    return after, jump, jump if logged is None else logged[after] - logged[after - 1]


def _set(jump, passed, period):
    """Return at which jumps the recorder's clock went on otherwise."""
    return (passed >= 0) & (np.abs(jump - passed) > 0.5 * max(LEAST * NANO, PERIODS * period))


def without_settings(stamp, settings):
    """Return stamps as if the clock had always been as it was over most of the samples."""
    if not settings:
        return stamp
    edges = [0, *(setting.after for setting in settings), len(stamp)]
    shifts = np.append(0, np.cumsum([setting.step for setting in settings]))
    longest = int(np.argmax(np.diff(edges)))
    return stamp - np.repeat(shifts - shifts[longest], np.diff(edges))
