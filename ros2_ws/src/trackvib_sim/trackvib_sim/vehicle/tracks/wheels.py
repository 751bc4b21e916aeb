"""Road wheels, carrier rollers and idlers: circles that roll on the polygon of the links.

A wheel touches a link where the foot of the perpendicular from its centre falls on it, or a node where the foot falls
beyond the end of one link and before the beginning of the next. As the wheel rolls that passes on from link to link without a
step, and with it comes the polygon effect. The rim's rubber is a radial spring and damper; friction, regularised by a
small creep speed, turns the wheel with the track; guide horns hold the shoes sideways.
"""

from typing import NamedTuple

import numpy as np

from ...rui.compiled import inlined, kernel
from ...rui.cuts import apply_wrench
from ...rui.kinematics import HINGE_AXIS, ORIGIN, RATE, VELOCITY, body_axes, motion_vector, rotation
from ...rui.spatial import dot, rotate, subtract
from ..body_tree import IDLER, ROLLER, SIDES, STATIONS, wheel_name
from .nodes import STRIDE

ROAD_WHEELS, ROLLERS, IDLERS = 1.0, -1.0, 0.0  # sign of x along the chain where the wheel touches it; 0: its front end
CREEP = 0.1  # m/s, slip at which friction has 71 % of its limit
MOST_MOVES = 4  # links by which a wheel's link may change in one step; wheels that lost the track must not search for ever


class Wheels(NamedTuple):
    """The eleven wheels of each side, (2, 11): road wheels from front to rear, rollers from front to rear, idler."""

    row: np.ndarray  # in the tree
    run: np.ndarray  # one of `ROAD_WHEELS`, `ROLLERS`, `IDLERS`
    window: np.ndarray  # links on either side of the wheel's own that it may touch
    radius: np.ndarray  # of the pin line, m
    stiffness: np.ndarray  # N/m
    damping: np.ndarray  # N s/m
    friction: np.ndarray
    guide_stiffness: np.ndarray  # N/m
    guide_damping: np.ndarray  # N s/m


class Hub(NamedTuple):
    """A wheel as its track sees it, hull axes."""

    x: float  # m
    y: float
    z: float
    vx: float  # m/s
    vy: float
    vz: float
    spin: float  # rad/s about the axle, positive forward


def wheels(vehicle, rows):
    """Return the record for the vehicle."""
    v, pitch = vehicle, vehicle.tracks.pitch
    wheel = [[rows[wheel_name(side, station)] for station in range(STATIONS)] for side in SIDES]
    roller = [[rows[f"roller_{ROLLER[side] + k}"] for k in range(len(v.carrier_rollers.x))] for side in SIDES]
    idler = [[rows[f"idler_{IDLER[side]}"]] for side in SIDES]
    kinds = (
        (wheel, ROAD_WHEELS, v.road_wheels.radius, v.tyres),
        (roller, ROLLERS, v.carrier_rollers.radius, v.roller_rims),
        (idler, IDLERS, v.idlers.radius, v.idler_rims),
    )

    def column(value):
        return np.concatenate([np.full(np.shape(kind[0]), value(*kind[1:])) for kind in kinds], axis=1)

    return Wheels(
        row=np.concatenate([kind[0] for kind in kinds], axis=1),
        run=column(lambda run, radius, rim: run),
        # an idler is wrapped by up to half its circumference
        window=column(lambda run, radius, rim: 3 if run else int(np.ceil(0.5 * np.pi * radius / pitch)) + 2),
        radius=column(lambda run, radius, rim: radius),
        stiffness=column(lambda run, radius, rim: rim.radial_stiffness),
        damping=column(lambda run, radius, rim: rim.radial_damping),
        friction=column(lambda run, radius, rim: rim.friction),
        guide_stiffness=column(lambda run, radius, rim: rim.guide_stiffness),
        guide_damping=column(lambda run, radius, rim: rim.guide_damping),
    )


@inlined
def hub_of(motion, hull, row):
    """Return the `Hub` of a wheel."""
    place = body_axes(motion, hull, subtract(motion_vector(motion, ORIGIN, row), motion_vector(motion, ORIGIN, hull)))
    velocity = body_axes(motion, hull, motion_vector(motion, VELOCITY, row))
    spin = dot(motion_vector(motion, RATE, row), motion_vector(motion, HINGE_AXIS, row))
    return Hub(place[0], place[1], place[2], velocity[0], velocity[1], velocity[2], spin)


