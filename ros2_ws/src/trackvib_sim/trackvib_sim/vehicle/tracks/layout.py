"""How a track is laid: taut round wheels, rollers, idler and sprocket, every link at pretension.

Places are those in the hull, x and z, at static ride height. A tensioner's travel is that of the idler along x.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull, QhullError

from ...numerics.compiled import kernel
from ..body_tree import GRAVITY, SIDE_NAMES, SIDES, drive_end, mass_of_bodies
from .sprockets import pitch_radius

_CORNERS = 2000  # of the polygons that stand for circles; they are 1e-6 of the radius too small
_KEPT = 64  # lines that are kept: an idler's place is sought on both sides, and again in every run of a vehicle
_REFINEMENTS = 6  # of a pin's place on the line; each gains two digits where the line bends most
_CLOSINGS = 3  # walks round the line; each closes it to a fiftieth of the one before


class TrackDoesNotFit(ValueError):
    """The links cannot be laid round the running gear within the tensioner's travel."""


def fit_idler(vehicle, side):
    """Return the travel of a side's tensioner [m] at which its links, all at pretension, close round the running gear.

    Raises
    ------
    TrackDoesNotFit
        There is no such travel.
    """
    limit, outwards, excess = vehicle.tensioners.travel, -drive_end(vehicle), _excess(vehicle, side)
    if not excess(outwards * limit) <= 0.0 <= excess(-outwards * limit):
        t, (fewest, most) = vehicle.tracks, room_for_links(vehicle, side)
        raise TrackDoesNotFit(
            f"tracks.links x tracks.pitch is {t.links[side] * t.pitch:.3f} m on the {SIDE_NAMES[side]}, must be "
            f"{fewest * t.pitch:.3f} to {most * t.pitch:.3f} m to fit round the running gear within the "
            f"tensioners.travel of {limit:g} m"
        )
    return outwards * brentq(lambda travel: excess(outwards * travel), -limit, limit, xtol=1e-9)


def room_for_links(vehicle, side):
    """Return how many links go round a side's running gear with its tensioner all in and all out, no whole numbers."""
    limit, t, excess = vehicle.tensioners.travel, vehicle.tracks, _excess(vehicle, side)
    return sorted(t.links[side] - excess(travel) / t.pitch for travel in (-limit, limit))


def _excess(vehicle, side):
    """Return a function of the travel [m]: how much longer a side's links at pretension are than the taut line [m]."""
    gear, links, pitch = _running_gear(vehicle, side), int(vehicle.tracks.links[side]), vehicle.tracks.pitch
    return lambda travel: _excess_round(gear.at(travel), links, pitch)


@lru_cache(maxsize=_KEPT)
def _excess_round(gear, links, pitch):
    line = _line_round(gear)
    return _walk(line, links, pitch, 0.0)[-1] - line.arc[-1]


def idler_load(vehicle, side, travel):
    """Return the force [N] along x with which the pretension of both runs pulls an idler."""
    line = _taut_line(vehicle, side, travel)
    hub = (vehicle.idlers.x + travel, vehicle.idlers.z)
    touching = np.flatnonzero(np.hypot(*(line.corner - hub).T) < _idler_circle(vehicle) + 1e-9)
    tangent = np.diff(line.corner, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    # the runs pull along the line: against its way in, and along its way out
    return vehicle.tracks.pretension[side] * (tangent[touching[-1], 0] - tangent[touching[0] - 1, 0])


def end_runs(vehicle, side, travel):
    """Return what a standing track's ends pull with, forces (2, 2) [N], x and z: at the rear and at the front.

    Each is the tension of the run down to the end wheel and, against it, that of the level runs; the end wheel is
    pulled the opposite way.
    """
    line, cut = _cut(vehicle, side, travel)
    down = np.diff(line.corner, axis=0)[cut]
    down *= -np.sign(down[:, 1:]) / np.linalg.norm(down, axis=1)[:, None]
    down = down[np.argsort(line.corner[cut, 0])]
    return vehicle.tracks.pretension[side] * (down - np.array([[1.0, 0.0], [-1.0, 0.0]]))


def upper_weight(vehicle, side, travel):
    """Return the weight [N] of those links of one track that hang on sprocket, rollers and idler."""
    line, cut = _cut(vehicle, side, travel)
    above = abs(np.diff(line.arc[cut])[0]) / line.arc[-1]
    # the line begins under a road wheel, so that what lies between the cuts is the upper part
    return above * vehicle.tracks.links[side] * vehicle.tracks.shoe_mass * GRAVITY


def _cut(vehicle, side, travel):
    """The taut line and its two sides that are cut at half the height of the lower end wheel's lowest point."""
    line, idlers = _taut_line(vehicle, side, travel), vehicle.idlers
    lowest = min(idlers.z - idlers.radius, vehicle.sprockets.z - pitch_radius(vehicle))
    above = line.corner[:, 1] > 0.5 * max(lowest, 3.0 * sink(vehicle))
    return line, np.flatnonzero(above[:-1] != above[1:])


def assemble_track(vehicle, side, travel, phase):
    """Return places (n, 2) of a side's pins in the order of the chain and the line's directions (n, 2) there.

    The first pin lies `phase` pitches ahead of the rearmost road wheel's lowest point.
    """
    line, t = _taut_line(vehicle, side, travel), vehicle.tracks
    arc = _close(line, int(t.links[side]), t.pitch, phase * t.pitch)
    place = line.at(arc)
    step = 1e-4
    direction = line.at(arc + step) - line.at(arc - step)
    return place, direction / np.linalg.norm(direction, axis=1)[:, None]


def sink(vehicle):
    """Return how far the road wheels' rubber gives under an equal share of the weight of all bodies [m]."""
    weight = mass_of_bodies(vehicle) * GRAVITY
    return weight / (len(SIDES) * vehicle.swing_arms.stations * vehicle.tyres.radial_stiffness)


def _idler_circle(vehicle):
    """Radius on which the pins of a wrapped chain stand: it is the links that touch the rim, in their middles."""
    return np.hypot(vehicle.idlers.radius, 0.5 * vehicle.tracks.pitch)


class _Line:
    """A closed polygon, counter-clockwise, by its arc length from the first corner."""

    def __init__(self, corner):
        self.corner = np.vstack((corner, corner[:1]))
        self.arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(self.corner, axis=0), axis=1))))

    def at(self, arc):
        """Return the places (..., 2) at arc lengths."""
        arc = np.mod(arc, self.arc[-1])
        return np.stack([np.interp(arc, self.arc, self.corner[:, k]) for k in range(2)], axis=-1)


