"""One physics step, and a control period of them in a single compiled call."""

from typing import NamedTuple

import numpy as np

from ..rui.compiled import kernel
from ..rui.kinematics import body_axes, integrate, point_place, update_motion
from ..rui.loads import clear_loads
from ..rui.riccati import point_acceleration, solve_accelerations
from ..rui.spatial import add3, load3, store3, subtract
from ..vehicle.coil import drive_coils
from ..vehicle.driver import add_driver
from ..vehicle.engine import add_engine, imposed_displacement
from ..vehicle.hinge_springs import add_hinge_springs
from ..vehicle.mr_mounts import MountSample, add_mounts, new_mount_sample, observe_mounts
from ..vehicle.running_gear.wheels_on_road import add_wheels_on_road, wheel_below_road
from ..vehicle.suspension import add_suspension

GOOD, NOT_FINITE, OVERTURNED, BELOW_ROAD = range(4)
LEAST_UPRIGHT = 0.36  # cosine of the hull's tilt; 1.2 rad is beyond what the suspension and the driver are made for


class Sensors(NamedTuple):
    """Points whose acceleration is measured, in the axes of their bodies."""

    body: np.ndarray  # (m,) row in the tree
    place: np.ndarray  # (m, 3) m


class Sample(NamedTuple):
    """What one control period leaves to look at.

    Sensors give means over the period, as integrating instruments do; the rest is the state at its end.
    """

    specific_force: np.ndarray  # (m, 3) acceleration less gravity, body axes, m/s^2
    rate: np.ndarray  # (m, 3) angular velocity, body axes, rad/s
    hull_velocity: np.ndarray  # (1, 3) of the hull's origin, hull axes, m/s
    hull_rate: np.ndarray  # (1, 3) hull axes, rad/s
    mounts: MountSample


def new_sample(sensors):
    """Return room for a sample."""
    m = len(sensors.body)
    return Sample(np.zeros((m, 3)), np.zeros((m, 3)), np.zeros((1, 3)), np.zeros((1, 3)), new_mount_sample())


@kernel
def accelerations(system, state, road, work):
    """From the state, all forces and from them, by the two sweeps, all accelerations."""
    tree, motion, loads = system.tree, work.motion, work.loads
    update_motion(tree, state.tree, motion)
    clear_loads(loads)
    add_hinge_springs(system.springs, state.tree, loads)
    add_suspension(system.suspension, state.tree, loads)
    add_wheels_on_road(system.wheels, state.brushes, road, motion, loads, system.dt)
    displacement, displacement_rate = imposed_displacement(system.engine, state.crank_angle[0])
    add_mounts(system.mounts, motion, loads, state.currents, displacement, displacement_rate)
    add_engine(system.engine, state.crank_angle[0], motion, loads)
    add_driver(system.driver, motion, loads, state.speed_integral, system.dt)
    solve_accelerations(tree, state.tree, motion, loads, work.sweep)


@kernel
def measure(system, work, sensors, sample, share):
    """Add one step's part (`share`) to the means of a sample."""
    gravity = (system.tree.gravity[0], system.tree.gravity[1], system.tree.gravity[2])
    for i in range(sensors.body.size):
        body = sensors.body[i]
        place = point_place(work.motion, body, load3(sensors.place, i))
        force = subtract(point_acceleration(work.motion, work.sweep, body, place), gravity)
        force = body_axes(work.motion, body, force)
        rate = body_axes(work.motion, body, load3(work.motion.rate, body))
        add3(sample.specific_force, i, (share * force[0], share * force[1], share * force[2]))
        add3(sample.rate, i, (share * rate[0], share * rate[1], share * rate[2]))


@kernel
def advance(system, state, road, demanded, steps, work, sensors, sample):
    """Advance the vehicle by one control period of `steps` physics steps with constant demanded currents (2,) [A].

    Fills `sample` with the period's means. Returns `GOOD`, or at once what made the state leave the valid range.
    """
    sample.specific_force[:] = 0.0
    sample.rate[:] = 0.0
    dt = system.dt
    for _ in range(steps):
        drive_coils(system.coil, demanded, state.currents)
        accelerations(system, state, road, work)
        measure(system, work, sensors, sample, 1.0 / steps)
        sweep = work.sweep
        integrate(state.tree, sweep.linear[0], sweep.angular[0], sweep.hinge_acceleration, dt)
        state.crank_angle[0] = (state.crank_angle[0] + dt * system.engine.speed) % (4.0 * np.pi)
        total = sweep.linear[0].sum() + sweep.angular[0].sum() + sweep.hinge_acceleration.sum()
        # not np.isfinite: it compiles to total - total == 0, which reassociation turns into "true"
        if not abs(total) < np.inf:
            return NOT_FINITE
        if work.motion.rotation[0, 8] < LEAST_UPRIGHT:
            return OVERTURNED
        if wheel_below_road(system.wheels, road, work.motion):
            return BELOW_ROAD
    observe(system, state, work.motion, sample)
    return GOOD


@kernel
def observe(system, state, motion, sample):
    """Fill what a sample says about the end of the period."""
    update_motion(system.tree, state.tree, motion)
    store3(sample.hull_velocity, 0, body_axes(motion, 0, load3(motion.velocity, 0)))
    store3(sample.hull_rate, 0, body_axes(motion, 0, load3(motion.rate, 0)))
    displacement, displacement_rate = imposed_displacement(system.engine, state.crank_angle[0])
    observe_mounts(system.mounts, motion, state.currents, displacement, displacement_rate, sample.mounts)
