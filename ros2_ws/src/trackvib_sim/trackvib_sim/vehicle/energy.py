"""The energy account of a moving vehicle: what it holds, what driver and engine give, what turns into heat."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import inlined, kernel
from ..numerics.spatial import cross, dot, rotate, symmetric_product, turn_inertia
from ..rui.sweeps.articulated import CutOffset
from ..rui.sweeps.cells import get3, get6
from ..rui.sweeps.elastic import elastic_energy
from ..rui.sweeps.kinematics import MotionOffset, motion_vector, rotation, update_motion
from ..rui.sweeps.tree import BodyOffset
from .drive.driver import add_driver
from .drive.engine import add_engine, imposed_displacement
from .hinge_springs import add_hinge_springs
from .mount_law import mount_force, mount_stored_energy
from .mounts import mount_current, mount_deflection
from .suspension import add_suspension
from .tracks.nodes import STRIDE, NodeOffset
from .tracks.one_track import TrackPart
from .tracks.tracks import TRACK_PARTS, add_tracks


class Part(IntEnum):
    """Where a vehicle stores and dissipates energy; the tracks' own, `TrackPart`, come first."""

    LINKS = TrackPart.LINKS
    GROUND = TrackPart.GROUND
    RIMS = TrackPart.RIMS
    TEETH = TrackPart.TEETH
    TENSIONERS = TrackPart.TENSIONERS
    HINGES = TRACK_PARTS
    SUSPENSION = TRACK_PARTS + 1
    MOUNTS = TRACK_PARTS + 2


class Source(IntEnum):
    """What gives energy to a vehicle."""

    DRIVER = 0
    ENGINE = 1


class Account(NamedTuple):
    """The account at one instant."""

    kinetic: np.ndarray  # (1,) of all bodies and shoes, J
    gravitational: np.ndarray  # (1,) of the same, zero at the global origin, J
    stored: np.ndarray  # (8,) by `Part`, bump stops with the suspension, J
    dissipation: np.ndarray  # (8,) W
    given: np.ndarray  # (2,) by `Source`, W


def new_account():
    """Return an empty record."""
    return Account(np.zeros(1), np.zeros(1), np.zeros(len(Part)), np.zeros(len(Part)), np.zeros(len(Source)))


def energy(account):
    """Return all the energy that a vehicle holds [J]."""
    return account.kinetic[0] + account.gravitational[0] + account.stored.sum()


@kernel
def evaluations(system, state, road, work, account):
    """Fill the account anew at each turn; as `simulation.step.control_periods` it does not own its arguments."""
    while True:
        _evaluate(system, state, road, work, account)
        yield True


@inlined
def _evaluate(system, state, road, work, account):
    """Fill the account for a state as it is; the driver's integral and the shear in it advance by a step."""
    tree, motion, cuts = system.tree, work.motion, work.cuts
    update_motion(tree, state.tree, motion)
    account.kinetic[0], account.gravitational[0] = 0.0, 0.0
    _add_bodies(tree, motion, account)
    _add_shoes(system, state.tracks.nodes, account)
    account.stored[:] = 0.0
    account.dissipation[:] = 0.0
    _add_hinge_springs(system.springs, state.tree, work.torques, account)
    _add_elastic_hinges(tree, motion, account)
    _add_suspension(system.suspension, state.tree, work.torques, account)
    cuts.cells[:] = 0.0
    add_engine(system.drive.engine, state.drive.crank, motion, cuts)
    account.given[Source.ENGINE] = _power(motion, cuts)
    _add_mounts(system, state, motion, account)
    cuts.cells[:] = 0.0
    add_driver(system.drive, state.drive, state.tree.hinge_rate, motion, cuts, system.dt)
    account.given[Source.DRIVER] = _power(motion, cuts)
    add_tracks(
        system.tracks,
        state.tracks,
        state.tree,
        road,
        state.drive.path,
        motion,
        cuts,
        work.tracks,
        system.dt,
        True,
    )
    for part in range(TRACK_PARTS):
        account.stored[part] += work.tracks.stored[part]
        account.dissipation[part] += work.tracks.dissipation[part]


