"""The state in which the tracks are laid and everything begins to roll."""

from math import pi

import numpy as np

from ..body_tree import GRAVITY, build_body_table
from .layout import assemble_track, sink
from .nodes import STRIDE
from .sprockets import pitch_radius

DRAG = 0.06  # of the weight, rolling resistance that the driver expects


def assemble_tracks(vehicle, system, state, speed, phase):
    """Lay both tracks round the running gear of a vehicle on level ground at x = y = 0, and set all rolling at a speed.

    The right track lies `phase` pitches further along its way than the left one. Tension, rotation of the wheels and
    teeth fit together but for the weights of the upper runs and the polygon effect; a run-in settles those.
    """
    tracks, travel, height = system.tracks, system.tracks.tensioner.fitted, -sink(vehicle)
    n, radius = tracks.chain.links, pitch_radius(vehicle)
    state.tree.position[0] = (0.0, 0.0, height)
    state.tree.velocity[0] = (speed, 0.0, 0.0)
    if speed > 0.0:
        state.speed_integral[0] = DRAG * sum(body.mass for body in build_body_table(vehicle)) * GRAVITY
    state.tree.hinge_rate[tracks.wheels.row] = speed / tracks.wheels.radius
    state.tree.hinge_rate[tracks.sprockets.row] = speed / radius
    state.tracks.tensioner.travel[:] = travel
    sprocket = np.array([vehicle.sprockets.x[0], vehicle.sprockets.z[0]])
    for side, y in enumerate((vehicle.sprockets.y, -vehicle.sprockets.y)):
        place, direction = assemble_track(vehicle, travel, phase if side else 0.0)
        node = state.tracks.nodes[side].reshape(-1, STRIDE)[:, 1 : n + 1]
        node[0], node[1], node[2] = place[:, 0], y, place[:, 1] + height
        # against the order of the chain, which lies still on the ground
        node[3], node[5] = speed * (1.0 - direction[:, 0]), -speed * direction[:, 1]
        state.tracks.link[side] = [1 + _nearest(place, point) for point in _lowest_points(vehicle, travel)]
        rear, teeth = _nearest(place, sprocket - (radius, 0.0)), tracks.sprockets.teeth
        angle = _tooth_angle(place - sprocket, radius, teeth)
        behind = np.arctan2(place[rear, 1] - sprocket[1], sprocket[0] - place[rear, 0])
        state.tree.hinge[tracks.sprockets.row[side]] = angle
        state.tracks.rear[side] = 1 + rear
        state.tracks.passed[side] = 0.5 * (angle - behind) * teeth / pi


def _lowest_points(vehicle, travel):
    """Where each wheel touches the chain, in the order of `wheels.Wheels`."""
    v, rollers = vehicle, vehicle.carrier_rollers
    yield from ((x, 0.0) for x in v.swing_arms.wheel_x)
    yield from ((x, z + rollers.radius) for x, z in zip(rollers.x, rollers.z, strict=True))
    yield v.idlers.x[0] + travel + v.idlers.radius, v.idlers.z[0]


def _nearest(place, point):
    return int(np.argmin(np.hypot(*(place - point).T)))


def _tooth_angle(from_hub, radius, teeth):
    """Angle of a sprocket [rad, about +y] at which the pins on its pitch circle lie in the gaps."""
    seated = from_hub[np.hypot(*from_hub.T) < radius + 1e-4]
    angle = np.arctan2(-seated[:, 1], seated[:, 0])
    return np.angle(np.exp(1j * teeth * angle).mean()) / teeth % (2.0 * pi / teeth)
