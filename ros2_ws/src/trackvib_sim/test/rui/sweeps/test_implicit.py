"""Linearly implicit springs in hinges and to ground: the dense equation, and steps too long for explicit ones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.sweeps.articulated import apply_force, apply_implicit_bush, apply_implicit_spring, apply_wrench
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.kinematics import point_place
from trackvib_sim.rui.sweeps.tree import build_tree, new_rows, rest_lanes, to_lanes, to_table
from trackvib_sim.rui.table import Body, Hinge

from ..cases import NO_GRAVITY, G, dense_mass, generalised, in_rows, seeds, shapes


def _symmetric(s):
    return np.array([[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]])


def _positive(random, size):
    """Six numbers of a random positive definite symmetric matrix."""
    half = random.normal(size=(3, 3))
    m = size * (half @ half.T + np.eye(3))
    return (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2])


@pytest.mark.analytic
@shapes
@seeds
def test_implicit_springs_solve_the_linearly_implicit_equation(shaped_table, solved, shape, seed):
    """A step with implicit springs and bushes is that of the dense equation (M + h C + h^2 K) a = f - h K v.

    f is what the explicit step has; for a bush, K = J^T k J, and the velocity-dependent part of the acceleration of
    its point is with J a.
    """
    bodies, state, loads = shaped_table(shape, 600 + seed, ("revolute", "prismatic", "locked"))
    random, tree, h = np.random.default_rng(seed), build_tree(bodies, G), 0.01
    n, at, dense, lanes = len(bodies), place_bodies(bodies, state), dense_mass(bodies, state), to_lanes(tree, state)
    springs = [(b, random.uniform(0, 1e6), random.uniform(0, 1e4)) for b in range(1, n, 2) if tree.moves[b]]
    bushes = [
        (b, at.origin[b] + random.normal(size=3), _positive(random, 1e6), _positive(random, 1e4))
        for b in sorted({0, n // 2, n - 1})
    ]

    def load(motion, cuts):
        for row, force, moment in zip(tree.row, loads.force, loads.moment, strict=True):
            apply_wrench(cuts, row, tuple(force), tuple(moment))
        for b, stiffness, damping in springs:
            apply_implicit_spring(cuts, lanes, tree.row[b], stiffness, damping, h)
        for b, place, stiffness, damping in bushes:
            apply_implicit_bush(cuts, motion, tree.gravity, tree.row[b], tuple(place), stiffness, damping, h)

    _, _, response = solved(tree, lanes, in_rows(tree, loads.torque), load)
    integrate(tree, lanes, response, h)
    after = to_table(tree, lanes)

    explicit = accelerations(bodies, state, loads, G)
    a = generalised(dense, explicit, bodies)
    v = np.array([getattr(state, part)[index] for part, index in dense.freedom])
    matrix, right = dense.mass.copy(), dense.mass @ a
    for b, stiffness, damping in springs:
        k = dense.freedom.index(("hinge_rate", b))
        matrix[k, k] += h * damping + h**2 * stiffness
        right[k] -= h * stiffness * v[k]
    for b, place, stiffness, damping in bushes:
        arm, om = place - at.origin[b], at.angular_velocity[b]
        jacobian = np.array([unit.velocity[b] + np.cross(unit.angular_velocity[b], arm) for unit in dense.speed]).T
        total = explicit.linear[b] + np.cross(explicit.angular[b], arm) + np.cross(om, np.cross(om, arm))
        z, k = h * _symmetric(damping) + h**2 * _symmetric(stiffness), _symmetric(stiffness)
        matrix += jacobian.T @ z @ jacobian
        right -= jacobian.T @ (h * k @ (jacobian @ v) + z @ (total - jacobian @ a))
    expected = v + h * np.linalg.solve(matrix, right)
    got = np.array([getattr(after, part)[index] for part, index in dense.freedom])
    # 1e4 times stiffer than the bodies are heavy
    assert_allclose(got, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


@pytest.mark.analytic
@pytest.mark.parametrize("wheels", [1, 12])
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize("implicit", [False, True])
def test_stiff_spring_in_a_hinge_stays_bounded(solved, wheels, kind, implicit):
    """With h^2 k / m = 100 the implicit step only loses energy, over 1000 steps; the explicit one blows up."""
    bodies = [Body(0, "base", 1e9, (0, 0, 0), 1e9 * np.eye(3))] + [
        Body(k, f"wheel {k}", 2.0, (0, 0, 0), 2.0 * np.eye(3), Hinge(k, kind, "base", (k, 0, 0), (0, 1, 0)))
        for k in range(1, wheels + 1)
    ]
    tree, h = build_tree(bodies, NO_GRAVITY), 1e-3
    assert len(tree.lanes) == (1 if wheels == 1 else 8)
    stiffness, state, rows = 100.0 * 2.0 / h**2, rest_lanes(tree), tree.row[1:]
    state.hinge[rows] = 0.1

    def load(motion, cuts):
        for row in rows if implicit else ():
            apply_implicit_spring(cuts, state, row, stiffness, 0.0, h)

    def energy():
        return np.sum(state.hinge_rate[rows] ** 2) + stiffness / 2.0 * np.sum(state.hinge[rows] ** 2)

    largest, start = 0.0, energy()
    before = start
    for _ in range(1000 if implicit else 10):
        torques = new_rows(tree)
        torques[rows] = -stiffness * state.hinge[rows]
        _, _, response = solved(tree, state, torques, load)
        integrate(tree, state, response, h)
        largest = max(largest, np.abs(state.hinge[rows]).max())
        if implicit:
            assert energy() <= before * (1.0 + 1e-9) + 1e-30 * start
            before = energy()
    if implicit:
        assert largest < 0.1
        assert np.abs(state.hinge[rows]).max() < 1e-12
    else:
        assert largest > 1e10


@pytest.mark.analytic
@pytest.mark.parametrize("implicit", [False, True])
def test_stiff_bush_stays_bounded(solved, implicit):
    """The same for a body on a bush to the ground, that turns while it is at it: 1000 steps bounded, 10 blow up."""
    mass, h, corner = 3.0, 1e-3, (0.2, 0.3, -0.1)
    tree = build_tree([Body(1, "block", mass, (0, 0, 0), np.diag([0.5, 0.6, 0.7]))], G)
    stiffness = (100.0 * mass / h**2,) * 3 + (0.0,) * 3
    state = rest_lanes(tree)
    # its corner is 0.01 m off
    state.position[0] = 0.01 - corner[0], -corner[1], -corner[2]
    state.angular_velocity[0] = 1.0, -2.0, 0.5

    def load(motion, cuts):
        place = point_place(motion, 0, corner)
        apply_force(cuts, motion, 0, place, tuple(-stiffness[0] * np.array(place)))
        if implicit:
            apply_implicit_bush(cuts, motion, tree.gravity, 0, place, stiffness, (0.0,) * 6, h)

    largest = []
    for _ in range(1000 if implicit else 10):
        motion, _, response = solved(tree, state, load=load)
        largest.append(np.linalg.norm(point_place(motion, 0, corner)))
        integrate(tree, state, response, h)
    if implicit:
        assert max(largest) == largest[0]
        # then it is carried: weight and turning about the corner against 1e8 N/m
        assert max(largest[500:]) < 1e-5
    else:
        assert not max(largest) < 1e6
