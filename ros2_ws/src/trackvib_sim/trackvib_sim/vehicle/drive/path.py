"""The path in the plane: laid just ahead of the vehicle's front, a chain of short arcs.

The road's heights are known by the distance along the path, left and right of it. A place belongs to the distance of
the point of the path that is nearest to it, so that the road under a shoe that lies still lies still, too; on the
inside of a curve the road is shorter by 1 - curvature times offset (as in OpenCRG).
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from .schedule import wanted_curvature

SPACING = 0.2  # m of one arc
SAMPLES = 1024  # that are kept, a power of two: 200 m of path
_MASK = SAMPLES - 1
HIGHEST_CURVATURE = 0.1  # 1/m; below a radius of 10 m tracks are not steered but pivoted
_MOST_CHANGE = 0.02 * SPACING  # 1/m from arc to arc, about as fast as a steering wheel is turned
LEFT_BEHIND = 3.0  # m; a vehicle so far beside a curved path cannot take the curve


class Path(NamedTuple):
    """The latest samples and where the hull is, changed in place; sample k stands in place k of the power of two."""

    place: np.ndarray  # (2, SAMPLES) x and y, m
    heading: np.ndarray  # (SAMPLES,) rad
    curvature: np.ndarray  # (SAMPLES,) of the arc that begins there, 1/m, to the left
    newest: np.ndarray  # (1,) number of the newest sample; number k lies at the distance k SPACING
    curved: np.ndarray  # (1,) whether there has been any curve
    distance: np.ndarray  # (1,) of the hull's origin, m
    offset: np.ndarray  # (1,) of the hull's origin to the left, m


def new_path():
    """Return a path that ends at the origin, straight along the x axis."""
    x = SPACING * np.roll(np.arange(-_MASK, 1), 1)
    return Path(
        place=np.array([x, np.zeros(SAMPLES)]),
        heading=np.zeros(SAMPLES),
        curvature=np.zeros(SAMPLES),
        newest=np.zeros(1, np.int64),
        curved=np.zeros(1, np.bool_),
        distance=np.zeros(1),
        offset=np.zeros(1),
    )


@kernel
def follow_path(path, schedule, wanted, x, y, reach):
    """Find where the hull's origin at x, y [m] is on the path, and lay the path to `reach` [m] ahead of it."""
    distance = path_distance(path, x, y, path.distance[0])
    path.distance[0] = distance
    path.offset[0] = y
    if path.curved[0]:
        px, py, tx, ty, _ = path_point(path, distance)
        path.offset[0] = tx * (y - py) - ty * (x - px)
    while path.newest[0] * SPACING < distance + reach:
        last, new = path.newest[0] & _MASK, (path.newest[0] + 1) & _MASK
        curvature, heading = path.curvature[last], path.heading[last]
        half = 0.5 * curvature * SPACING
        chord = SPACING * (1.0 - half * half / 6.0)
        path.place[0, new] = path.place[0, last] + chord * np.cos(heading + half)
        path.place[1, new] = path.place[1, last] + chord * np.sin(heading + half)
        path.heading[new] = heading + 2.0 * half
        path.newest[0] += 1
        change = wanted_curvature(schedule, wanted, path.newest[0] * SPACING) - curvature
        path.curvature[new] = curvature + min(max(change, -_MOST_CHANGE), _MOST_CHANGE)
        if path.curvature[new] != 0.0:
            path.curved[0] = True


@inlined
def path_point(path, distance):
    """Return the path at a distance [m]: x, y [m], the unit vector along it, and its curvature [1/m]."""
    number = min(int(np.floor(distance / SPACING)), path.newest[0])
    i, on = number & _MASK, distance - number * SPACING
    curvature, turned = path.curvature[i], path.curvature[i] * on
    # the arc to the third order in the angle, which is below 0.02
    ahead, left = on * (1.0 - turned * turned / 6.0), 0.5 * turned * on
    cosine, sine = np.cos(path.heading[i]), np.sin(path.heading[i])
    x = path.place[0, i] + ahead * cosine - left * sine
    y = path.place[1, i] + ahead * sine + left * cosine
    direction = path.heading[i] + turned
    return x, y, np.cos(direction), np.sin(direction), curvature


@inlined
def path_distance(path, x, y, guess):
    """Return the distance [m] that belongs to a place x, y [m], given one within some metres of it."""
    return _nearest(path, x, y, guess) if path.curved[0] else x


@kernel
def _nearest(path, x, y, guess):
    """Return the distance [m] of the nearest point of a path with curves (Newton)."""
    for _ in range(8):
        px, py, tx, ty, curvature = path_point(path, guess)
        along, left = tx * (x - px) + ty * (y - py), tx * (y - py) - ty * (x - px)
        step = along / max(1.0 - curvature * left, 0.1)
        guess += step
        if abs(step) < 1e-9:
            break
    return guess


@kernel
def path_heading(path):
    """Return direction [rad] and curvature [1/m] of the path where the hull is."""
    number = min(int(np.floor(path.distance[0] / SPACING)), path.newest[0])
    i = number & _MASK
    return path.heading[i] + path.curvature[i] * (path.distance[0] - number * SPACING), path.curvature[i]


@kernel
def path_is_left(path, reach):
    """Return whether a vehicle of that reach [m] has left a curved path, or gone back to where it is forgotten."""
    forgotten = (path.newest[0] - SAMPLES + 1) * SPACING
    return path.curved[0] and (abs(path.offset[0]) > LEFT_BEHIND or path.distance[0] - reach < forgotten)
