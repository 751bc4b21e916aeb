"""Road wheels, carrier rollers and idlers: circles that roll on the polygon of the links.

A wheel touches a link where the foot of the perpendicular from its centre falls on it, or a node where the foot falls
beyond the end of one link and before the beginning of the next. As the wheel rolls that passes on from link to link
without a step, and with it comes the polygon effect. The rim's rubber is a radial spring and damper; friction,
regularised by a small creep speed, turns the wheel with the track; guide horns hold the shoes sideways, those that do
not yet touch the rim as well.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ...numerics.spatial import cross, dot, rotate, subtract, vector
from ...rui.sweeps.articulated import apply_wrench
from ...rui.sweeps.kinematics import MotionOffset, body_axes, motion_vector, rotation
from ..body_tree import SIDES, drive_end, idler_name, roller_name, wheel_name
from .guides import REACH, hold
from .nodes import STRIDE, NodeWorkOffset

LOWER_RUN, UPPER_RUN, END = 1.0, -1.0, 0.0  # sign of x along the chain where the wheel touches it; 0: an idler's end
CREEP = 0.25  # m/s, slip at which friction has 71 % of its limit; less is stiff against a shoe in steps of 1e-4 s
MOST_MOVES = (
    4  # links by which a wheel's link may change in one step; wheels that lost the track must not search for ever
)


class Wheels(NamedTuple):
    """Where wheels touch the chain, (2, c) places a side: road wheels, rollers, each from front to rear, and the idler.

    Where there are no rollers the upper run may lie on the road wheels, so that these stand there once more.
    """

    end: float  # of the vehicle where the idlers are, sign of x
    row: np.ndarray  # in the tree
    run: np.ndarray  # one of `LOWER_RUN`, `UPPER_RUN`, `END`
    window: np.ndarray  # links on either side of the wheel's own that it may touch
    radius: np.ndarray  # of the pin line, m
    stiffness: np.ndarray  # N/m
    damping: np.ndarray  # N s/m
    friction: np.ndarray
    guide_stiffness: np.ndarray  # N/m
    guide_damping: np.ndarray  # N s/m


class Rim(NamedTuple):
    """One wheel's part of `Wheels`."""

    radius: float
    stiffness: float
    damping: float
    friction: float
    guide_stiffness: float
    guide_damping: float


class Hub(NamedTuple):
    """A wheel as its track sees it, hull axes."""

    x: float  # m
    y: float
    z: float
    vx: float  # m/s
    vy: float
    vz: float
    spin: float  # rad/s about the axle, positive forward
    roll: float  # rad/s of the hull
    yaw: float


class WheelLoadOffset(IntEnum):
    """What a track does to a wheel, hull axes."""

    FORCE = 0  # N
    MOMENT = 3  # about the hub, N m
    DISSIPATION = 6  # W
    STORED = 7  # energy in the contact, J
    SIZE = 8


def build_wheels(vehicle, rows):
    """Return the record for the vehicle."""
    v, pitch = vehicle, vehicle.tracks.pitch
    wheel = [[rows[wheel_name(side, station)] for station in range(v.swing_arms.stations)] for side in SIDES]
    idler = [[rows[idler_name(side)]] for side in SIDES]
    if v.carrier_rollers:
        roller = [[rows[roller_name(side, k)] for k in range(len(v.carrier_rollers.x))] for side in SIDES]
        above = (roller, UPPER_RUN, v.carrier_rollers.radius, v.roller_rims)
    else:
        above = (wheel, UPPER_RUN, v.road_wheels.radius, v.tyres)
    kinds = (
        (wheel, LOWER_RUN, v.road_wheels.radius, v.tyres),
        above,
        (idler, END, v.idlers.radius, v.idler_rims),
    )

    def column(value):
        return np.concatenate([np.full(np.shape(kind[0]), value(*kind[1:])) for kind in kinds], axis=1)

    return Wheels(
        end=-drive_end(v),
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
def hub_of(motion, hull, row, travel, rate):
    """Return the `Hub` of a wheel that is shifted along the hull's x axis by `travel` [m], at a `rate` [m/s]."""
    place = body_axes(
        motion,
        hull,
        subtract(motion_vector(motion, MotionOffset.ORIGIN, row), motion_vector(motion, MotionOffset.ORIGIN, hull)),
    )
    velocity = body_axes(motion, hull, motion_vector(motion, MotionOffset.VELOCITY, row))
    turn = body_axes(motion, hull, motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, hull))
    spin = dot(
        motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, row), motion_vector(motion, MotionOffset.HINGE_AXIS, row)
    )
    shifted = (velocity[0] + rate, velocity[1] + turn[2] * travel, velocity[2] - turn[1] * travel)
    return Hub(place[0] + travel, place[1], place[2], shifted[0], shifted[1], shifted[2], spin, turn[0], turn[2])


@kernel
def find_link(run, x, work, i, n):
    """Return the link of a run that a wheel at x touches, beginning from the one it touched last."""
    for _ in range(MOST_MOVES):
        if run * x >= run * work[i + 1]:
            i = i + 1 if i < n else 1
        elif run * x < run * work[i]:
            i = i - 1 if i > 1 else n
        else:
            break
    return i


