"""The state in which the tracks are laid and everything begins to roll."""

from math import pi

import numpy as np

from ..body_tree import GRAVITY, SIDES, drive_end, mass_of_bodies
from .layout import assemble_track, sink
from .nodes import STRIDE
from .sprockets import pitch_radius

DRAG = 0.06  # of the weight, rolling resistance that the driver expects


def assemble_tracks(vehicle, system, state, speed, phase):
    """Lay both tracks round the running gear of a vehicle on level ground at x = y = 0, and set all rolling at a speed.

    The right track lies `phase` pitches further along its way than the left one. Tension, rotation of the wheels and
    teeth fit together but for the weights of the upper runs and the polygon effect; a run-in settles those.
    """
    tracks, height, radius = system.tracks, -sink(vehicle), pitch_radius(vehicle)
    end = drive_end(vehicle)
    state.tree.position[:, 2] += height
    state.tree.velocity[:, 0] = speed
    weight = mass_of_bodies(vehicle) * GRAVITY
    state.drive.driving.speed_integral[0] = np.sign(speed) * DRAG * weight
    state.tree.hinge_rate[tracks.wheels.row] = speed / tracks.wheels.radius
    state.tree.hinge_rate[tracks.sprockets.row] = speed / radius
    state.tracks.tensioner.travel[:] = tracks.tensioner.fitted
    sprocket = np.array([vehicle.sprockets.x, vehicle.sprockets.z])
    for side, sign in SIDES.items():
        n, travel = tracks.chain.links[side], tracks.tensioner.fitted[side]
        place, direction = assemble_track(vehicle, side, travel, phase if side else 0.0)
        node = state.tracks.nodes[side].reshape(-1, STRIDE)[:, 1 : n + 1]
        node[0], node[1], node[2] = place[:, 0], sign * vehicle.sprockets.y, place[:, 1] + height
        # against the order of the chain, which lies still on the ground
        node[3], node[5] = speed * (1.0 - direction[:, 0]), -speed * direction[:, 1]
        touched = [1 + _nearest(place, point) for point in _touched_points(vehicle, side, travel)]
        state.tracks.link[side] = touched
        outermost, teeth = _nearest(place, sprocket + (end * radius, 0.0)), tracks.sprockets.teeth
        angle = _tooth_angle(place - sprocket, radius, teeth)
        x, z = place[outermost] - sprocket
        state.tree.hinge[tracks.sprockets.row[side]] = angle
        state.tracks.outermost[side] = 1 + outermost
        state.tracks.passed[side] = 0.5 * (angle - np.arctan2(-end * z, end * x)) * teeth / pi


def _touched_points(vehicle, side, travel):
    """Where each wheel touches the chain, in the order of `wheels.Wheels`."""
    v, rollers, idlers, wheels = vehicle, vehicle.carrier_rollers, vehicle.idlers, vehicle.road_wheels
    yield from ((x, 0.0) for x in v.swing_arms.places[side])
    if rollers:
        yield from ((x, z + rollers.radius) for x, z in zip(rollers.x, rollers.z, strict=True))
    else:
        yield from ((x, 2.0 * wheels.radius) for x in v.swing_arms.places[side])
    yield idlers.x + travel - drive_end(v) * idlers.radius, idlers.z


def _nearest(place, point):
    return int(np.argmin(np.hypot(*(place - point).T)))


def _tooth_angle(from_hub, radius, teeth):
    """Angle of a sprocket [rad, about +y] at which the pins on its pitch circle lie in the gaps."""
    seated = from_hub[np.hypot(*from_hub.T) < radius + 1e-4]
    angle = np.arctan2(-seated[:, 1], seated[:, 0])
    return np.angle(np.exp(1j * teeth * angle).mean()) / teeth % (2.0 * pi / teeth)
