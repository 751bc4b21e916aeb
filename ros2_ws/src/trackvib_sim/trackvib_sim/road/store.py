"""The stretch of road that a simulation holds, put together from patches."""

from typing import NamedTuple

import numpy as np

KEPT_BEHIND = 20.0  # m
_FAR = 1e15  # samples, up to which whole numbers are exact in floating point


class Road(NamedTuple):
    """A stretch of road; sample i lies at distance (first + i) * spacing."""

    first: int
    spacing: float  # m
    height: np.ndarray  # (2, m) left, right, m


class RoadStore:
    """Patches of road, in any order, and the stretch without gap that they form around a place."""

    def __init__(self):
        self._spacing = None
        self._patches = {}  # first sample -> heights (2, m)
        self._stretch = None

    def add(self, start, spacing, left, right):
        """Keep a patch; of two with one start the longer is kept, and they must agree.

        Parameters
        ----------
        start, spacing : float
            Distance of the first sample and between samples, m.
        left, right : sequences of float
            Heights, m.

        Raises
        ------
        ValueError
            The patch cannot be used; the message names item, value and what is accepted.
        """
        if len(left) != len(right) or len(left) < 2:
            raise ValueError(f"left has {len(left)} samples and right {len(right)}, must be as many and at least 2")
        if not (np.isfinite(spacing) and spacing > 0.0):
            raise ValueError(f"spacing is {spacing} m, must be finite and > 0")
        if self._spacing not in (None, spacing):
            raise ValueError(f"spacing is {spacing} m, must be {self._spacing} m as in the patches before")
        heights = np.array([left, right], dtype=float)
        if not np.isfinite(heights).all():
            raise ValueError("a height is not finite, all must be")
        place = start / spacing
        first = round(place) if abs(place) < _FAR else 0
        if not abs(first * spacing - start) <= 1e-6 * spacing:
            raise ValueError(f"start is {start} m, must be a whole multiple of the spacing {spacing} m")
        held = self._patches.get(first, heights)
        common = min(held.shape[1], heights.shape[1])
        if not np.array_equal(held[:, :common], heights[:, :common]):
            raise ValueError(f"start is {start} m, where a patch with other heights is held already: two roads?")
        self._spacing = spacing
        if heights.shape[1] >= held.shape[1]:
            self._patches[first] = heights
        self._stretch = None

    def around(self, rear, front):
        """Return a `Road` that reaches from distance `rear` to beyond `front` [m], or None if there is a gap.

        Patches that end far behind `rear` are forgotten.
        """
        if not _reaches(self._stretch, rear, front) and self._spacing is not None:
            self._forget_before(rear - KEPT_BEHIND)
            self._stretch = self._join(int(np.floor(rear / self._spacing)))
        return self._stretch if _reaches(self._stretch, rear, front) else None

    def _join(self, wanted):
        """Patches that follow each other without gap, from the one that holds sample `wanted` on."""
        first, pieces = None, []
        for start in sorted(self._patches):
            heights = self._patches[start]
            end = start + heights.shape[1]
            if start <= wanted < end:
                first = start if first is None else first
                pieces.append(heights[:, wanted - start :] if pieces else heights)
                wanted = end
        return Road(first, self._spacing, np.concatenate(pieces, axis=1)) if pieces else None

    def _forget_before(self, distance):
        limit = distance / self._spacing
        for first in [f for f, heights in self._patches.items() if f + heights.shape[1] < limit]:
            del self._patches[first]


def _reaches(road, rear, front):
    if road is None:
        return False
    return road.first * road.spacing <= rear and front < (road.first + road.height.shape[1] - 1) * road.spacing
