"""The energy account of a moving vehicle: what it holds, what driver and engine give, what turns into heat.

Symplectic Euler is the leapfrog method: places belong to the ends of the steps, speeds to their middle. The account is
taken where a step begins, with its places and the mean of the speeds before and after (`begin_of_step`): a force F of
those places does the work F dt times that mean, so with it linear springs and dampers close to rounding. With the
speeds before the step alone the heat of the stiffest dampers would come out too high by c dt / (2 m), which is 5 %.
"""

from typing import NamedTuple

import numpy as np

from ..rui.cells import get3, get6
from ..rui.compiled import kernel
from ..rui.cuts import FORCE, MOMENT
from ..rui.kinematics import ORIGIN, RATE, VELOCITY, motion_vector, rotation, update_motion
from ..rui.spatial import cross, dot, rotate, symmetric_product, turn_inertia
from ..rui.tree import FOOT_SHARE, INERTIA, MASS, MASS_MOMENT, SHARE
from .driver import add_driver
from .engine import add_engine, imposed_displacement
from .hinge_springs import add_hinge_springs
from .mr_mounts import mount_characteristics, mount_deflection, mount_force
from .suspension import add_suspension
from .tracks.nodes import SHEAR, STRIDE
from .tracks.nodes import VELOCITY as NODE_VELOCITY
from .tracks.tracks import SINKS, add_tracks

PARTS = ("links", "ground", "rims", "teeth", "tensioners", "hinges", "suspension", "mounts")
HINGES, SUSPENSION, MOUNTS = range(SINKS, len(PARTS))  # behind the tracks' own
SOURCES = ("driver", "engine")
DRIVER, ENGINE = range(len(SOURCES))


class Account(NamedTuple):
    """The account at one instant. Heat can be negative by no more than rounding."""

    kinetic: np.ndarray  # (1,) of all bodies and shoes, J
    gravitational: np.ndarray  # (1,) of the same, zero at the global origin, J
    stored: np.ndarray  # (8,) in each of `PARTS`, bump stops with the suspension, J
    heat: np.ndarray  # (8,) W
    given: np.ndarray  # (2,) by each of `SOURCES`, W


def new_account():
    """Return an empty record."""
    return Account(np.zeros(1), np.zeros(1), np.zeros(len(PARTS)), np.zeros(len(PARTS)), np.zeros(len(SOURCES)))


def energy(account):
    """Return all the energy that a vehicle holds [J]."""
    return account.kinetic[0] + account.gravitational[0] + account.stored.sum()


def copy_state(state, to):
    """Copy a `system.State`, or a part of one."""
    for source, target in zip(state, to, strict=True):
        if isinstance(source, np.ndarray):
            target[:] = source
        else:
            copy_state(source, target)


def begin_of_step(before, after):
    """Turn `before`, the state before a step, into the one to take the account of, given the state after the step."""
    for speed, later in zip(_speeds(before), _speeds(after), strict=True):
        speed += later
        speed *= 0.5


def _speeds(state):
    tree, tracks = state.tree, state.tracks
    nodes = tracks.nodes[:, NODE_VELOCITY * STRIDE : SHEAR * STRIDE]
    return tree.velocity, tree.rate, tree.hinge_rate, nodes, tracks.tensioner.rate


@kernel
def take_account(system, state, road, work, account):
    """Fill the account of a vehicle in a state (`begin_of_step`) on a road, with coils under constant current.

    The driver's integral and the shear of the ground in `state` advance by a step, as they do in the step itself.
    Everything in `work` is overwritten.
    """
    tree, motion, cuts = system.tree, work.motion, work.cuts
    update_motion(tree, state.tree, motion)
    account.kinetic[0], account.gravitational[0] = 0.0, 0.0
    _add_bodies(tree, motion, account)
    _add_shoes(system, state.tracks.nodes, account)
    account.stored[:] = 0.0
    account.heat[:] = 0.0
    _add_hinge_springs(system.springs, state.tree, work.torques, account)
    _add_suspension(system.suspension, state.tree, work.torques, account)
    cuts.cells[:] = 0.0
    add_engine(system.engine, state.crank_angle[0], motion, cuts)
    account.given[ENGINE] = _power(motion, cuts)
    _add_mounts(system, state, motion, account)
    cuts.cells[:] = 0.0
    add_driver(system.driver, motion, cuts, state.speed_integral, system.dt)
    account.given[DRIVER] = _power(motion, cuts)
    add_tracks(system.tracks, state.tracks, state.tree, road, motion, cuts, work.tracks, system.dt)
    for part in range(SINKS):
        account.stored[part] += work.tracks.stored[part]
        account.heat[part] += work.tracks.heat[part]


