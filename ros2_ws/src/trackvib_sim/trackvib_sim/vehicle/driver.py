"""The driver: keeps speed and lane by torque on the sprockets, whose reaction acts on the hull."""

from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import scale
from ..rui.sweeps.articulated import apply_wrench
from ..rui.sweeps.kinematics import MotionOffset, body_axes, motion_vector, rotation
from .body_tree import SIDES, sprocket_name
from .tracks.sprockets import pitch_radius


class Driver(NamedTuple):
    """Gains and what they act on."""

    hull: int  # row in the tree
    sprocket: np.ndarray  # (2,) rows, left first
    radius: float  # m, turns force into torque
    half_tread: float  # m
    speed: float  # wanted, m/s
    speed_gain: float  # N s/m
    integral_gain: float  # N/m
    force_limit: float  # N
    heading_gain: float  # N m/rad
    heading_damping: float  # N m s/rad
    lane_gain: float  # rad/m


def build_driver(vehicle, rows, speed):
    """Return the record for a wanted speed [m/s]."""
    d = vehicle.driver
    return Driver(
        hull=rows["hull"],
        sprocket=np.array([rows[sprocket_name(side)] for side in SIDES]),
        radius=pitch_radius(vehicle),
        half_tread=vehicle.sprockets.y,
        speed=speed,
        speed_gain=d.speed_gain,
        integral_gain=d.speed_integral_gain,
        force_limit=d.force_limit,
        heading_gain=d.heading_gain,
        heading_damping=d.heading_damping,
        lane_gain=d.lane_gain,
    )


@kernel
def add_driver(driver, motion, cuts, hinge_rate, integral, driven, dt):
    """Add the torques and advance the integral (1,) [N] of the speed error; it rests while the force is cut.

    To `driven` (2,) are added the work of the torques on the sprockets [J] and the hull's way along its x axis [m].
    """
    forward = body_axes(motion, driver.hull, motion_vector(motion, MotionOffset.VELOCITY, driver.hull))[0]
    error = driver.speed - forward
    wanted = driver.speed_gain * error + integral[0]
    force = min(max(wanted, -driver.force_limit), driver.force_limit)
    if force == wanted:
        integral[0] += driver.integral_gain * error * dt
    turn = rotation(motion, driver.hull)
    heading = np.arctan2(turn[3], turn[0])
    wanted_heading = -driver.lane_gain * motion_vector(motion, MotionOffset.ORIGIN, driver.hull)[1]
    turning = motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, driver.hull)[2]
    moment = driver.heading_gain * (wanted_heading - heading) - driver.heading_damping * turning
    steering = 0.5 * moment / driver.half_tread
    # a moment to the left pulls on the right side
    left, right = driver.radius * (0.5 * force - steering), driver.radius * (0.5 * force + steering)
    turn_sprocket(driver, motion, cuts, driver.sprocket[0], left)
    turn_sprocket(driver, motion, cuts, driver.sprocket[1], right)
    driven[0] += dt * (left * hinge_rate[driver.sprocket[0]] + right * hinge_rate[driver.sprocket[1]])
    driven[1] += dt * forward


@kernel
def turn_sprocket(driver, motion, cuts, sprocket, torque):
    """Turn a sprocket about its axle by a torque [N m] that stands on the hull."""
    moment = scale(torque, motion_vector(motion, MotionOffset.HINGE_AXIS, sprocket))
    apply_wrench(cuts, sprocket, (0.0, 0.0, 0.0), moment)
    apply_wrench(cuts, driver.hull, (0.0, 0.0, 0.0), scale(-1.0, moment))
