"""The driver: keeps speed and path by torque on the sprockets, whose reaction acts on the hull."""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...numerics.spatial import scale
from ...rui.sweeps.articulated import apply_wrench
from ...rui.sweeps.kinematics import MotionOffset, body_axes, motion_vector, rotation
from ..body_tree import SIDES, sprocket_name, whole_mass
from ..tracks.sprockets import pitch_radius
from .driveline import full_load, turn_shaft
from .engine import order_wave
from .path import path_heading

ACCELERATION_LIMIT = 2.0  # m/s^2, where the file gives none
TURN_RESET = 0.5  # s in which a lasting error of turning doubles the steering moment
SLOWEST_COURSE = 1.0  # m/s, below which drift tells nothing of the course, and steering leads less and less aside


class Driver(NamedTuple):
    """Gains and what they act on."""

    hull: int  # row in the tree
    sprocket: np.ndarray  # (2,) rows, left first
    radius: float  # m, turns force into torque
    half_tread: float  # m
    speed_gain: float  # N s/m
    integral_gain: float  # N/m
    force_limit: float  # N
    heading_gain: float  # N m/rad
    heading_damping: float  # N m s/rad
    lane_gain: float  # rad/m
    mass: float  # kg of the whole vehicle
    acceleration_limit: float  # m/s^2, of what the driver asks for


class Driving(NamedTuple):
    """State of the driver, and what his drive has done; changed in place."""

    speed_integral: np.ndarray  # (1,) of the speed's error, N
    turn_integral: np.ndarray  # (1,) of the steering moment, N m
    torque: np.ndarray  # (2,) on the sprockets, N m
    done: np.ndarray  # (2,) work of the torques, J, and the way along the hull's x axis that it went for, m


def build_driver(vehicle, rows):
    """Return the record for a vehicle."""
    d = vehicle.driver
    return Driver(
        hull=rows["hull"],
        sprocket=np.array([rows[sprocket_name(side)] for side in SIDES]),
        radius=pitch_radius(vehicle),
        half_tread=vehicle.sprockets.y,
        speed_gain=d.speed_gain,
        integral_gain=d.speed_integral_gain,
        force_limit=d.force_limit,
        heading_gain=d.heading_gain,
        heading_damping=d.heading_damping,
        lane_gain=d.lane_gain,
        mass=whole_mass(vehicle),
        acceleration_limit=d.acceleration_limit or ACCELERATION_LIMIT,
    )


def new_driving():
    """Return the state of a driver who has done nothing yet."""
    return Driving(np.zeros(1), np.zeros(1), np.zeros(2), np.zeros(2))


@inlined
def add_driver(drive, state, hinge_rate, motion, cuts, dt):
    """Add the torques on the sprockets of a `Drive`, and advance driver and shafts in its `DriveState` by dt."""
    driver, driving = drive.driver, state.driving
    velocity = body_axes(motion, driver.hull, motion_vector(motion, MotionOffset.VELOCITY, driver.hull))
    turn = _sprockets(drive, state, hinge_rate, _force(drive, state, velocity[0], dt), dt)
    steering = driver.radius * 0.5 * _steering_moment(drive, state, motion, velocity, dt) / driver.half_tread
    # a moment to the left pulls on the right side
    driving.torque[0], driving.torque[1] = 0.5 * turn - steering, 0.5 * turn + steering
    driving.done[1] += dt * velocity[0]
    for side in range(2):
        row = driver.sprocket[side]
        turn_sprocket(driver, motion, cuts, row, driving.torque[side])
        driving.done[0] += dt * driving.torque[side] * hinge_rate[row]


@inlined
def _force(drive, state, forward, dt):
    """Return the force [N] that the driver asks for; the integral rests while it is cut."""
    driver, driving = drive.driver, state.driving
    error = state.wanted.speed[0] - forward
    asked = driver.mass * state.wanted.acceleration[0] + driver.speed_gain * error + driving.speed_integral[0]
    low, high = -driver.force_limit, driver.force_limit
    if drive.driveline.ratio.size > 0:
        # brakes hold on both ways, the engine only drives on
        engine = full_load(drive.driveline, state.shaft) / driver.radius
        if state.shaft.rate[0] >= 0.0:
            high = min(high, engine)
        else:
            low = max(low, -engine)
    force = min(max(asked, low), high)
    if force == asked:
        driving.speed_integral[0] += driver.integral_gain * error * dt
    return force


@inlined
def _sprockets(drive, state, hinge_rate, force, dt):
    """Return the torque [N m] on both sprockets: of the engine through the shafts, of the brakes directly."""
    torque = drive.driver.radius * force
    if drive.driveline.ratio.size == 0:
        return torque
    mean = 0.5 * (hinge_rate[drive.driver.sprocket[0]] + hinge_rate[drive.driver.sprocket[1]])
    drives = torque * state.shaft.rate[0] >= 0.0
    ripple = 0.0
    for i in range(drive.engine.orders.size):
        ripple += drive.driveline.ripple[i] * order_wave(drive.engine, state.crank, i)
    ripple *= drive.driveline.ratio[state.shaft.gear[0] - 1]
    passed = turn_shaft(drive.driveline, state.shaft, torque if drives else 0.0, ripple, mean, dt)
    return passed if drives else passed + torque


@inlined
def _steering_moment(drive, state, motion, velocity, dt):
    """Return the moment [N m] to the left that brings the hull back to its path, given its velocity in its own axes.

    Straight on nothing resists turning for long, and a push of the road passes by; so only a path with curves has an
    integral, which carries the moment of the shoes that slide sideways, and minds the drift that goes with it.
    """
    driver, path = drive.driver, state.path
    turn = rotation(motion, driver.hull)
    direction, curvature = path_heading(path)
    course = np.arctan2(turn[3], turn[0])
    way = min(max(velocity[0] / SLOWEST_COURSE, -1.0), 1.0)  # backwards the same heading leads to the other side
    if path.curved[0]:
        course += way * velocity[1] / max(abs(velocity[0]), SLOWEST_COURSE)
    error = direction - way * driver.lane_gain * path.offset[0] - course
    error -= 2.0 * np.pi * np.floor((error + np.pi) / (2.0 * np.pi))
    turning = motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, driver.hull)[2] - curvature * velocity[0]
    moment = driver.heading_gain * error - driver.heading_damping * turning
    if path.curved[0]:
        most = driver.force_limit * driver.half_tread
        integral = state.driving.turn_integral[0] + dt * moment / TURN_RESET
        state.driving.turn_integral[0] = min(max(integral, -most), most)
    return moment + state.driving.turn_integral[0]


@inlined
def turn_sprocket(driver, motion, cuts, sprocket, torque):
    """Turn a sprocket about its axle by a torque [N m] that stands on the hull."""
    moment = scale(torque, motion_vector(motion, MotionOffset.HINGE_AXIS, sprocket))
    apply_wrench(cuts, sprocket, (0.0, 0.0, 0.0), moment)
    apply_wrench(cuts, driver.hull, (0.0, 0.0, 0.0), scale(-1.0, moment))
