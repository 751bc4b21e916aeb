"""How a track is laid: taut round wheels, rollers, idler and sprocket, every link at pretension.

Places are those in the hull, x and z, at static ride height.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull, QhullError

from ..body_tree import GRAVITY, SIDES, STATIONS, build_body_table
from .sprockets import pitch_radius

_CORNERS = 2000  # of the polygons that stand for circles; they are 1e-6 of the radius too small
_REFINEMENTS = 6  # of a pin's place on the line; each gains two digits where the line bends most


class TrackDoesNotFit(ValueError):
    """The links cannot be laid round the running gear within the tensioner's travel."""


def fit_idler(vehicle):
    """Return the travel of the tensioners [m] at which the links, all at pretension, close round the running gear.

    Raises
    ------
    TrackDoesNotFit
        There is no such travel.
    """
    t, limit = vehicle.tracks, vehicle.tensioners.travel

    def excess(travel):
        line = _taut_line(vehicle, travel)
        return _walk(vehicle, line, 0.0)[-1] - line.arc[-1]

    shortest, longest = excess(limit), excess(-limit)
    if not shortest <= 0.0 <= longest:
        pitches = [(t.links - value / t.pitch) * t.pitch for value in (longest, shortest)]
        raise TrackDoesNotFit(
            f"tracks.links x tracks.pitch is {t.links * t.pitch:.3f} m, must be {pitches[0]:.3f} to {pitches[1]:.3f} m "
            f"to fit round the running gear within the tensioners.travel of {limit:g} m"
        )
    return brentq(excess, -limit, limit, xtol=1e-9)


def idler_load(vehicle, travel):
    """Return the force [N] with which the pretension of both runs pulls an idler rearwards."""
    line = _taut_line(vehicle, travel)
    on_idler = np.hypot(*(line.corner - (vehicle.idlers.x[0] + travel, vehicle.idlers.z[0])).T)
    touching = np.flatnonzero(on_idler < _idler_circle(vehicle) + 1e-9)
    tangent = np.diff(line.corner, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    # the line enters the idler forwards and leaves it rearwards
    return vehicle.tracks.pretension * (tangent[touching[0] - 1, 0] - tangent[touching[-1], 0])


def end_runs(vehicle, travel):
    """Return what a standing track's ends pull with, forces (2, 2) [N], x and z: at the sprocket and at the idler.

    Each is the tension of the run down to the end wheel and, against it, that of the level runs; the end wheel is
    pulled the opposite way.
    """
    line, cut = _cut(vehicle, travel)
    down = np.diff(line.corner, axis=0)[cut]
    down *= -np.sign(down[:, 1:]) / np.linalg.norm(down, axis=1)[:, None]
    down = down[np.argsort(line.corner[cut, 0])]
    return vehicle.tracks.pretension * (down - np.array([[1.0, 0.0], [-1.0, 0.0]]))


def upper_weight(vehicle, travel):
    """Return the weight [N] of those links of one track that hang on sprocket, rollers and idler."""
    line, cut = _cut(vehicle, travel)
    above = abs(np.diff(line.arc[cut])[0]) / line.arc[-1]
    # the line begins under a road wheel, so that what lies between the cuts is the upper part
    return above * vehicle.tracks.links * vehicle.tracks.shoe_mass * GRAVITY


def _cut(vehicle, travel):
    """The taut line and its two sides that are cut at half the height of the idler's lowest point."""
    line = _taut_line(vehicle, travel)
    above = line.corner[:, 1] > 0.5 * (vehicle.idlers.z[0] - vehicle.idlers.radius)
    return line, np.flatnonzero(above[:-1] != above[1:])


def assemble_track(vehicle, travel, phase):
    """Return places (n, 2) of the pins in the order of the chain and the line's directions (n, 2) there.

    The first pin lies `phase` pitches ahead of the rearmost road wheel's lowest point.
    """
    line = _taut_line(vehicle, travel)
    arc = _walk(vehicle, line, phase * vehicle.tracks.pitch)
    # what little the chords on the arcs do not close is spread over all links
    arc = arc[:-1] - (arc[-1] - arc[0] - line.arc[-1]) * np.arange(len(arc) - 1) / (len(arc) - 1)
    place = line.at(arc)
    step = 1e-4
    direction = line.at(arc + step) - line.at(arc - step)
    return place, direction / np.linalg.norm(direction, axis=1)[:, None]


def sink(vehicle):
    """Return how far the road wheels' rubber gives under an equal share of the weight of all bodies [m]."""
    weight = sum(body.mass for body in build_body_table(vehicle)) * GRAVITY
    return weight / (len(SIDES) * STATIONS * vehicle.tyres.radial_stiffness)


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


def _taut_line(vehicle, travel):
    v, wheels, given = vehicle, vehicle.road_wheels, sink(vehicle)
    if not given < wheels.radius:
        raise TrackDoesNotFit(
            f"tyres.radial_stiffness is {v.tyres.radial_stiffness:g} N/m, so that the road wheels give by {given:g} m "
            f"under the vehicle's weight, must be less than road_wheels.radius, {wheels.radius:g} m"
        )
    circles = [
        *((x, wheels.radius, wheels.radius - given) for x in v.swing_arms.wheel_x),
        *((x, z, v.carrier_rollers.radius) for x, z in zip(v.carrier_rollers.x, v.carrier_rollers.z, strict=True)),
        (v.idlers.x[0] + travel, v.idlers.z[0], _idler_circle(v)),
        (v.sprockets.x[0], v.sprockets.z[0], pitch_radius(v)),
    ]
    angle = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    round_about = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    points = np.concatenate([np.array(circle[:2]) + circle[2] * round_about for circle in circles])
    try:
        corner = points[ConvexHull(points).vertices]
    except QhullError:
        length, height = np.ptp(points, axis=0)
        raise TrackDoesNotFit(
            f"the running gear is {length:g} m long and {height:g} m high, must leave room within a track"
        ) from None
    lowest_rear = np.argmin(np.hypot(*(corner - (min(v.swing_arms.wheel_x), given)).T))
    return _Line(np.roll(corner, -lowest_rear, axis=0))


def _walk(vehicle, line, start):
    """Arc lengths (n + 1,) of pins whose straight distance is the pitch."""
    t = vehicle.tracks
    arc = np.empty(int(t.links) + 1)
    arc[0] = start
    for i in range(len(arc) - 1):
        here, there = line.at(arc[i]), arc[i] + t.pitch
        for _ in range(_REFINEMENTS):
            there += t.pitch - np.hypot(*(line.at(there) - here))
        arc[i + 1] = there
    return arc
