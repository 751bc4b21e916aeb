"""The robust line through stamps against the number of the sample."""

from typing import NamedTuple

import numpy as np
from scipy import stats

POINTS = 200  # medians of as many parts the slope is taken from
WANDERING = 5.0  # s; over so long a part of its own a clock may go otherwise than over the whole
LEAST_PART = 200  # samples of it
SHORTEST_PART = 16  # samples; parts are halved down to this as long as the clock goes otherwise within them
NOTABLE = 0.02  # of a period, by which the clock must leave the straight line


class Line(NamedTuple):
    """When each sample was taken: a straight line, along which a clock may wander slowly."""

    period: float  # slope
    start: float  # at number 0
    number: np.ndarray  # (p,) of samples at which the clock is known to leave the straight line
    off: np.ndarray  # (p,) by how much

    def at(self, index):
        """Return the times of samples by their numbers (k,)."""
        straight = self.start + self.period * index
        return straight + np.interp(index, self.number, self.off) if len(self.number) > 1 else straight


def line_through(time, index, period, seconds, grain):
    """Return the `Line` through times (k,) of samples with rising numbers (k,).

    The slope is Theil and Sen's, of medians of parts. Where medians over `WANDERING` leave the straight line by more
    than they scatter, the line goes through them; where those of half as long parts leave that, through these.

    Parameters
    ----------
    time, index : (k,) arrays
    period : float
        About the slope.
    seconds : float
        A second in the unit of the times.
    grain : float
        In what steps the times are told.
    """
    rest = time - period * index
    numbers, medians = _medians(index, rest, max(len(time) // POINTS, 1))
    slope = float(stats.theilslopes(medians, numbers).slope) if len(numbers) > 1 else 0.0
    rest = rest - slope * index
    line = Line(period + slope, float(np.median(rest)), np.empty(0), np.empty(0))
    rest -= line.start
    length, left = max(LEAST_PART, round(WANDERING * seconds / period)), rest
    while length >= SHORTEST_PART:
        scatter = 1.4826 * float(np.median(np.abs(left)))
        medians = _medians(index, left, length)[1]
        limit = 6.0 * 1.25 * scatter / np.sqrt(length) + max(NOTABLE * period, grain)
        if len(medians) < 3 or not np.ptp(medians) > limit:
            break
        line = line._replace(**_through(*_medians(index, rest, length), index))
        left, length = time - line.at(index), length // 2
    return line


def _through(number, off, index):
    """Return the columns of a `Line` through medians, straight on to the first and last sample."""
    slope = np.diff(off)[[0, -1]] / np.diff(number)[[0, -1]]
    ends = index[[0, -1]]
    outer = off[[0, -1]] + slope * (ends - number[[0, -1]])
    return {
        "number": np.concatenate((ends[:1], number, ends[1:])),
        "off": np.concatenate((outer[:1], off, outer[1:])),
    }


def _medians(index, values, length):
    """Return mean numbers and median values of parts of a length, the last one as long or longer."""
    last = (max(len(values) // length, 1) - 1) * length
    numbers, parts = (each[:last].reshape(-1, length) for each in (index, values))
    return (
        np.append(numbers.mean(axis=1), index[last:].mean()),
        np.append(np.median(parts, axis=1), np.median(values[last:])),
    )
