"""The sweeps on the vehicle's whole body tree, against Newton and Euler written out once more in plain numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import no_loads
from trackvib_sim.rui.sweeps import tree as packing
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.tree import build_tree, rest_lanes

from .newton_euler import G, brute_wrenches, newton_euler

NO_GRAVITY = (0.0, 0.0, 0.0)
SEEDS = st.integers(0, 2**32 - 1)
# 41 bodies, some 1e2 operations each, at 1e-16; the measured rest is near 1e-14 of the largest value
ROUNDING = 1e-11
FEW = settings(max_examples=20)


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_hinges_carry_what_newton_and_euler_ask(table, random_state, random_loads, seed):
    """Each of the 40 hinges carries the inertia forces and loads of all bodies behind it; the root's end is free."""
    state, loads = random_state(seed), random_loads(seed)
    found = accelerations(table, state, loads, G)
    expected = brute_wrenches(newton_euler(table, state, found), loads)
    assert not found.wrench[0].any()
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(expected[1:, part]).max()
        assert_allclose(found.wrench[:, part], expected[:, part], rtol=0, atol=ROUNDING * scale)


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_bodies_accelerate_as_their_hinges_say(table, random_state, random_loads, seed):
    """The accelerations of all bodies follow from those of the root and the hinges."""
    state = random_state(seed)
    found = accelerations(table, state, random_loads(seed), G)
    body = newton_euler(table, state, found)
    for got, expected in ((found.linear, body.a), (found.angular, body.al)):
        assert_allclose(got, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_hinge_axes_carry_only_their_torque(table, random_state, random_loads, seed):
    """Along its axis a hinge carries the known torque and nothing else: e . m = -tau (prismatic: e . q = -tau)."""
    state, loads = random_state(seed), random_loads(seed)
    found = accelerations(table, state, loads, G)
    body = newton_euler(table, state, found)
    force = np.einsum("ni,ni->n", body.axis, found.wrench[:, :3])
    moment = np.einsum("ni,ni->n", body.axis, found.wrench[:, 3:])
    along = np.where(body.prismatic, force, moment)[1:]
    assert_allclose(along, -loads.torque[1:], rtol=0, atol=ROUNDING * np.abs(found.wrench).max())


@pytest.mark.property
@pytest.mark.parametrize("gravity", [0.0, -9.81])
@FEW
@given(seed=SEEDS)
def test_free_flight_keeps_momentum_and_energy(table, random_state, gravity, seed):
    """Without loads only gravity changes momentum, angular momentum and energy, at the rate of its force."""
    state = random_state(seed)
    body = newton_euler(table, state, accelerations(table, state, no_loads(table), (0.0, 0.0, gravity)))
    linear = body.rate_of_momentum - body.mass * (0.0, 0.0, gravity)
    angular = np.cross(body.c, linear) + body.rate_of_spin
    power = np.einsum("ni,ni->n", linear, body.v) + np.einsum("ni,ni->n", body.rate_of_spin, body.om)
    for residual in (linear, angular, power):
        # each body for itself is far from free, only the sum is
        assert np.abs(residual.sum(axis=0)).max() < ROUNDING * np.abs(residual).sum()


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_orientation_of_the_global_frame_does_not_matter(table, random_state, random_loads, seed):
    """Turning attitude, speeds, gravity and loads together turns the result and changes nothing else."""
    state, loads = random_state(seed), random_loads(seed)
    found = accelerations(table, state, loads, G)
    turn = Rotation.random(rng=np.random.default_rng(seed))
    attitude = (turn * Rotation.from_quat(state.attitude, scalar_first=True)).as_quat(scalar_first=True)
    turned = state._replace(
        position=turn.apply(state.position),
        attitude=attitude,
        velocity=turn.apply(state.velocity),
        angular_velocity=turn.apply(state.angular_velocity),
    )
    loads_turned = loads._replace(force=turn.apply(loads.force), moment=turn.apply(loads.moment))
    result = accelerations(table, turned, loads_turned, turn.apply(G))
    for expected, got in (
        (turn.apply(found.linear), result.linear),
        (turn.apply(found.angular), result.angular),
        (found.hinge, result.hinge),
        (turn.apply(found.wrench[:, :3]), result.wrench[:, :3]),
        (turn.apply(found.wrench[:, 3:]), result.wrench[:, 3:]),
    ):
        assert_allclose(got, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


@pytest.mark.property
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_one_lane_finds_what_eight_find(table, random_state, random_loads, monkeypatch, seed):
    """The vehicle's bodies stand eight abreast; one behind the other they move alike."""
    state, loads = random_state(seed), random_loads(seed)
    assert len(build_tree(table).lanes) == 8
    eight = accelerations(table, state, loads, G)
    monkeypatch.setattr(packing, "LANES", 1)
    assert len(build_tree(table).lanes) == 1
    for got, expected in zip(accelerations(table, state, loads, G), eight, strict=True):
        assert_allclose(got, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


@pytest.mark.property
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_accelerations_invert_the_mass_matrix(table, random_state, seed):
    """Unit loads at rest give the columns of M^-1, M being the dense mass matrix from the kinetic energy."""
    n = len(table)
    still = random_state(seed, speed=0.0)
    inverse, jacobian_v, jacobian_om = np.zeros((46, 46)), np.zeros((n, 3, 46)), np.zeros((n, 3, 46))
    for k in range(46):
        loads = no_loads(table)
        moving = still._replace(velocity=np.zeros((1, 3)), angular_velocity=np.zeros((1, 3)), hinge_rate=np.zeros(n))
        if k < 3:
            loads.force[0, k] = moving.velocity[0, k] = 1.0
        elif k < 6:
            loads.moment[0, k - 3] = moving.angular_velocity[0, k - 3] = 1.0
        else:
            loads.torque[k - 5] = moving.hinge_rate[k - 5] = 1.0
        found = accelerations(table, still, loads, NO_GRAVITY)
        inverse[:, k] = np.concatenate((found.linear[0], found.angular[0], found.hinge[1:]))
        body = newton_euler(table, moving, found)
        jacobian_v[:, :, k], jacobian_om[:, :, k] = body.v, body.om
    mass = np.einsum("n,nik,nil->kl", body.mass[:, 0], jacobian_v, jacobian_v)
    mass += np.einsum("nik,nij,njl->kl", jacobian_om, body.inertia, jacobian_om)
    scale = np.sqrt(np.diag(mass))
    inverse *= np.outer(scale, scale)
    mass /= np.outer(scale, scale)
    # scaled to a unit diagonal, both are of size 1 ... 1e3
    assert_allclose(inverse, inverse.T, rtol=0, atol=ROUNDING * np.abs(inverse).max())
    assert np.linalg.eigvalsh(inverse)[0] > 0.0
    assert_allclose(mass @ inverse, np.eye(46), rtol=0, atol=ROUNDING * np.abs(inverse).max())


@pytest.mark.slow(reason="integrates for seconds")
@pytest.mark.property
def test_integrated_free_flight_keeps_momentum_and_energy(table, random_state):
    """A fourth-order run of half a second without gravity keeps momentum and energy to the order of the method."""
    dt, loads = 1e-3, no_loads(table)
    state = random_state(5, hinge=0.2)
    sizes = np.cumsum([part.size for part in state[:-1]])

    def pack(parts):
        return np.concatenate([np.ravel(part) for part in parts])

    def unpack(y):
        return type(state)(*(np.reshape(x, part.shape) for x, part in zip(np.split(y, sizes), state, strict=True)))

    def slope(y):
        s = unpack(y)
        found = accelerations(table, s, loads, NO_GRAVITY)
        w, q = s.angular_velocity[0], s.attitude[0]
        turning = 0.5 * np.concatenate(([-w @ q[1:]], q[0] * w + np.cross(w, q[1:])))
        return pack((s.velocity, turning, found.linear[0], found.angular[0], s.hinge_rate, found.hinge))

    def constants(y):
        s = unpack(y)
        body = newton_euler(table, s, accelerations(table, s, loads, NO_GRAVITY))
        momentum = body.mass * body.v
        energy = 0.5 * np.sum(momentum * body.v) + 0.5 * np.sum(body.spin * body.om)
        return np.concatenate((momentum.sum(0), (np.cross(body.c, momentum) + body.spin).sum(0), [energy]))

    y = pack(state)
    before = constants(y)
    for _ in range(500):
        k1 = slope(y)
        k2 = slope(y + 0.5 * dt * k1)
        k3 = slope(y + 0.5 * dt * k2)
        k4 = slope(y + dt * k3)
        y = y + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    # rates up to some 3 rad/s: (rate dt)^4 = 1e-10 in a period of them
    assert_allclose(constants(y), before, rtol=0, atol=1e-9 * np.abs(before).max())
    assert np.abs(y - pack(state)).max() > 0.1


@pytest.mark.analytic
def test_falling_vehicle_falls(system, solved):
    """A vehicle in free fall drops by g t^2 / 2, and a step more of the method; no hinge moves."""
    tree, dt, steps = system.tree, 1e-3, 100
    state = rest_lanes(tree)
    for _ in range(steps):
        _, _, response = solved(tree, state)
        integrate(tree, state, response, dt)
    # symplectic Euler sums 1 + 2 + ... + n
    assert state.position[0, 2] == pytest.approx(-9.81 * dt**2 * steps * (steps + 1) / 2, rel=1e-11)
    assert np.abs(state.hinge).max() < 1e-11