@kernel
def _add_bodies(tree, motion, account):
    w = len(tree.lanes)
    for j in range(tree.parent.size):
        body = tree.body[j]
        for i in range(w):
            if body[BodyOffset.SHARE * w + i] + body[BodyOffset.FOOT_SHARE * w + i] == 0.0:
                continue  # an empty lane
            row, mass = j * w + i, body[BodyOffset.MASS * w + i]
            turn = rotation(motion, row)
            to_centre = rotate(turn, get3(body, BodyOffset.MASS_MOMENT, w, i))
            inertia = turn_inertia(turn, get6(body, BodyOffset.INERTIA, w, i))
            origin, rate = (
                motion_vector(motion, MotionOffset.ORIGIN, row),
                motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, row),
            )
            velocity = motion_vector(motion, MotionOffset.VELOCITY, row)
            account.kinetic[0] += 0.5 * mass * dot(velocity, velocity) + dot(velocity, cross(rate, to_centre))
            account.kinetic[0] += 0.5 * dot(rate, symmetric_product(inertia, rate))
            for k in range(3):
                account.gravitational[0] -= tree.gravity[k] * (mass * origin[k] + to_centre[k])


@kernel
def _add_shoes(system, nodes, account):
    mass, gravity = system.tracks.chain.shoe_mass, system.tree.gravity
    for side in range(2):
        for k in range(3):
            for i in range(1, system.tracks.chain.links[side] + 1):
                speed = nodes[side, (NodeOffset.VELOCITY + k) * STRIDE + i]
                account.kinetic[0] += 0.5 * mass * speed * speed
                account.gravitational[0] -= mass * gravity[k] * nodes[side, k * STRIDE + i]


@kernel
def _add_hinge_springs(springs, state, torques, account):
    """What a torque takes beyond the elastic part turns into heat; so do the suspension's."""
    torques[:] = 0.0
    add_hinge_springs(springs, state, torques)
    for k in range(springs.row.size):
        b = springs.row[k]
        elastic = springs.stiffness[k] * state.hinge[b]
        account.stored[Part.HINGES] += 0.5 * elastic * state.hinge[b]
        account.dissipation[Part.HINGES] -= (torques[b] + elastic) * state.hinge_rate[b]


@kernel
def _add_elastic_hinges(tree, motion, account):
    """Their wrenches without damping tell what they store, for rotations as small as bushings allow."""
    for k in range(tree.elastic.child.size):
        stored, dissipated = elastic_energy(tree, motion, k)
        account.stored[Part.HINGES] += stored
        account.dissipation[Part.HINGES] += dissipated


@kernel
def _add_suspension(suspension, state, torques, account):
    s = suspension
    torques[:] = 0.0
    add_suspension(s, state, torques)
    for i in range(s.row.size):
        b = s.row[i]
        angle = state.hinge[b]
        bar, stop = s.bar_stiffness[i] * angle, s.stop_stiffness[i] * max(0.0, angle - s.stop_angle[i])
        account.stored[Part.SUSPENSION] += (s.preload[i] + 0.5 * bar) * angle + 0.5 * stop * (angle - s.stop_angle[i])
        account.dissipation[Part.SUSPENSION] -= (torques[b] + s.preload[i] + bar + stop) * state.hinge_rate[b]


@kernel
def _add_mounts(system, state, motion, account):
    """Where the engine imposes a displacement across a mount it does work on the mount's force."""
    mounts = system.mounts
    imposed, imposed_rate = imposed_displacement(system.drive.engine, state.drive.crank)
    for index in range(mounts.body.size):
        current = mount_current(mounts, index, state.coils.field)
        _, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        force, dissipation = mount_force(mounts, state.fields, index, current, l, l_d)
        account.stored[Part.MOUNTS] += mount_stored_energy(mounts, state.fields, index, l)
        account.dissipation[Part.MOUNTS] += dissipation
        account.given[Source.ENGINE] += force[2] * mounts.excited[index] * imposed_rate


@kernel
def _power(motion, cuts):
    """Return the power [W] of the loads in cuts that hold nothing else."""
    w, power = len(cuts.lanes), 0.0
    for j in range(len(cuts.cells)):
        for i in range(w):
            row = j * w + i
            power += dot(get3(cuts.cells[j], CutOffset.FORCE, w, i), motion_vector(motion, MotionOffset.VELOCITY, row))
            power += dot(
                get3(cuts.cells[j], CutOffset.MOMENT, w, i), motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, row)
            )
    return power