@kernel
def find_link(run, x, work, i, n):
    """Return the link that a wheel at x touches, beginning from the one it touched last."""
    for _ in range(MOST_MOVES):
        here, there = work[i], work[i + 1]
        if run == IDLERS:
            ahead, behind = there > here, work[i - 1] > here
        else:
            ahead, behind = run * x >= run * there, run * x < run * here
        if ahead:
            i = i + 1 if i < n else 1
        elif behind:
            i = i - 1 if i > 1 else n
        else:
            break
    return i


@kernel
def add_wheel(wheels, side, k, hub, link, n, work):
    """Add one wheel's contact forces to the nodes around its link.

    Returns the force on the wheel [N] and its moment about the hub [N m], hull axes, the power turned into heat [W] and
    the energy stored [J].
    """
    radius, stiffness, damping = wheels.radius[side, k], wheels.stiffness[side, k], wheels.damping[side, k]
    force_x, force_y, force_z = 0.0, 0.0, 0.0
    moment_x, moment_y, moment_z = 0.0, 0.0, 0.0
    heat, stored = 0.0, 0.0
    window = wheels.window[side, k]
    i = link - window
    i = i + n if i < 1 else i
    beyond = False  # whether the foot lies beyond the end of the link before
    for _ in range(2 * window + 1):
        ax, az = work[i] - hub.x, work[2 * STRIDE + i] - hub.z
        ux, uz = work[i + 1] - work[i], work[2 * STRIDE + i + 1] - work[2 * STRIDE + i]
        along, square = -(ax * ux + az * uz), ux * ux + uz * uz
        touches, share = False, 0.0
        if along < 0.0:
            touches = beyond and ax * ax + az * az < radius * radius
        elif along < square:
            across = ax * uz - az * ux
            touches = across * across < radius * radius * square
            share = along / square
        beyond = along >= square
        j = i + 1 if i < n else 1
        if touches:
            dx, dz = ax + share * ux, az + share * uz
            distance = np.sqrt(dx * dx + dz * dz)
            nx, nz = dx / distance, dz / distance
            depth = radius - distance
            rest = 1.0 - share
            vx = rest * work[3 * STRIDE + i] + share * work[3 * STRIDE + j] - hub.vx
            vy = rest * work[4 * STRIDE + i] + share * work[4 * STRIDE + j] - hub.vy
            vz = rest * work[5 * STRIDE + i] + share * work[5 * STRIDE + j] - hub.vz
            sideways = rest * work[STRIDE + i] + share * work[STRIDE + j] - hub.y
            leaving = vx * nx + vz * nz
            normal = max(0.0, stiffness * depth - damping * leaving)
            # the rim moves along (nz, -nx) when the wheel rolls forward
            slip = vx * nz - vz * nx - hub.spin * distance
            drag = wheels.friction[side, k] * normal * slip / np.sqrt(slip * slip + CREEP * CREEP)
            guide = wheels.guide_stiffness[side, k] * sideways + wheels.guide_damping[side, k] * vy
            fx, fy, fz = normal * nx - drag * nz, -guide, normal * nz + drag * nx
            work[6 * STRIDE + i] += rest * fx
            work[7 * STRIDE + i] += rest * fy
            work[8 * STRIDE + i] += rest * fz
            work[6 * STRIDE + j] += share * fx
            work[7 * STRIDE + j] += share * fy
            work[8 * STRIDE + j] += share * fz
            force_x -= fx
            force_y -= fy
            force_z -= fz
            # moment of -f at (dx, sideways, dz)
            moment_x -= sideways * fz - dz * fy
            moment_y -= dz * fx - dx * fz
            moment_z -= dx * fy - sideways * fx
            heat += leaving * (stiffness * depth - normal) + drag * slip + wheels.guide_damping[side, k] * vy * vy
            stored += 0.5 * (stiffness * depth * depth + wheels.guide_stiffness[side, k] * sideways * sideways)
        i = j
    return (force_x, force_y, force_z), (moment_x, moment_y, moment_z), heat, stored


@kernel
def push_wheel(cuts, motion, hull, row, force, moment):
    """Apply a force and a moment about the hub, hull axes, to a wheel."""
    turn = rotation(motion, hull)
    apply_wrench(cuts, row, rotate(turn, force), rotate(turn, moment))
