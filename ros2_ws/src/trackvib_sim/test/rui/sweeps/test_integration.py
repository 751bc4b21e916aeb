"""Motion over time: constants of free flight in a fourth-order run, and the order of the library's own integrator."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.state import TreeState
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.response import ResponseOffset
from trackvib_sim.rui.sweeps.tree import build_tree, new_rows, to_lanes, to_table

G = np.array([0.0, 0.0, -9.81])
DRIFT = 1e-11  # rates up to some 5 rad/s: of the order of (rate dt)^4 / 120


@pytest.fixture(scope="module")
def fourth_order(solved):
    """A function `fourth_order(tree, state, dt, steps, torques)`: the state, in rows, after steps of Runge and Kutta.

    `torques` turns a state into hinge torques, in rows; trees with one free body.
    """

    def slope(tree, state, torques):
        _, _, response = solved(tree, state, torques(state))
        root, w, q = tree.row[0], state.angular_velocity[0], state.attitude[0]
        turning = 0.5 * np.concatenate(([-w @ q[1:]], q[0] * w + np.cross(w, q[1:])))
        linear = columns(response, ResponseOffset.LINEAR, 3)[root] + tree.gravity
        hinge = np.where(
            np.isin(np.arange(len(state.hinge)), tree.row[1:]), columns(response, ResponseOffset.HINGE, 1)[:, 0], 0.0
        )
        angular = columns(response, ResponseOffset.ANGULAR, 3)[root]
        return TreeState(state.velocity, turning[None], linear[None], angular[None], state.hinge_rate, hinge)

    def run(tree, state, dt, steps, torques=lambda state: None):
        for _ in range(steps):
            k1 = slope(tree, state, torques)
            k2 = slope(tree, _ahead(state, 0.5 * dt, k1), torques)
            k3 = slope(tree, _ahead(state, 0.5 * dt, k2), torques)
            k4 = slope(tree, _ahead(state, dt, k3), torques)
            mean = TreeState(*((a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)))
            state = _ahead(state, dt, mean)
        return state

    return run


def _ahead(state, dt, slope):
    return TreeState(*(part + dt * rate for part, rate in zip(state, slope, strict=True)))


def constants(bodies, state, gravity, time):
    """What free flight keeps, and the sizes to compare its changes with.

    Momentum less what gravity has added, angular momentum about the common centre of mass, and energy, kinetic and
    potential. The sizes are sums over the bodies of what each has for itself.
    """
    at, mass = place_bodies(bodies, state), np.array([[body.mass] for body in bodies])
    arm = np.einsum("nij,nj->ni", at.rotation, [np.asarray(body.centre, dtype=float) for body in bodies])
    inertia = np.einsum("nij,njk,nlk->nil", at.rotation, [body.inertia for body in bodies], at.rotation)
    v, c = at.velocity + np.cross(at.angular_velocity, arm), at.origin + arm
    spin = np.einsum("nij,nj->ni", inertia, at.angular_velocity)
    centre = np.sum(mass * c, axis=0) / mass.sum()
    angular = np.cross(c - centre, mass * v) + spin
    kinetic = 0.5 * np.sum(mass * v * v, axis=1) + 0.5 * np.sum(spin * at.angular_velocity, axis=1)
    energy = kinetic.sum() - np.sum(mass * c @ gravity)
    momentum = np.sum(mass * (v - time * gravity), axis=0)
    sizes = np.abs(mass * v).sum(), np.abs(angular).sum(), kinetic.sum()
    return np.concatenate((momentum, angular.sum(axis=0), [energy])), np.repeat(sizes, (3, 3, 1))


@pytest.mark.slow(reason="integrates for seconds")
@pytest.mark.property
@pytest.mark.parametrize("gravity", [np.zeros(3), G], ids=["weightless", "falling"])
@pytest.mark.parametrize("which", ["vehicle", "tree"])
def test_free_flight_keeps_momentum_and_energy(table, random_state, random_table, fourth_order, which, gravity):
    """One second of free flight in steps of 1 ms keeps momentum, angular momentum and energy."""
    bodies, state = (table, random_state(5)) if which == "vehicle" else random_table(31, 12)[:2]
    tree = build_tree(bodies, gravity)
    end = to_table(tree, fourth_order(tree, to_lanes(tree, state), 1e-3, 1000))
    (before, size), (after, _) = constants(bodies, state, gravity, 0.0), constants(bodies, end, gravity, 1.0)
    assert_allclose(after / size, before / size, rtol=0, atol=DRIFT)
    assert np.abs(end.hinge - state.hinge).max() > 0.5


@pytest.mark.slow(reason="integrates at many step sizes")
@pytest.mark.analytic
def test_integrator_is_of_first_order(random_table, solved, fourth_order):
    """Halving the step of symplectic Euler halves the error at the end, on a tree with springs in its hinges."""
    bodies, state, _ = random_table(32, 8)
    tree = build_tree(bodies, G)
    time, stiffness = 0.25, 100.0

    def torques(state):
        rows = new_rows(tree)
        rows[tree.row[1:]] = -stiffness * state.hinge[tree.row[1:]]
        return rows

    exact = fourth_order(tree, to_lanes(tree, state), time / 1000, 1000, torques)
    errors = []
    for steps in (400, 800, 1600, 3200):
        lanes = to_lanes(tree, state)
        for _ in range(steps):
            _, _, response = solved(tree, lanes, torques(lanes))
            integrate(tree, lanes, response, time / steps)
        errors.append(np.array([np.max(np.abs(a - b)) for a, b in zip(lanes, exact, strict=True)]))
    for coarse, fine in pairwise(errors):
        slope = np.log2(coarse / fine)
        assert np.all((slope > 0.95) & (slope < 1.05)), slope