@kernel
def find_outermost(end, work, i, n):
    """Return the outermost node at an end of the vehicle (sign of x), beginning from the one that was it last."""
    for _ in range(MOST_MOVES):
        if end * work[i + 1] > end * work[i]:
            i = i + 1 if i < n else 1
        elif end * work[i - 1] > end * work[i]:
            i = i - 1 if i > 1 else n
        else:
            break
    return i


@kernel
def add_wheel(wheels, side, k, hub, link, n, work, load):
    """Add one wheel's contact forces to the nodes around its link, and their reactions to `load` (LOAD,).

    Where the chain bends round the wheel, the feet on two links can lie inside both of them: their common pin then
    counts once less. Where it bends away, a foot can lie in neither: the pin counts by itself. So the force is that
    of one rim, and steady.
    """
    rim = Rim(
        wheels.radius[side, k],
        wheels.stiffness[side, k],
        wheels.damping[side, k],
        wheels.friction[side, k],
        wheels.guide_stiffness[side, k],
        wheels.guide_damping[side, k],
    )
    window, reached = wheels.window[side, k], (rim.radius + REACH) ** 2
    i = link - window
    i = i + n if i < 1 else i
    inside, beyond = False, False  # whether the foot lay inside the link before, or beyond its end
    for _ in range(2 * window + 1):
        j = i + 1 if i < n else 1
        ax, az = work[i] - hub.x, work[2 * STRIDE + i] - hub.z
        ux, uz = work[i + 1] - work[i], work[2 * STRIDE + i + 1] - work[2 * STRIDE + i]
        along, square = -(ax * ux + az * uz), ux * ux + uz * uz
        across = ax * uz - az * ux
        within = 0.0 <= along < square
        if ax * ax + az * az < reached and ((beyond and along < 0.0) or (inside and within)):
            _press(rim, hub, 0.0, -1.0 if inside else 1.0, i, j, work, load)
        if within and across * across < reached * square:
            _press(rim, hub, along / square, 1.0, i, j, work, load)
        inside, beyond = within, along >= square
        i = j


@kernel
def _press(rim, hub, share, weight, i, j, work, load):
    """Add `weight` times the contact of a rim with the link from node i to node j, at a part `share` of its length."""
    rest = 1.0 - share
    dx = rest * work[i] + share * work[j] - hub.x
    sideways = rest * work[STRIDE + i] + share * work[STRIDE + j] - hub.y
    dz = rest * work[2 * STRIDE + i] + share * work[2 * STRIDE + j] - hub.z
    vx = rest * work[3 * STRIDE + i] + share * work[3 * STRIDE + j] - hub.vx
    vy = rest * work[4 * STRIDE + i] + share * work[4 * STRIDE + j] - hub.vy - hub.yaw * dx + hub.roll * dz
    vz = rest * work[5 * STRIDE + i] + share * work[5 * STRIDE + j] - hub.vz
    distance = np.sqrt(dx * dx + dz * dz)
    nx, nz = dx / distance, dz / distance
    depth, leaving = rim.radius - distance, vx * nx + vz * nz
    on = max(weight, 0.0)  # the pin that counts less takes no damping off
    spring = rim.stiffness * max(depth, 0.0)
    normal = max(0.0, spring - on * rim.damping * leaving) if depth > 0.0 else 0.0
    # the rim moves along (nz, -nx) when the wheel rolls forward
    slip = vx * nz - vz * nx - hub.spin * distance
    drag = on * rim.friction * normal * slip / np.sqrt(slip * slip + CREEP * CREEP)
    outwards, guide, heat, stored = hold(rim.guide_stiffness, on * rim.guide_damping, REACH, depth, sideways, vy)
    push = normal + outwards
    force = (weight * (push * nx - drag * nz), weight * guide, weight * (push * nz + drag * nx))
    for axis in range(3):
        work[(NodeWorkOffset.CONTACT + axis) * STRIDE + i] += rest * force[axis]
        work[(NodeWorkOffset.CONTACT + axis) * STRIDE + j] += share * force[axis]
    add_reaction(load, (dx, sideways, dz), force)
    load[WheelLoadOffset.DISSIPATION] += weight * (leaving * (spring - normal) + drag * slip + heat)
    load[WheelLoadOffset.STORED] += weight * (0.5 * spring * depth + stored)


@inlined
def add_reaction(load, lever, force):
    """Add to `load` what a force [N] on a node does to the wheel, `lever` [m] being the node's place from the hub."""
    moment = cross(lever, force)
    for axis in range(3):
        load[WheelLoadOffset.FORCE + axis] -= force[axis]
        load[WheelLoadOffset.MOMENT + axis] -= moment[axis]


@kernel
def push_body(cuts, motion, hull, row, load):
    """Apply `load` to a body, about its own origin."""
    turn = rotation(motion, hull)
    apply_wrench(
        cuts,
        row,
        rotate(turn, vector(load[WheelLoadOffset.FORCE :])),
        rotate(turn, vector(load[WheelLoadOffset.MOMENT :])),
    )
