"""The M113 in an independent code, Project Chrono: histories of the hull's vertical acceleration.

Rigid shoes with frictional contact, on level ground and on one road of class C; a run a case. Facts about the vehicle
are in the notes of `data/vehicles/m113.yaml`.
"""

import gzip
from functools import cache
from typing import NamedTuple

import numpy as np

from ...data import m113_histories_file, m113_standing_file
from ...road.iso8608 import SPACING, Exponential, Iso8608Road
from ...road.obstacles import LevelRoad

LEVEL, ROUGH = "level", "C"
RATE = 1000  # means a second
_ROADS = {ROUGH: Iso8608Road("C", 1, 2.0, 8.0, Exponential(1.4))}  # the very road that the code was given, to 5e-6 m
_HEAD, _CASES = 2, 4  # lines
_STANDING_HEAD = 2


class Reference(NamedTuple):
    """One case."""

    road: str  # `LEVEL` or `ROUGH`
    speed: float  # m/s
    start: float  # place along the road of the first mean, m
    vertical: np.ndarray  # (k,) specific force along the hull's z axis at its centre of mass, means over 1 ms, m/s^2

    @property
    def name(self):
        """What the case is called."""
        return f"{self.road} {self.speed:.0f} m/s"

    @property
    def place(self):
        """Where each mean was taken, (k,) m along the road; the code's own places are within 4 cm."""
        return self.start + self.speed / RATE * np.arange(len(self.vertical))


def road_of(case):
    """Return the road of a case's name, for `road.feeder`."""
    return _ROADS.get(case, LevelRoad(SPACING))


@cache
def references():
    """Return all cases by (road, nominal speed)."""
    with gzip.open(m113_histories_file(), "rt", encoding="utf-8") as file:
        lines = file.read().splitlines()
    heads = [line.removeprefix("# ").split(",") for line in lines[_HEAD : _HEAD + _CASES]]
    values = np.loadtxt(lines[_HEAD + _CASES :], delimiter=",")
    found = [
        Reference(road, float(speed), float(start), column)
        for (road, speed, start), column in zip(heads, values.T, strict=True)
    ]
    return {(each.road, round(each.speed)): each for each in found}


@cache
def standing_octaves():
    """Return the RMS values [m/s^2] in the third octaves of `measures.THIRD_OCTAVES` while the vehicle stands."""
    return tuple(np.loadtxt(m113_standing_file(), delimiter=",", skiprows=_STANDING_HEAD)[:, 1].tolist())
