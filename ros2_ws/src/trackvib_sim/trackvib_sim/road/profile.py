"""A road from measured or computed heights: a `Profile`, and the `ProfileRoad` that is made of it."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

FINEST, COARSEST = 1e-3, 1.0  # m between samples of a road
MOST = 20_000_000  # samples of a profile
STEEPEST = 20.0  # m/m; what rises more steeply is a wall
HIGHEST_WALL = 1.2  # m, about what the best of battle tanks climb
ROUGHEST = 2.0  # m up and down per metre; class H has 0.4, class A with its millimetres taken for metres 3
HIGHEST = 1000.0  # m
_ROUNDING = 1e-9  # of distances
_EVEN = 1e-3  # of the spacing: samples that are less far from their places are even


class ProfileError(ValueError):
    """A profile that cannot be driven on; the message names the item, its value and what is accepted."""


class Profile(NamedTuple):
    """Heights over distance, left and right.

    Examples
    --------
    >>> import numpy as np
    >>> import trackvib_sim as tv
    >>> tv.Profile(np.array([0.0, 0.1]), np.zeros((2, 2))).heights.shape
    (2, 2)
    """

    distance: np.ndarray  # (n,) m, rising
    heights: np.ndarray  # (2, n) left, right, m


def checked(distance, heights, name):
    """Return the `Profile` of a distance (n,) and heights (2, n) [m], both checked whole.

    Raises
    ------
    ProfileError
        Something is not finite, out of order, out of range, too steep, or needs too many samples.
    """
    distance, heights = np.asarray(distance, dtype=float), np.asarray(heights, dtype=float)
    if not 2 <= len(distance) <= MOST:
        raise ProfileError(f"{name}: {len(distance)} samples, accepted: 2 to {MOST}")
    sides = ("left", heights[0]), ("right", heights[1])
    for what, values in (("distance", distance), *((f"{side} height", values) for side, values in sides)):
        odd = np.flatnonzero(~np.isfinite(values))
        if odd.size:
            raise ProfileError(f"{name}: {what} of sample {odd[0] + 1} is {values[odd[0]]}, accepted: finite numbers")
    with np.errstate(over="ignore"):  # infinite is too far as well
        step = np.diff(distance)
    _require_order(distance, step, name)
    for side, values in sides:
        _require_ground(distance, step, values, f"{name}: {side}")
    spacing, _ = _grid(distance)
    count = (distance[-1] - distance[0]) / spacing + 1.0
    if not 2.0 <= count <= MOST + 1.0:
        raise ProfileError(
            f"{name}: {distance[-1] - distance[0]:g} m are {count:.0f} samples at the least distance between them, "
            f"{spacing:g} m; accepted: 2 to {MOST}"
        )
    return Profile(distance, heights)


def _require_order(distance, step, name):
    odd = np.flatnonzero(step <= 0.0)
    if odd.size:
        k = odd[0]
        raise ProfileError(
            f"{name}: distance goes from {distance[k]:g} to {distance[k + 1]:g} m at sample {k + 2}, must rise"
        )
    if step.max() > COARSEST * (1.0 + _ROUNDING):
        k = step.argmax()
        raise ProfileError(f"{name}: a gap of {step[k]:g} m from {distance[k]:g} m on, accepted: up to {COARSEST:g} m")


def _require_ground(distance, step, values, side):
    """Refuse heights of one side that no ground has; in a wrong unit, most likely."""
    if np.abs(values).max() > HIGHEST:
        raise ProfileError(f"{side} is {values[np.abs(values).argmax()]:g} m high, accepted: {HIGHEST:g} m")
    rise = np.abs(np.diff(values))
    wall = np.where(rise > STEEPEST * step, rise, 0.0)
    if wall.max() > HIGHEST_WALL:
        k = wall.argmax()
        raise ProfileError(
            f"{side} rises by {values[k + 1] - values[k]:g} m from {distance[k]:g} m on over {step[k]:g} m, "
            f"accepted: {HIGHEST_WALL:g} m, or {STEEPEST:g} m/m; is the unit right?"
        )
    roughness = rise.sum() / max(distance[-1] - distance[0], COARSEST)
    if roughness > ROUGHEST:
        raise ProfileError(
            f"{side} goes up and down by {roughness:.3g} m per metre, accepted: up to {ROUGHEST:g}; is the unit right?"
        )


def _grid(distance):
    """Return the distance [m] between a road's samples, and whether those of the profile lie there already."""
    step, count = np.diff(distance), len(distance)
    mean = (distance[-1] - distance[0]) / (count - 1)
    off = np.abs(distance - distance[0] - mean * np.arange(count)).max()
    if mean >= FINEST * (1.0 - _ROUNDING) and off <= _EVEN * mean:
        # of one number rather than of a difference, so that a file read back has the spacing it was written with
        return float(f"{mean:.9g}"), True
    return float(max(step.min(), FINEST)), False


@dataclass(frozen=True, eq=False)
class ProfileRoad:
    """A `Profile` as a road: level before and after it, at the heights of its ends, or repeated.

    Each side begins at height zero, for a vehicle starts on level ground. Samples of a profile that are evenly spaced,
    1 mm to 1 m, stay as they are. Others are taken by linear interpolation at the least distance between them, at least
    1 mm.

    Examples
    --------
    >>> import numpy as np
    >>> import trackvib_sim as tv
    >>> step = tv.Profile(0.1 * np.arange(100), np.zeros((2, 100)) + (np.arange(100) > 50))
    >>> tv.ProfileRoad(step, start=20.0).heights(first=249, count=4)[0].tolist()
    [0.0, 0.0, 1.0, 1.0]
    """

    profile: Profile
    start: float = 0.0  # m along the road at which it begins
    reverse: bool = False
    repeat: bool = False  # without end, each side's mean slope taken out, so that its end meets its beginning

    @property
    def begins(self) -> float:
        """Distance at which it begins [m]."""
        return self.start

    @property
    def ends(self) -> float:
        """Distance at which it ends [m]; infinite where it is repeated."""
        return np.inf if self.repeat else self.start + self.spacing * (self._samples.shape[1] - 1)

    @property
    def spacing(self) -> float:
        """Distance between the road's samples [m]."""
        return self._grid[0]

    @property
    def even(self) -> bool:
        """Whether the samples are used unchanged."""
        return self._grid[1]

    @cached_property
    def _grid(self):
        return _grid(self.profile.distance)

    @cached_property
    def _samples(self):
        distance, heights = self.profile
        if self.reverse:
            heights = heights[:, ::-1]
            distance = distance[-1] - distance[::-1]
        else:
            distance = distance - distance[0]
        if not self.even:
            grid = self.spacing * np.arange(int(distance[-1] / self.spacing) + 1)
            heights = np.stack([np.interp(grid, distance, side) for side in heights])
        heights = heights - heights[:, :1]
        if self.repeat:
            heights = heights - np.arange(heights.shape[1]) / (heights.shape[1] - 1) * heights[:, -1:]
        return np.ascontiguousarray(heights)

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""
        samples = self._samples
        index = np.arange(first, first + count) - round(self.start / self.spacing)
        if self.repeat:
            return samples[:, index % (samples.shape[1] - 1)]
        return samples[:, np.clip(index, 0, samples.shape[1] - 1)]
