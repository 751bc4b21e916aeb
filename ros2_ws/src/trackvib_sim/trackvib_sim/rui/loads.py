"""Known loads on the bodies: what springs, dampers, contacts and drives add before the sweeps."""

from typing import NamedTuple

import numpy as np

from .compiled import kernel
from .spatial import add3, cross, load3, subtract


class Loads(NamedTuple):
    """Known loads, global axes. Gravity is not among them: the sweep adds it."""

    force: np.ndarray  # (n, 3) N
    moment: np.ndarray  # (n, 3) about the body's origin, N m
    torque: np.ndarray  # (n,) of the hinge on the child along the axis, N m (N for a slide)


def new_loads(n):
    """Return zero loads for n bodies."""
    return Loads(np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n))


@kernel
def clear_loads(loads):
    """Set every load to zero."""
    loads.force[:] = 0.0
    loads.moment[:] = 0.0
    loads.torque[:] = 0.0


@kernel
def apply_force(loads, motion, body, place, force):
    """Add a force that acts on a body at a global place."""
    arm = subtract(place, load3(motion.origin, body))
    add3(loads.force, body, force)
    add3(loads.moment, body, cross(arm, force))