class _RunningGear(NamedTuple):
    """What one track is laid round: circles (x, z, radius)."""

    in_place: tuple
    idler: tuple
    first: tuple  # place near which the line begins

    def at(self, travel):
        """Return the same at another travel of the tensioner [m]."""
        x, z, radius = self.idler
        return self._replace(idler=(x + travel, z, radius))


def _running_gear(vehicle, side):
    """Return the `_RunningGear` of a side, its tensioner in the middle."""
    v, wheels, given = vehicle, vehicle.road_wheels, sink(vehicle)
    if not given < wheels.radius:
        raise TrackDoesNotFit(
            f"tyres.radial_stiffness is {v.tyres.radial_stiffness:g} N/m, so that the road wheels deflect by "
            f"{given:g} m "
            f"under the vehicle's weight, must be less than road_wheels.radius, {wheels.radius:g} m"
        )
    rollers, wheel_x = v.carrier_rollers, v.swing_arms.places[side]
    in_place = (
        *((x, wheels.radius, wheels.radius - given) for x in wheel_x),
        *((x, z, rollers.radius) for x, z in (zip(rollers.x, rollers.z, strict=True) if rollers else ())),
        (v.sprockets.x, v.sprockets.z, pitch_radius(v)),
    )
    return _RunningGear(in_place, (v.idlers.x, v.idlers.z, _idler_circle(v)), (min(wheel_x), given))


def _taut_line(vehicle, side, travel):
    return _line_round(_running_gear(vehicle, side).at(travel))


@lru_cache(maxsize=_KEPT)
def _line_round(gear):
    corner = _outline(np.concatenate((_outline_of(gear.in_place), _corners(*gear.idler))))
    lowest_rear = np.argmin(np.hypot(*(corner - gear.first).T))
    return _Line(np.roll(corner, -lowest_rear, axis=0))


@lru_cache(maxsize=_KEPT)
def _outline_of(circles):
    """Return the corners (n, 2) round circles (x, z, radius)."""
    return _outline(np.concatenate([_corners(*circle) for circle in circles]))


def _corners(x, z, radius):
    """Return the polygon (n, 2) that stands for a circle."""
    angle = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    return np.stack((x + radius * np.cos(angle), z + radius * np.sin(angle)), axis=1)


def _outline(points):
    """Return those of some points (n, 2) that are corners of their convex hull, counter-clockwise."""
    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        length, height = np.ptp(points, axis=0)
        raise TrackDoesNotFit(
            f"the running gear is {length:g} m long and {height:g} m high, must leave room within a track"
        ) from None


def _walk(line, links, pitch, start):
    """Arc lengths (n + 1,) of pins whose straight distance is the pitch."""
    arc = np.empty(links + 1)
    arc[0] = start
    _lay_pins(line.corner, line.arc, pitch, arc)
    return arc


def _close(line, links, pitch, start):
    """Arc lengths (n,) of pins whose straight distance is all round the same, next to the pitch.

    The chords on the arcs are cut otherwise at every start, so that links of the pitch itself do not quite close.
    """
    for _ in range(_CLOSINGS):
        arc = _walk(line, links, pitch, start)
        pitch -= (arc[-1] - arc[0] - line.arc[-1]) / links
    return arc[:-1]


@kernel
def _lay_pins(corner, along, pitch, arc):
    """Fill all but the first of the arc lengths; `along` are those of the corners."""
    x, z = _place(corner, along, arc[0])
    for i in range(len(arc) - 1):
        there = arc[i] + pitch
        for _ in range(_REFINEMENTS):
            next_x, next_z = _place(corner, along, there)
            there += pitch - np.hypot(next_x - x, next_z - z)
        x, z = _place(corner, along, there)
        arc[i + 1] = there


@kernel
def _place(corner, along, arc):
    """Return the place at an arc length on a closed line."""
    left = arc % along[-1]
    k = min(max(np.searchsorted(along, left, side="right") - 1, 0), len(along) - 2)
    part = (left - along[k]) / (along[k + 1] - along[k])
    x, z = corner[k]
    return x + part * (corner[k + 1, 0] - x), z + part * (corner[k + 1, 1] - z)
