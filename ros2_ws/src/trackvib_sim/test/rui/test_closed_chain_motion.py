"""Closed chains in motion: conserved energy, and how closure errors decay."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import null_space
from trackvib_sim.rui.closed_chain import closed_accelerations, closure_error
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.state import TreeState, no_loads

from .closed_chains import GRAVITY, ROUNDING, parallelogram, polygon

pytestmark = pytest.mark.slow(reason="integrates closed chains for seconds")


def _step(bodies, pins, state, loads, h, gravity):
    """One step of the classical Runge-Kutta method."""

    def slope(s):
        a, _ = closed_accelerations(bodies, pins, s, loads, gravity)
        w, *v = s.attitude[0]
        turning = 0.5 * np.array(
            [-s.angular_velocity[0] @ v, *(w * s.angular_velocity[0] + np.cross(s.angular_velocity[0], v))]
        )
        return TreeState(s.velocity, turning[None], a.linear[:1], a.angular[:1], s.hinge_rate, a.hinge)

    def after(s, ds, dt):
        moved = TreeState(*(x + dt * dx for x, dx in zip(s, ds, strict=True)))
        return moved._replace(attitude=moved.attitude / np.linalg.norm(moved.attitude))

    k1 = slope(state)
    k2 = slope(after(state, k1, 0.5 * h))
    k3 = slope(after(state, k2, 0.5 * h))
    k4 = slope(after(state, k3, h))
    mean = TreeState(*((a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)))
    return after(state, mean, h)


def _energy(bodies, state, gravity):
    at, total = place_bodies(bodies, state), 0.0
    for row, body in enumerate(bodies):
        A, om = at.rotation[row], at.angular_velocity[row]
        c = A @ body.centre
        v = at.velocity[row] + np.cross(om, c)
        total += 0.5 * body.mass * v @ v + 0.5 * om @ A @ body.inertia @ A.T @ om
        total -= body.mass * (at.origin[row] + c) @ gravity
    return total


@pytest.mark.analytic
@pytest.mark.parametrize("links", [5, 20])
def test_energy_of_a_swinging_chain(links):
    """A closed chain, tumbling in gravity, keeps its energy and stays closed but for the step's error of order 4."""
    bodies, cut, start, _ = polygon(links, links)
    start = start._replace(velocity=start.velocity + (1.0, 2.0, 3.0))
    loads, energy, drifts = no_loads(bodies), _energy(bodies, start, GRAVITY), []
    kinetic = _energy(bodies, start, np.zeros(3))
    for steps in (50, 100):
        state = start
        for _ in range(steps):
            state = _step(bodies, [cut], state, loads, 0.1 / steps, GRAVITY)
        drifts.append(abs(_energy(bodies, state, GRAVITY) - energy) / kinetic)
        assert np.abs(state.hinge - start.hinge).max() > 0.03
        assert np.abs(closure_error(bodies, [cut], state).position).max() < 1e-6
    assert drifts[1] < 1e-8
    assert drifts[1] < drifts[0] / 8.0


@pytest.mark.analytic
@pytest.mark.parametrize("seed", range(3))
def test_baumgarte_draws_the_ends_together(seed):
    """From any state the ends accelerate apart by -2 alpha of their speed and -beta^2 of their distance."""
    bodies, cut, state, loads = polygon(seed, 6)
    random = np.random.default_rng(seed)
    cut = replace(cut, alpha=3.0, beta=7.0)
    state = state._replace(hinge=state.hinge + 0.01 * random.normal(size=6),
                           hinge_rate=state.hinge_rate + random.normal(size=6))  # fmt: skip
    found, _ = closed_accelerations(bodies, [cut], state, loads)
    at, ends = place_bodies(bodies, state), []
    for row, point in ((5, cut.point_a), (0, cut.point_b)):
        arm, om = at.rotation[row] @ point, at.angular_velocity[row]
        ends.append(found.linear[row] + np.cross(found.angular[row], arm) + np.cross(om, np.cross(om, arm)))
    miss = closure_error(bodies, [cut], state)
    across = null_space((at.rotation[5] @ cut.axis)[None])
    wanted = -6.0 * miss.velocity[0] - 49.0 * miss.position[0]
    assert_allclose((ends[1] - ends[0]) @ across, wanted @ across, rtol=0, atol=ROUNDING * np.abs(ends).max())


@pytest.mark.analytic
def test_closure_error_decays():
    """In the plane, with alpha = beta, an error e at rest becomes e (1 + alpha t) exp(-alpha t); with 0 it stays."""
    bodies, cut, start, loads = parallelogram(0.4, 0.0)
    bodies[0] = replace(bodies[0], mass=50.0, inertia=np.eye(3))
    start.hinge[1:] += 1e-3, -2e-3, 1.5e-3
    before = closure_error(bodies, [cut], start).position[0]
    loads.force[0] = 0.0
    for alpha, left in ((0.0, 1.0), (20.0, 9.0 * np.exp(-8.0))):
        pins, state = [replace(cut, alpha=alpha, beta=alpha)], start
        for _ in range(200):
            state = _step(bodies, pins, state, loads, 2e-3, GRAVITY)
        after = closure_error(bodies, pins, state)
        assert_allclose(after.position[0], left * before, rtol=0, atol=1e-7 * np.abs(before).max())
