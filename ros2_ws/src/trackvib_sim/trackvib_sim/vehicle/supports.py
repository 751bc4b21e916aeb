"""The standing vehicle's tracks as springs between road wheels, hull and ground, for its equilibrium and its modes.

Under a wheel two shoes share the load, so rubber and ground act in series. Sideways the guide horns hold the wheel in
the band of shoes, which lies fast. The sprockets are braked: they hold the hull by the run of links down to the
nearest wheel. The runs at both ends pull sprocket and idler down and the end wheels up, and the upper run hangs on
the hull.
"""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import load3
from ..rui.sweeps.articulated import apply_force
from ..rui.sweeps.kinematics import MotionOffset, motion_vector, point_place, point_velocity
from .body_tree import FRONT, REAR, SIDES, drive_end, end_wheels, wheel_name
from .tracks.layout import end_runs, upper_weight

SHOES_UNDER_WHEEL = 2.0


class Supports(NamedTuple):
    """Springs and dampers against the ground, global axes; ends are the rear and the front one."""

    wheel: np.ndarray  # (w,) rows in the tree, left side first, front to rear
    hull: int  # row
    brake: np.ndarray  # (2, 3) where the braked sprockets hold the hull, m
    end: np.ndarray  # (2, 2, 3) hubs of sprockets and idlers in the hull, by side and end, m
    end_wheel: np.ndarray  # (2, 2) the road wheel next to each, its number in `wheel`
    pull: np.ndarray  # (2, 2, 2) of a track on the hull by side and end, x and z, N
    upper_weight: np.ndarray  # (2,) N of each track's links that hang on the hull
    radius: float  # height of a hub over unloaded springs, m
    vertical: tuple  # of each wheel: stiffness N/m, damping N s/m
    lateral: tuple  # likewise
    longitudinal: tuple  # of each sprocket


def build_supports(vehicle, rows, travel):
    """Return the record for the vehicle with a `travel` (2,) [m] of its tensioners."""
    v, stations = vehicle, vehicle.swing_arms.stations
    shoes = (SHOES_UNDER_WHEEL * v.ground.stiffness, SHOES_UNDER_WHEEL * v.ground.damping)
    last = v.swing_arms.places[0, 0 if drive_end(v) == FRONT else -1]
    run = max(1, int(np.hypot(last - v.sprockets.x, v.sprockets.z) / v.tracks.pitch))
    return Supports(
        wheel=np.array([rows[wheel_name(side, station)] for side in SIDES for station in range(stations)]),
        hull=rows["hull"],
        brake=np.array([(v.sprockets.x, sign * v.sprockets.y, v.sprockets.z) for sign in SIDES.values()]),
        end=np.array(
            [
                [(w.x, sign * w.y, w.z) for _, w in (end_wheels(v)[end] for end in (REAR, FRONT))]
                for sign in SIDES.values()
            ]
        ),
        end_wheel=np.array([(side * stations + stations - 1, side * stations) for side in SIDES]),
        pull=np.stack([end_runs(v, side, travel[side]) for side in SIDES]),
        upper_weight=np.array([upper_weight(v, side, travel[side]) for side in SIDES]),
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
        for end in range(2):
            place = point_place(motion, supports.hull, load3(supports.end[side], end))
            wheel = supports.wheel[supports.end_wheel[side, end]]
            x, z = supports.pull[side, end, 0], supports.pull[side, end, 1]
            apply_force(cuts, motion, supports.hull, place, (x, 0.0, z - 0.5 * supports.upper_weight[side]))
            apply_force(cuts, motion, wheel, motion_vector(motion, MotionOffset.ORIGIN, wheel), (-x, 0.0, -z))


def pulls(supports):
    """Yield row in the tree, point in body axes (3,) [m] and force (3,) [N] of all that does not change with place."""
    for side in SIDES:
        for end in range(2):
            x, z = supports.pull[side, end]
            wheel = supports.wheel[supports.end_wheel[side, end]]
            yield supports.hull, supports.end[side, end], np.array([x, 0.0, z - 0.5 * supports.upper_weight[side]])
            yield wheel, np.zeros(3), np.array([-x, 0.0, -z])
