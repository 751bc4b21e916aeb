"""Momentum of the whole vehicle, summed in plain numpy over the table of bodies and the shoes."""

from typing import NamedTuple

import numpy as np
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset, new_motion, update_motion
from trackvib_sim.vehicle.tracks.nodes import STRIDE


class Momentum(NamedTuple):
    """Of bodies and shoes together, global axes."""

    mass: float  # kg
    centre: np.ndarray  # (3,) m
    linear: np.ndarray  # (3,) kg m/s
    angular: np.ndarray  # (3,) about the common centre, kg m^2/s
    kinetic: float  # J


def shoes(chain, cells):
    """Return a view (..., quantities, links) of the cells of nodes (..., quantities STRIDE), in their order.

    Of tracks with as many links left as right.
    """
    return cells.reshape(*cells.shape[:-1], -1, STRIDE)[..., 1 : chain.links[0] + 1]


def momentum(table, system, state):
    """Return the `Momentum` of a `vehicle.system.State`."""
    motion, row = new_motion(system.tree), system.tree.row
    update_motion(system.tree, state.tree, motion)
    turn = columns(motion, MotionOffset.ROTATION, 9)[row].reshape(-1, 3, 3)
    origin, velocity, rate = (
        columns(motion, quantity, 3)[row]
        for quantity in (MotionOffset.ORIGIN, MotionOffset.VELOCITY, MotionOffset.ANGULAR_VELOCITY)
    )
    to_centre = np.einsum("nij,nj->ni", turn, [body.centre for body in table])
    inertia = np.einsum("nij,njk,nlk->nil", turn, [body.inertia for body in table], turn)
    spin = np.einsum("nij,nj->ni", inertia, rate)
    chain = system.tracks.chain
    node = shoes(chain, state.tracks.nodes)
    shoe_place, shoe_velocity = (np.moveaxis(node[:, k : k + 3], 1, 2).reshape(-1, 3) for k in (0, 3))
    mass = np.concatenate(([body.mass for body in table], np.full(len(shoe_place), chain.shoe_mass)))
    place = np.concatenate((origin + to_centre, shoe_place))
    speed = np.concatenate((velocity + np.cross(rate, to_centre), shoe_velocity))
    centre = mass @ place / mass.sum()
    return Momentum(
        mass=mass.sum(),
        centre=centre,
        linear=mass @ speed,
        angular=np.cross(place - centre, mass[:, None] * speed).sum(0) + spin.sum(0),
        kinetic=0.5 * mass @ (speed**2).sum(1) + 0.5 * np.sum(spin * rate),
    )
