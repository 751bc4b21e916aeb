"""Places, velocities and attitudes of the whole tree, against finite differences and scipy's rotations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.kinematics import integrate, point_place, point_velocity
from trackvib_sim.rui.spatial import turn_quaternion
from trackvib_sim.rui.tree import rest_state

SEEDS = st.integers(0, 2**32 - 1)
FEW = settings(max_examples=20)


@pytest.mark.analytic
@FEW
@given(seed=SEEDS)
def test_velocity_is_the_rate_of_place(system, random_state, moved, seed, drifted):
    """The velocity of a point of every body is the derivative of its place."""
    tree, h = system.tree, 1e-5
    state = random_state(tree, seed)
    now, before, after = (moved(tree, drifted(state, t)) for t in (0.0, -h, h))
    point = (0.3, -0.2, 0.5)
    for body in range(len(tree.mass)):
        place = np.array([point_place(motion, body, point) for motion in (before, after)])
        velocity = point_velocity(now, body, point_place(now, body, point))
        # central difference: h^2 / 6 of the third derivative (rate^3 * 5 m, a few 1e2), and 1e-15 / h of rounding
        assert_allclose((place[1] - place[0]) / (2.0 * h), velocity, rtol=0, atol=1e-7)


@pytest.mark.analytic
@FEW
@given(seed=SEEDS)
def test_rate_is_the_rate_of_attitude(system, random_state, moved, seed, drifted):
    """The angular velocity of every body is the derivative of its attitude."""
    tree, h = system.tree, 1e-5
    state = random_state(tree, seed)
    now, before, after = (moved(tree, drifted(state, t)) for t in (0.0, -h, h))
    turn = Rotation.from_matrix(after.rotation.reshape(-1, 3, 3)) * Rotation.from_matrix(
        before.rotation.reshape(-1, 3, 3)
    ).inv()
    assert_allclose(turn.as_rotvec() / (2.0 * h), now.rate, rtol=0, atol=1e-7)


@pytest.mark.property
@given(seed=SEEDS, dt=st.floats(1e-9, 2.0))
def test_turning_a_quaternion_is_a_rotation(seed, dt):
    """An attitude turned at a constant rate is scipy's and stays a unit quaternion, whatever the angle."""
    random = np.random.default_rng(seed)
    q, rate = Rotation.random(rng=random), random.normal(size=3)
    got = turn_quaternion(tuple(q.as_quat(scalar_first=True)), tuple(rate), dt)
    expected = Rotation.from_rotvec(dt * rate) * q
    assert np.linalg.norm(got) == pytest.approx(1.0, abs=1e-15)
    assert (Rotation.from_quat(got, scalar_first=True) * expected.inv()).magnitude() < 1e-14


@pytest.mark.analytic
def test_integration_is_symplectic_euler(system, random_state):
    """A step changes the speeds by the accelerations, and then the places by the new speeds."""
    tree, dt = system.tree, 1e-3
    state, before = random_state(tree, 3), random_state(tree, 3)
    random = np.random.default_rng(1)
    linear, angular, hinge = random.normal(size=3), random.normal(size=3), random.normal(size=len(tree.mass))
    integrate(state, linear, angular, hinge, dt)
    assert_allclose(state.velocity, before.velocity + dt * linear, rtol=1e-15)
    assert_allclose(state.rate, before.rate + dt * angular, rtol=1e-15)
    assert_allclose(state.position, before.position + dt * state.velocity, rtol=1e-15)
    assert_allclose(state.hinge_rate[1:], (before.hinge_rate + dt * hinge)[1:], rtol=1e-14)
    assert_allclose(state.hinge[1:], (before.hinge + dt * state.hinge_rate)[1:], rtol=1e-14)
    turned = Rotation.from_rotvec(dt * state.rate) * Rotation.from_quat(before.attitude, scalar_first=True)
    assert (Rotation.from_quat(state.attitude, scalar_first=True) * turned.inv()).magnitude() < 1e-15


@pytest.mark.analytic
def test_falling_vehicle_falls(system, solved):
    """A vehicle in free fall drops by g t^2 / 2, and a step more of the method; no hinge moves."""
    tree, dt, steps = system.tree, 1e-3, 100
    state = rest_state(tree)
    for _ in range(steps):
        _, sweep = solved(tree, state)
        integrate(state, sweep.linear[0], sweep.angular[0], sweep.hinge_acceleration, dt)
    # symplectic Euler sums 1 + 2 + ... + n
    assert state.position[2] == pytest.approx(-9.81 * dt**2 * steps * (steps + 1) / 2, rel=1e-11)
    assert np.abs(state.hinge).max() < 1e-11
