"""What the tests of the sweeps share: the shapes of their trees, and the dense mass matrix."""

from types import SimpleNamespace

import numpy as np
import pytest
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.state import free_bodies
from trackvib_sim.rui.sweeps.tree import new_rows

ROUNDING = 1e-11  # of the largest value; some 1e2 operations a body, at 1e-16, and condition numbers of some 1e2
G = (0.0, 0.0, -9.81)
NO_GRAVITY = (0.0, 0.0, 0.0)
SHAPES = ("single", "chain", "bush", "branches", "stalk", "hung")
EVERY_KIND = ("revolute", "prismatic", "prescribed", "locked", "elastic")
shapes = pytest.mark.parametrize("shape", SHAPES)
seeds = pytest.mark.parametrize("seed", range(5))


def differ(found, expected):
    """Largest difference over the largest entry, quantity by quantity (1 at least: some are all zero)."""
    pairs = [(a, b) for a, b in zip(found, expected, strict=True) if np.size(b)]
    return max(np.max(np.abs(a - b)) / max(np.max(np.abs(b)), 1.0) for a, b in pairs)


def dense_mass(bodies, state):
    """Mass matrix from the kinetic energy: `freedom` (each a part of the state and its index), `speed`, `mass`.

    `speed[k]` is the `Placement` with speed k at 1 and all others at 0.
    """
    free = free_bodies(bodies)
    freedom = [(part, (k, i)) for k in range(len(free)) for part in ("velocity", "angular_velocity") for i in range(3)]
    freedom += [
        ("hinge_rate", row) for row, body in enumerate(bodies)
        if body.hinge is not None and body.hinge.kind in ("revolute", "prismatic") and not body.hinge.prescribed
    ]  # fmt: skip
    mass, speeds, momenta = np.zeros((len(freedom),) * 2), [], []
    for part, index in freedom:
        moving = state._replace(**{item: np.zeros_like(getattr(state, item)) for item in state._fields[2:4]},
                                hinge_rate=np.zeros(len(bodies)))  # fmt: skip
        getattr(moving, part)[index] = 1.0
        at = place_bodies(bodies, moving)
        centre = [A @ body.centre for A, body in zip(at.rotation, bodies, strict=True)]
        spin = [
            A @ body.inertia @ A.T @ om for A, body, om in zip(at.rotation, bodies, at.angular_velocity, strict=True)
        ]
        v = at.velocity + np.cross(at.angular_velocity, centre)
        speeds.append(SimpleNamespace(velocity=at.velocity, angular_velocity=at.angular_velocity, v=v))
        momenta.append((np.array([[body.mass] for body in bodies]) * v, np.array(spin)))
    for i, speed in enumerate(speeds):
        for j, (linear, angular) in enumerate(momenta):
            mass[i, j] = np.sum(speed.v * linear) + np.sum(speed.angular_velocity * angular)
    return SimpleNamespace(freedom=freedom, speed=speeds, mass=mass)


def generalised(dense, found, bodies):
    """The accelerations of the freedoms of `dense_mass`."""
    free = free_bodies(bodies)
    parts = {"velocity": found.linear[free], "angular_velocity": found.angular[free], "hinge_rate": found.hinge}
    return np.array([parts[part][index] for part, index in dense.freedom])


def in_rows(tree, torque):
    """Torques in the rows of a tree, from those in the order of its table."""
    rows = new_rows(tree)
    rows[tree.row] = torque
    return rows
