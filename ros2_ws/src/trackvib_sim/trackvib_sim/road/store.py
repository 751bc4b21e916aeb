"""The stretch of road that a simulation holds, put together from patches."""

from typing import NamedTuple

import numpy as np

KEPT_BEHIND = 20.0  # m of road that has been driven over
_FINEST, _COARSEST = 1e-3, 100.0  # m between samples
_MOST = 20_000_000  # samples; 1000 km of them 5 cm apart
_FAR = 1e15  # samples, up to which whole numbers are exact in floating point


class Road(NamedTuple):
    """A stretch of road; sample i lies at distance (first + i) * spacing."""

    first: int
    spacing: float  # m
    height: np.ndarray  # (2, m) left, right, m


class RoadStore:
    """Patches of road, in any order, and the stretch without gap that they form around a place."""

    def __init__(self):
        self._spacing = None  # of the road that has been driven on, m
        self._patches = {}  # by spacing: first sample -> heights (2, m)
        self._stretch = None
        self._samples = 0  # of all patches, or somewhat more
        self._rear = None  # where it was looked for last, m

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
            raise ValueError(
                f"left has {len(left)} samples and right {len(right)}, must have equal numbers, at least 2"
            )
        if not _FINEST <= spacing <= _COARSEST:
            raise ValueError(f"spacing is {spacing} m, must be {_FINEST} to {_COARSEST} m")
        if self._spacing not in (None, spacing):
            raise ValueError(f"spacing is {spacing} m, must be {self._spacing} m as of the road before")
        if self._samples + len(left) > _MOST:
            raise ValueError(f"{self._samples} samples are already held, {len(left)} more exceed {_MOST}")
        heights = np.array([left, right], dtype=float)
        if not np.isfinite(heights).all():
            raise ValueError("a height is not finite, all must be")
        place = start / spacing
        first = round(place) if abs(place) < _FAR else 0
        if not abs(first * spacing - start) <= 1e-6 * spacing:
            raise ValueError(f"start is {start} m, must be a whole multiple of the spacing {spacing} m")
        patches = self._patches.get(spacing, {})
        held = patches.get(first, heights)
        common = min(held.shape[1], heights.shape[1])
        if not np.array_equal(held[:, :common], heights[:, :common]):
            raise ValueError(
                f"start is {start} m, where the road is already known with other heights: are there two roads?"
            )
        if heights.shape[1] >= held.shape[1]:
            self._patches.setdefault(spacing, {})[first] = heights
            self._samples += heights.shape[1]
        self._stretch = None

    def around(self, rear, front):
        """Return a `Road` that reaches from distance `rear` to beyond `front` [m], or None if there is a gap.

        Patches that lie far behind whoever drives on, forwards or backwards, are forgotten.
        """
        if not _reaches(self._stretch, rear, front):
            for spacing, patches in self._patches.items():
                self._forget_behind(spacing, patches, rear, front)
                self._stretch = _join(spacing, patches, int(np.floor(rear / spacing)))
                if _reaches(self._stretch, rear, front):
                    # a patch that stands alone does not tell the spacing: somebody may have sent it by mistake
                    self._spacing, self._patches = spacing, {spacing: patches}
                    break
            self._samples = sum(held.shape[1] for patches in self._patches.values() for held in patches.values())
            self._rear = rear
        return self._stretch if _reaches(self._stretch, rear, front) else None

    def _forget_behind(self, spacing, patches, rear, front):
        if self._rear is None:
            return
        if rear >= self._rear:
            behind = [f for f, heights in patches.items() if f + heights.shape[1] < (rear - KEPT_BEHIND) / spacing]
        else:
            behind = [f for f in patches if f > (front + KEPT_BEHIND) / spacing]
        for first in behind:
            del patches[first]


def _join(spacing, patches, wanted):
    """Patches that follow each other without gap, from the one that holds sample `wanted` on."""
    first, pieces = None, []
    for start in sorted(patches):
        heights = patches[start]
        end = start + heights.shape[1]
        if start <= wanted < end:
            first = start if first is None else first
            pieces.append(heights[:, wanted - start :] if pieces else heights)
            wanted = end
    return Road(first, spacing, np.concatenate(pieces, axis=1)) if pieces else None


def _reaches(road, rear, front):
    if road is None:
        return False
    return road.first * road.spacing <= rear and front < (road.first + road.height.shape[1] - 1) * road.spacing
