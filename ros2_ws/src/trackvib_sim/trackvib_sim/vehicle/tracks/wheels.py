"""Road wheels, carrier rollers and idlers: circles that roll on the polygon of the links.

A wheel touches a link where the foot of the perpendicular from its centre falls on it, or a node where the foot falls
beyond the end of one link and before the beginning of the next. As the wheel rolls that passes on from link to link
without a step, and with it comes the polygon effect. What a contact does is in `rims`.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ...numerics.spatial import dot, rotate, rotate_back, subtract, vector
from ...rui.sweeps.articulated import apply_wrench
from ...rui.sweeps.kinematics import MotionOffset, motion_vector, rotation
from ..body_tree import SIDES, drive_end, idler_name, roller_name, wheel_name
from .guides import REACH
from .nodes import STRIDE
from .rims import WheelLoadOffset, close_list, list_contact

LOWER_RUN, UPPER_RUN, END = 1.0, -1.0, 0.0  # sign of x along the chain where the wheel touches it; 0: an idler's end
HALF_LINK = 0.6  # of the pitch: half the longest link that a run may have
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
    reach: np.ndarray  # square of the distance from the hub within which a held link has one of its nodes, m^2
    stiffness: np.ndarray  # N/m
    damping: np.ndarray  # N s/m
    friction: np.ndarray
    guide_stiffness: np.ndarray  # N/m
    guide_damping: np.ndarray  # N s/m


class HullFrame(NamedTuple):
    """The hull as wheels are seen from it."""

    axes: tuple  # (9,) hull axes -> global axes
    origin: tuple  # (3,) m
    turn: tuple  # (3,) angular velocity, hull axes, rad/s


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
        reach=column(lambda run, radius, rim: (radius + REACH) ** 2 + (HALF_LINK * pitch) ** 2),
        stiffness=column(lambda run, radius, rim: rim.radial_stiffness),
        damping=column(lambda run, radius, rim: rim.radial_damping),
        friction=column(lambda run, radius, rim: rim.friction),
        guide_stiffness=column(lambda run, radius, rim: rim.guide_stiffness),
        guide_damping=column(lambda run, radius, rim: rim.guide_damping),
    )


@inlined
def hull_frame(motion, hull):
    """Return the `HullFrame`."""
    axes = rotation(motion, hull)
    turn = rotate_back(axes, motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, hull))
    return HullFrame(axes, motion_vector(motion, MotionOffset.ORIGIN, hull), turn)


@inlined
def hub_of(motion, frame, row, travel, rate):
    """Return the `Hub` of a wheel that is shifted along the hull's x axis by `travel` [m], at a `rate` [m/s]."""
    place = rotate_back(frame.axes, subtract(motion_vector(motion, MotionOffset.ORIGIN, row), frame.origin))
    velocity, turn = rotate_back(frame.axes, motion_vector(motion, MotionOffset.VELOCITY, row)), frame.turn
    spin = dot(
        motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, row), motion_vector(motion, MotionOffset.HINGE_AXIS, row)
    )
    shifted = (velocity[0] + rate, velocity[1] + turn[2] * travel, velocity[2] - turn[1] * travel)
    return Hub(place[0] + travel, place[1], place[2], shifted[0], shifted[1], shifted[2], spin, turn[0], turn[2])


@inlined
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


@inlined
def list_contacts(wheels, side, k, hub, link, n, work, contacts, first):
    """List where one wheel touches or holds the links around its own, from number `first` on; returns the next one.

    Where the chain bends round the wheel, the feet on two links can lie inside both of them: their common pin then
    counts once less. Where it bends away, a foot can lie in neither: the pin counts by itself. So the force is that
    of one rim, and steady.
    """
    window, reach = wheels.window[side, k], wheels.reach[side, k]
    held = (wheels.radius[side, k] + REACH) ** 2
    i, end = link - window, first
    i = i + n if i < 1 else i
    inside, beyond = False, False  # whether the foot lay inside the link before, or beyond its end
    ax, az = work[i] - hub.x, work[2 * STRIDE + i] - hub.z
    behind = ax * ax + az * az
    for _ in range(2 * window + 1):
        j = i + 1 if i < n else 1
        bx, bz = work[i + 1] - hub.x, work[2 * STRIDE + i + 1] - hub.z
        ahead = bx * bx + bz * bz
        if behind < reach or ahead < reach:
            ux, uz = work[i + 1] - work[i], work[2 * STRIDE + i + 1] - work[2 * STRIDE + i]
            along, square = -(ax * ux + az * uz), ux * ux + uz * uz
            across = ax * uz - az * ux
            within = 0.0 <= along < square
            if behind < held and ((beyond and along < 0.0) or (inside and within)):
                list_contact(contacts, end, hub, 0.0, -1.0 if inside else 1.0, i, j, work)
                end += 1
            if within and across * across < held * square:
                list_contact(contacts, end, hub, along / square, 1.0, i, j, work)
                end += 1
            inside, beyond = within, along >= square
        i, ax, az, behind = j, bx, bz, ahead
    close_list(contacts, k, first, end, wheels, side)
    return end


@inlined
def push_body(cuts, frame, row, load):
    """Apply `load` to a body, about its own origin."""
    apply_wrench(
        cuts,
        row,
        rotate(frame.axes, vector(load[WheelLoadOffset.FORCE :])),
        rotate(frame.axes, vector(load[WheelLoadOffset.MOMENT :])),
    )
