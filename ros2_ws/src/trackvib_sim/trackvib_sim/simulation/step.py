"""One physics step, and control periods of them in a single compiled generator."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined, kernel
from ..numerics.spatial import store3
from ..rui.sweeps.articulated import open_cuts
from ..rui.sweeps.elastic import apply_elastic_hinges
from ..rui.sweeps.integrator import integrate
from ..rui.sweeps.kinematics import MotionOffset, body_axes, motion_vector, rotation, update_motion
from ..rui.sweeps.riccati import solve_accelerations
from ..vehicle.coil import drive_coils
from ..vehicle.drive.drive import end_drive_step
from ..vehicle.drive.driver import add_driver
from ..vehicle.drive.engine import add_engine, imposed_displacement
from ..vehicle.drive.path import LEFT_BEHIND, path_is_left
from ..vehicle.hinge_springs import add_hinge_springs
from ..vehicle.mount_energy import update_mount_energy
from ..vehicle.mounts import MountSample, new_mount_sample, observe_mounts, push_mounts
from ..vehicle.suspension import add_suspension
from ..vehicle.tracks.tracks import advance_tracks, track_skips, wheel_below_road
from .sensing import measure


class Status(IntEnum):
    """How a step ended: well, or the state left the valid range."""

    GOOD = 0
    NOT_FINITE = 1
    OVERTURNED = 2
    BELOW_ROAD = 3
    AIRBORNE = 4
    SKIPPED = 5
    LEFT_PATH = 6


LEAST_UPRIGHT = 0.36  # cosine of the hull's tilt; 1.2 rad is beyond what the suspension and the driver are made for
LONGEST_FLIGHT = 1.0  # s; from 1.2 m, where no driver goes and no running gear is made for

REASONS = {
    Status.NOT_FINITE: "the state is no longer finite",
    Status.OVERTURNED: "the vehicle has overturned",
    Status.BELOW_ROAD: "a road wheel lies below the road",
    Status.SKIPPED: "a track has skipped a tooth of its sprocket",
    Status.LEFT_PATH: f"the vehicle has left its path by more than {LEFT_BEHIND:g} m, or gone back on it too far",
    Status.AIRBORNE: f"no shoe has touched the ground for {LONGEST_FLIGHT:g} s",
}


class Sample(NamedTuple):
    """What one control period leaves to look at.

    Sensors and the rest give what there is at its end, probes a row a physics step.
    """

    specific_force: np.ndarray  # (m, 3) acceleration less gravity through the low-pass, sensors' axes, m/s^2
    angular_velocity: np.ndarray  # (m, 3) through the low-pass, sensors' axes, rad/s
    probed: np.ndarray  # (steps, p, 3) specific force of the probes, axes of their bodies, m/s^2
    hull_velocity: np.ndarray  # (1, 3) of the hull's origin, hull axes, m/s
    hull_angular_velocity: np.ndarray  # (1, 3) hull axes, rad/s
    mounts: MountSample


def new_sample(points, steps, mounts):
    """Return room for a sample of a period of `steps` physics steps."""
    m, p = len(points.body), len(points.probe_body)
    measured = np.zeros((m, 3)), np.zeros((m, 3)), np.zeros((steps, p, 3))
    return Sample(*measured, np.zeros((1, 3)), np.zeros((1, 3)), new_mount_sample(mounts))


class Rows(NamedTuple):
    """How many control periods to do in one go, and what is kept of each."""

    wanted: np.ndarray  # (1,) how many
    done: np.ndarray  # (1,) how many of them were good so far
    specific_force: np.ndarray  # (k, m, 3) of the sensors at each period's end, k = wanted or 0, m/s^2
    probed: np.ndarray  # (k, steps, p, 3) m/s^2
    speed: np.ndarray  # (k,) of the hull along its own x axis, m/s


def one_row(sample):
    """Return the `Rows` of single periods of which nothing is kept but the sample."""
    parts = (np.zeros((0, *part.shape)) for part in (sample.specific_force, sample.probed))
    return Rows(np.ones(1, int), np.zeros(1, int), *parts, np.zeros(0))


@inlined
def add_forces(system, state, road, work):
    """From the state the motion of all bodies, and on them all forces; the tracks' nodes are advanced by the step."""
    tree, motion, cuts = system.tree, work.motion, work.cuts
    work.torques[:] = 0.0
    add_hinge_springs(system.springs, state.tree, work.torques)
    add_suspension(system.suspension, state.tree, work.torques)
    update_motion(tree, state.tree, motion)
    open_cuts(tree, motion, work.torques, cuts)
    advance_tracks(
        system.tracks,
        state.tracks,
        state.tree,
        road,
        state.drive.path,
        motion,
        tree.gravity,
        cuts,
        work.tracks,
        system.dt,
    )
    displacement, displacement_rate = imposed_displacement(system.drive.engine, state.drive.crank)
    apply_elastic_hinges(tree, motion, cuts)
    update_mount_energy(
        system.mounts,
        state.fields,
        motion,
        state.coils.field,
        displacement,
        displacement_rate,
        system.dt,
        state.mount_energy,
    )
    push_mounts(system.mounts, motion, cuts, state.mount_energy.force)
    add_engine(system.drive.engine, state.drive.crank, motion, cuts)
    add_driver(system.drive, state.drive, state.tree.hinge_rate, motion, cuts, system.dt)