@kernel
def _add_bodies(tree, motion, account):
    w = len(tree.lanes)
    for j in range(tree.parent.size):
        body = tree.body[j]
        for i in range(w):
            if body[SHARE * w + i] + body[FOOT_SHARE * w + i] == 0.0:
                continue  # an empty lane
            row, mass = j * w + i, body[MASS * w + i]
            turn = rotation(motion, row)
            to_centre = rotate(turn, get3(body, MASS_MOMENT, w, i))
            inertia = turn_inertia(turn, get6(body, INERTIA, w, i))
            origin, rate = motion_vector(motion, ORIGIN, row), motion_vector(motion, RATE, row)
            velocity = motion_vector(motion, VELOCITY, row)
            account.kinetic[0] += 0.5 * mass * dot(velocity, velocity) + dot(velocity, cross(rate, to_centre))
            account.kinetic[0] += 0.5 * dot(rate, symmetric_product(inertia, rate))
            for k in range(3):
                account.gravitational[0] -= tree.gravity[k] * (mass * origin[k] + to_centre[k])


@kernel
def _add_shoes(system, nodes, account):
    mass, gravity = system.tracks.chain.shoe_mass, system.tree.gravity
    for side in range(2):
        for k in range(3):
            for i in range(1, system.tracks.chain.links + 1):
                speed = nodes[side, (NODE_VELOCITY + k) * STRIDE + i]
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
        account.stored[HINGES] += 0.5 * elastic * state.hinge[b]
        account.heat[HINGES] -= (torques[b] + elastic) * state.hinge_rate[b]


@kernel
def _add_suspension(suspension, state, torques, account):
    s = suspension
    torques[:] = 0.0
    add_suspension(s, state, torques)
    for i in range(s.row.size):
        b = s.row[i]
        angle = state.hinge[b]
        bar, stop = s.bar_stiffness * angle, s.stop_stiffness * max(0.0, angle - s.stop_angle)
        account.stored[SUSPENSION] += (s.preload + 0.5 * bar) * angle + 0.5 * stop * (angle - s.stop_angle)
        account.heat[SUSPENSION] -= (torques[b] + s.preload + bar + stop) * state.hinge_rate[b]


@kernel
def _add_mounts(system, state, motion, account):
    """Where the engine imposes a displacement across a mount it does work on the mount's force."""
    mounts = system.mounts
    imposed, imposed_rate = imposed_displacement(system.engine, state.crank_angle[0])
    for index in range(2):
        current = state.currents[index]
        _, l, l_d = mount_deflection(mounts, motion, index, imposed, imposed_rate)
        force, heat = mount_force(mounts, current, l, l_d)
        k, _ = mount_characteristics(mounts, current)
        for axis in range(3):
            account.stored[MOUNTS] += 0.5 * k * mounts.stiffness_ratio[axis] * l[axis] * l[axis]
        account.stored[MOUNTS] -= mounts.static_load * l[2]
        account.heat[MOUNTS] += heat
        account.given[ENGINE] += force[2] * imposed_rate


@kernel
def _power(motion, cuts):
    """Return the power [W] of the loads in cuts that hold nothing else."""
    w, power = len(cuts.lanes), 0.0
    for j in range(len(cuts.cells)):
        for i in range(w):
            row = j * w + i
            power += dot(get3(cuts.cells[j], FORCE, w, i), motion_vector(motion, VELOCITY, row))
            power += dot(get3(cuts.cells[j], MOMENT, w, i), motion_vector(motion, RATE, row))
    return power
