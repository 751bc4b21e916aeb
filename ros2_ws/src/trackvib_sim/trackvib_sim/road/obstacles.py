"""Obstacles of proving grounds, on one side or both, that stand on any road.

Half-rounds are the obstacles of the ride tests of NRMM, the NATO Reference Mobility Model [NRMM], ramps and square
bumps those of tank trials such as [Sattinger1954], sine waves the washboard courses of Aberdeen Proving Ground.

[NRMM] R. B. Ahlvin, P. W. Haley, NATO Reference Mobility Model, edition II, TR GL-92-19, US Army WES, 1992.
[Sattinger1954] I. J. Sattinger and others, Analysis of the suspension system of the M47 tank by means of simulation
techniques, 2023-2-T, University of Michigan, 1954.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from .profile import HIGHEST_WALL

FINE = 0.01  # m between samples of a road with obstacles

Place = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False, json_schema_extra={"unit": "m"})]
Size = Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False, json_schema_extra={"unit": "m"})]
Height = Annotated[float, Field(gt=0.0, le=3.0, allow_inf_nan=False, json_schema_extra={"unit": "m"})]
Wall = Annotated[float, Field(gt=0.0, le=HIGHEST_WALL, allow_inf_nan=False, json_schema_extra={"unit": "m"})]


class _Obstacle(BaseModel):
    """Begins at distance `at` [m] and is `end` long."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    at: Place
    """Distance at which it begins."""
    side: Literal["both", "left", "right"] = "both"
    """Tracks under which it lies."""

    def heights(self, distance):
        """Return its height [m] at distances (n,) [m]; zero before and behind it."""
        x = distance - self.at
        return np.where((x > 0.0) & (x < self.end), self.shape_at(np.clip(x, 0.0, self.end)), 0.0)


class HalfRound(_Obstacle):
    """Half a cylinder across the road."""

    shape: Literal["half_round"]
    """Half a cylinder."""
    radius: Height
    """Radius."""

    @property
    def end(self):
        """Length [m]."""
        return 2.0 * self.radius

    def shape_at(self, x):
        """Height [m] at distances from its beginning."""
        return np.sqrt(np.maximum(self.radius**2 - (x - self.radius) ** 2, 0.0))


class _Lengthwise(_Obstacle):
    """Its length is given."""

    length: Size
    """Length along the road."""

    @property
    def end(self):
        """Length [m]."""
        return self.length

    def plateau(self, x, ramp):
        """Part of the whole height at distances from its beginning: 0 to 1 over a ramp [m], level, and back."""
        ramp = min(ramp, 0.5 * self.length)
        return np.minimum(1.0, np.minimum(x, self.length - x) / ramp)


class Step(_Lengthwise):
    """A step up, and down again after its length: a square bump. Edges are one sample long.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Step(shape="step", at=10.0, height=0.3, length=0.3).end
    0.3
    """

    shape: Literal["step"]
    """Up and down again."""
    height: Wall
    """Height."""

    def shape_at(self, x):
        """Height [m] at distances from its beginning."""
        return np.full_like(x, self.height)


class VRamp(_Lengthwise):
    """An inverted V: up over half its length, down over the other."""

    shape: Literal["v_ramp"]
    """Up to the middle and down."""
    height: Height
    """Height."""

    def shape_at(self, x):
        """Height [m] at distances from its beginning."""
        return self.height * (1.0 - np.abs(2.0 * x / self.length - 1.0))


class Trapezoid(_Lengthwise):
    """Up over a ramp, level, and down over another; `length` is all of it."""

    shape: Literal["trapezoid"]
    """Up, level, down."""
    height: Height
    """Height."""
    ramp: Size
    """Length of each slope."""

    def shape_at(self, x):
        """Height [m] at distances from its beginning."""
        return self.height * self.plateau(x, self.ramp)


class Sine(_Obstacle):
    """Waves, a washboard: `count` of them, `height` from trough to crest, beginning and ending in a trough."""

    shape: Literal["sine"]
    """Washboard, from trough to crest."""
    height: Height
    """Height from trough to crest."""
    wavelength: Size
    """Length of a wave."""
    count: Annotated[int, Field(ge=1, le=100_000)] = 1
    """Number of waves."""

    @property
    def end(self):
        """Length [m]."""
        return self.count * self.wavelength

    def shape_at(self, x):
        """Height [m] at distances from its beginning."""
        return 0.5 * self.height * (1.0 - np.cos(2.0 * np.pi * x / self.wavelength))


class Pothole(_Lengthwise):
    """A hole: down over a ramp, level, and up again; `length` is all of it."""

    shape: Literal["pothole"]
    """Down, level, up."""
    depth: Height
    """Depth."""
    ramp: Size = FINE
    """Length of each slope."""

    def shape_at(self, x):
        """Height [m] at distances from its beginning, below zero."""
        return -self.depth * self.plateau(x, self.ramp)


Obstacle = Annotated[HalfRound | Step | VRamp | Trapezoid | Sine | Pothole, Field(discriminator="shape")]


@dataclass(frozen=True)
class ObstacleRoad:
    """Obstacles on a road; where they overlap their heights add up.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> bump = tv.Step(shape="step", at=10.0, height=0.3, length=0.3, side="left")
    >>> tv.ObstacleRoad(tv.LevelRoad(0.01), (bump,)).heights(first=1010, count=1)
    array([[0.3],
           [0. ]])
    """

    ground: object  # whatever gives heights
    obstacles: tuple

    @property
    def spacing(self) -> float:
        """Distance between samples [m], that of the ground."""
        return self.ground.spacing

    @property
    def begins(self) -> float:
        """Distance from which the ground has its full roughness [m]."""
        return self.ground.begins

    @property
    def ends(self) -> float:
        """Distance at which the ground and the last obstacle end [m]."""
        return max(self.ground.ends, *(obstacle.at + obstacle.end for obstacle in self.obstacles))

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""
        heights = self.ground.heights(first, count).copy()
        distance = self.spacing * np.arange(first, first + count)
        for obstacle in self.obstacles:
            if distance[0] <= obstacle.at + obstacle.end and distance[-1] >= obstacle.at:
                sides = {"both": slice(None), "left": slice(0, 1), "right": slice(1, 2)}[obstacle.side]
                heights[sides] += obstacle.heights(distance)
        return heights


@dataclass(frozen=True)
class LevelRoad:
    """A road of height zero everywhere.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.LevelRoad(0.05).heights(first=-3, count=2).tolist()
    [[0.0, 0.0], [0.0, 0.0]]
    """

    spacing: float = FINE  # m, between samples
    begins = ends = 0.0  # m

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], all zero."""
        return np.zeros((2, count))