@inlined
def end_step(system, state, road, work, points, sample, step):
    """With all accelerations known: measure the period's `step`, then integrate bodies and drive.

    Returns `GOOD`, or what made the state leave the valid range.
    """
    measure(work, points, sample, step)
    integrate(system.tree, state.tree, work.response, system.dt)
    end_drive_step(system.drive, state.drive, state.tree.position[0, 0], state.tree.position[0, 1], system.dt)
    total = _total_speed(state.tree)
    # not np.isfinite: it compiles to total - total == 0, which reassociation turns into "true"
    if not abs(total) < np.inf:
        return Status.NOT_FINITE
    if rotation(work.motion, system.drive.driver.hull)[8] < LEAST_UPRIGHT:
        return Status.OVERTURNED
    if wheel_below_road(system.tracks, road, state.drive.path, work.motion):
        return Status.BELOW_ROAD
    if path_is_left(state.drive.path, system.drive.reach):
        return Status.LEFT_PATH
    state.flight[0] = 0.0 if work.tracks.touching[0] > 0.0 else state.flight[0] + system.dt
    if state.flight[0] > LONGEST_FLIGHT:
        return Status.AIRBORNE
    if track_skips(work.tracks):
        return Status.SKIPPED
    return Status.GOOD


@inlined
def _total_speed(tree):
    """Sum of all speeds: accelerations of free bodies act on theirs, every other one on that of its hinge.

    A loop is a vector instruction for many of them, which an array's own sum is not.
    """
    total = 0.0
    for row in range(tree.hinge_rate.size):
        total += tree.hinge_rate[row]
    for free in range(tree.velocity.shape[0]):
        for k in range(3):
            total += tree.velocity[free, k] + tree.angular_velocity[free, k]
    return total


@kernel
def control_periods(system, state, road, demanded, steps, work, points, following, last, rows):
    """Advance by control periods of `steps` physics steps, with the demanded currents (c,) [A] of that moment.

    Each turn of the generator does as many periods as `rows` asks for, notes how many were good and yields `GOOD`, or
    at once what made the state leave the valid range. The samples are filled in turns, beginning with `following`; that
    of a period that is not good is filled again. A generator keeps its arguments as kernels take them: to hand over
    these records of hundreds of arrays anew costs half of the physics. It does not own them.
    """
    while True:
        status, rows.done[0] = Status.GOOD, 0
        while status == Status.GOOD and rows.done[0] < rows.wanted[0]:
            status = _advance(system, state, road, demanded, steps, work, points, following)
            if status == Status.GOOD:
                _keep(rows, following)
                following, last = last, following
                rows.done[0] += 1
        yield status


@inlined
def _advance(system, state, road, demanded, steps, work, points, sample):
    """Advance by one period; returns `GOOD`, or at once what made the state leave the valid range."""
    for step in range(steps):
        drive_coils(system.coil, demanded, state.coils)
        add_forces(system, state, road, work)
        solve_accelerations(system.tree, work.motion, work.cuts, work.response)
        status = end_step(system, state, road, work, points, sample, step)
        if status != Status.GOOD:
            return status
    observe(system, state, work.motion, sample)
    return Status.GOOD


@inlined
def _keep(rows, sample):
    """Copy a sample to its row, if there is one."""
    k = rows.done[0]
    if k >= rows.speed.size:
        return
    rows.speed[k] = sample.hull_velocity[0, 0]
    for i in range(sample.specific_force.shape[0]):
        for axis in range(3):
            rows.specific_force[k, i, axis] = sample.specific_force[i, axis]
    for step in range(sample.probed.shape[0]):
        for i in range(sample.probed.shape[1]):
            for axis in range(3):
                rows.probed[k, step, i, axis] = sample.probed[step, i, axis]


@kernel
def observe(system, state, motion, sample):
    """Fill what a sample says about the end of the period."""
    update_motion(system.tree, state.tree, motion)
    hull = system.drive.driver.hull
    store3(sample.hull_velocity, 0, body_axes(motion, hull, motion_vector(motion, MotionOffset.VELOCITY, hull)))
    store3(
        sample.hull_angular_velocity,
        0,
        body_axes(motion, hull, motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, hull)),
    )
    displacement, displacement_rate = imposed_displacement(system.drive.engine, state.drive.crank)
    observe_mounts(system.mounts, state.fields, motion, state.coils, displacement, displacement_rate, sample.mounts)
