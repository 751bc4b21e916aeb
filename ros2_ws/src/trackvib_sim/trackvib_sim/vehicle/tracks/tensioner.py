"""The idlers' tensioners: a slide along the hull's x axis with a preloaded spring and a damper.

The tree's idler turns at a fixed place of the hull; the slide shifts the rim that the track runs on. Its mass, that of
the idler, counts along its own way only, where it bounds how fast the slide can move.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ..body_tree import drive_end


class Tensioner(NamedTuple):
    """Both sides, left first."""

    stiffness: float  # N/m
    damping: float  # N s/m
    mass: float  # kg
    preload: np.ndarray  # (2,) N at travel zero
    fitted: np.ndarray  # (2,) travel at which the track has its pretension, m


class TensionerState(NamedTuple):
    """Both slides, left first."""

    travel: np.ndarray  # (2,) forwards, m
    rate: np.ndarray  # (2,) m/s


def build_tensioner(vehicle, travel, load):
    """Return the record for the vehicle, whose taut tracks have a travel (2,) [m] and pull with (2,) [N] along x.

    The springs are in balance with that pull unless the file gives their force.
    """
    t = vehicle.tensioners
    preload = -drive_end(vehicle) * np.array(t.force) if t.force else t.stiffness * travel - load
    return Tensioner(t.stiffness, t.damping, vehicle.idlers.mass, preload, travel)


@inlined
def move_tensioner(tensioner, state, side, push, dt):
    """Advance one slide by dt under the track's `push` [N] on the idler along x."""
    preload, travel, rate = tensioner.preload[side], state.travel[side], state.rate[side]
    force = preload + push - tensioner.stiffness * travel - tensioner.damping * rate
    state.rate[side] += dt * force / tensioner.mass
    state.travel[side] += dt * state.rate[side]


@inlined
def tensioner_energy(tensioner, state, side):
    """Return the power turned into heat [W] and the energy stored in spring and moving mass [J]."""
    preload, travel, rate = tensioner.preload[side], state.travel[side], state.rate[side]
    stored = 0.5 * (tensioner.stiffness * travel * travel + tensioner.mass * rate * rate) - preload * travel
    return tensioner.damping * rate * rate, stored
