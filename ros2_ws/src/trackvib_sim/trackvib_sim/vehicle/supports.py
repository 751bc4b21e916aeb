"""The standing vehicle's tracks as springs between road wheels, hull and ground, for its equilibrium and its modes.

Under a wheel two shoes share the load, so rubber and ground act in series. Sideways the guide horns hold the wheel in
the band of shoes, which lies fast. The sprockets are braked: they hold the hull by the run of links down to the
rearmost wheel. The runs at both ends pull sprocket and idler down and the end wheels up, and the upper run hangs on
the hull.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import load3
from ..rui.sweeps.articulated import apply_force
from ..rui.sweeps.kinematics import MotionOffset, motion_vector, point_place, point_velocity
from .body_tree import SIDES, STATIONS, wheel_name
from .tracks.layout import end_runs, upper_weight

SHOES_UNDER_WHEEL = 2.0


class Supports(NamedTuple):
    """Springs and dampers against the ground, global axes."""

    wheel: np.ndarray  # (12,) rows in the tree
    hull: int  # row
    brake: np.ndarray  # (2, 3) where the braked sprockets hold the hull, m
    idler: np.ndarray  # (2, 3) m
    pull: np.ndarray  # (2, 2) of a track on the hull at sprocket and idler, x and z, N
    upper_weight: float  # N of a track's links that hang on the hull
    radius: float  # height of a hub over unloaded springs, m
    vertical: tuple  # of each wheel: stiffness N/m, damping N s/m
    lateral: tuple  # likewise
    longitudinal: tuple  # of each sprocket


def build_supports(vehicle, rows, travel):
    """Return the record for the vehicle with a `travel` [m] of its tensioners."""
    v = vehicle
    shoes = (SHOES_UNDER_WHEEL * v.ground.stiffness, SHOES_UNDER_WHEEL * v.ground.damping)
    run = int(np.hypot(min(v.swing_arms.wheel_x) - v.sprockets.x[0], v.sprockets.z[0]) / v.tracks.pitch)
    return Supports(
        wheel=np.array([rows[wheel_name(side, station)] for side in SIDES for station in range(STATIONS)]),
        hull=rows["hull"],
        brake=np.array([(v.sprockets.x[0], sign * v.sprockets.y, v.sprockets.z[0]) for sign in SIDES.values()]),
        idler=np.array([(v.idlers.x[0], sign * v.idlers.y, v.idlers.z[0]) for sign in SIDES.values()]),
        pull=end_runs(v, travel),
        upper_weight=upper_weight(v, travel),
        radius=v.road_wheels.radius,
        vertical=_in_series((v.tyres.radial_stiffness, v.tyres.radial_damping), shoes),
        lateral=(v.tyres.guide_stiffness, v.tyres.guide_damping),
        longitudinal=(v.tracks.link_stiffness / run, v.tracks.link_damping / run),
    )


def _in_series(one, other):
    """Stiffness and damping of two light dampers with their springs in series, below their own resonance."""
    stiffness = one[0] * other[0] / (one[0] + other[0])
    return stiffness, one[1] * (stiffness / one[0]) ** 2 + other[1] * (stiffness / other[0]) ** 2


@kernel
def add_supports(supports, motion, cuts):
    """Add the springs' forces to wheels and hull of a vehicle that stands with its origin near x = y = 0."""
    for i in range(supports.wheel.size):
        wheel = supports.wheel[i]
        hub, velocity = (
            motion_vector(motion, MotionOffset.ORIGIN, wheel),
            motion_vector(motion, MotionOffset.VELOCITY, wheel),
        )
        side = 1.0 if 2 * i < supports.wheel.size else -1.0
        lateral = -supports.lateral[0] * (hub[1] - side * supports.brake[0, 1]) - supports.lateral[1] * velocity[1]
        vertical = supports.vertical[0] * (supports.radius - hub[2]) - supports.vertical[1] * velocity[2]
        apply_force(cuts, motion, wheel, hub, (0.0, lateral, vertical))
    for side in range(2):
        place = point_place(motion, supports.hull, load3(supports.brake, side))
        velocity = point_velocity(motion, supports.hull, place)
        forward = supports.longitudinal[0] * (supports.brake[side, 0] - place[0])
        apply_force(cuts, motion, supports.hull, place, (forward - supports.longitudinal[1] * velocity[0], 0.0, 0.0))
        _pull(supports, motion, cuts, 0, place, supports.wheel[side * STATIONS + STATIONS - 1])
        _pull(
            supports,
            motion,
            cuts,
            1,
            point_place(motion, supports.hull, load3(supports.idler, side)),
            supports.wheel[side * STATIONS],
        )


@kernel
def _pull(supports, motion, cuts, end, place, wheel):
    x, z = supports.pull[end, 0], supports.pull[end, 1]
    apply_force(cuts, motion, supports.hull, place, (x, 0.0, z - 0.5 * supports.upper_weight))
    apply_force(cuts, motion, wheel, motion_vector(motion, MotionOffset.ORIGIN, wheel), (-x, 0.0, -z))


def pulls(supports):
    """Yield row in the tree, point in body axes (3,) [m] and force (3,) [N] of all that does not change with place."""
    for side in range(len(SIDES)):
        ends = (supports.brake[side], STATIONS - 1), (supports.idler[side], 0)
        for (place, station), (x, z) in zip(ends, supports.pull, strict=True):
            yield supports.hull, place, np.array([x, 0.0, z - 0.5 * supports.upper_weight])
            yield supports.wheel[side * STATIONS + station], np.zeros(3), np.array([-x, 0.0, -z])
