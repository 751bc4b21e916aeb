"""The sweeps on the vehicle's whole body tree, against Newton and Euler written out once more in plain numpy."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.tree import SLIDE

SEEDS = st.integers(0, 2**32 - 1)
# 41 bodies, some 1e2 operations each, at 1e-16; the measured rest is near 1e-14 of the largest value
ROUNDING = 1e-11
FEW = settings(max_examples=20)


def newton_euler(tree, state, sweep):
    """Motion of every centre of mass and what is left of forces, from coordinates and the sweep's accelerations.

    Of the sweep only the root's and the hinges' accelerations are used.
    """
    n = len(tree.mass)
    turn, place, v, om, a, al, hinge = (np.zeros((n, *s)) for s in ((3, 3), (3,), (3,), (3,), (3,), (3,), (3,)))
    turn[0] = Rotation.from_quat(state.attitude, scalar_first=True).as_matrix()
    place[0] = hinge[0] = state.position
    v[0], om[0], a[0], al[0] = state.velocity, state.rate, sweep.linear[0], sweep.angular[0]
    for b in range(1, n):
        p, th, thd, thdd = tree.parent[b], state.hinge[b], state.hinge_rate[b], sweep.hinge_acceleration[b]
        e = turn[p] @ tree.axis[b]
        hinge[b] = place[b] = place[p] + turn[p] @ tree.place[b]
        turn[b], om[b], al[b] = turn[p], om[p], al[p]
        if tree.kind[b] == SLIDE:
            place[b] = hinge[b] + e * th
        else:
            turn[b] = turn[p] @ Rotation.from_rotvec(tree.axis[b] * th).as_matrix()
            om[b] = om[p] + e * thd
            al[b] = al[p] + e * thdd + np.cross(om[p], e) * thd
        arm = place[b] - place[p]
        v[b] = v[p] + np.cross(om[p], arm)
        a[b] = a[p] + np.cross(al[p], arm) + np.cross(om[p], np.cross(om[p], arm))
        if tree.kind[b] == SLIDE:
            v[b] += e * thd
            a[b] += e * thdd + 2.0 * np.cross(om[p], e) * thd
    arm = np.einsum("nij,nj->ni", turn, tree.centre)
    i = tree.inertia
    local = np.array([[i[:, 0], i[:, 3], i[:, 4]], [i[:, 3], i[:, 1], i[:, 5]], [i[:, 4], i[:, 5], i[:, 2]]])
    inertia = np.einsum("nij,jkn,nlk->nil", turn, local, turn)
    spin = np.einsum("nij,nj->ni", inertia, om)
    return SimpleNamespace(
        hinge=hinge,
        axis=np.einsum("nij,nj->ni", turn, tree.axis),
        c=place + arm,
        v=v + np.cross(om, arm),
        om=om,
        spin=spin,
        rate_of_momentum=tree.mass[:, None] * (a + np.cross(al, arm) + np.cross(om, np.cross(om, arm))),
        rate_of_spin=np.einsum("nij,nj->ni", inertia, al) + np.cross(om, spin),
        inertia=inertia,
    )


def brute_wrenches(tree, body, loads):
    """What each hinge must carry so that its outboard bodies move as they do: q and m of the child on the parent."""
    n = len(tree.mass)
    force = tree.mass[:, None] * tree.gravity - body.rate_of_momentum
    wrench = np.zeros((n, 6))
    for b in range(n):
        for j in range(b, n):
            k = j
            while k > b:
                k = tree.parent[k]
            if k == b:
                wrench[b, :3] += force[j] + loads.force[j]
                wrench[b, 3:] += (
                    np.cross(body.c[j] - body.hinge[b], force[j])
                    - body.rate_of_spin[j]
                    + loads.moment[j]
                    + np.cross(body.hinge[j] - body.hinge[b], loads.force[j])
                )
    return wrench


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_hinges_carry_what_newton_and_euler_ask(system, random_state, random_loads, solved, seed):
    """Each of the 40 hinges carries the inertia forces and loads of all bodies behind it; the root's end is free."""
    tree = system.tree
    state, loads = random_state(tree, seed), random_loads(len(tree.mass), seed)
    _, sweep = solved(tree, state, loads)
    expected = brute_wrenches(tree, newton_euler(tree, state, sweep), loads)
    sweep.hinge_wrench[0] = 0.0
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(expected[1:, part]).max()
        assert_allclose(sweep.hinge_wrench[:, part], expected[:, part], rtol=0, atol=ROUNDING * scale)


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_hinge_axes_carry_only_their_torque(system, random_state, random_loads, solved, seed):
    """Along its axis a hinge carries the known torque and nothing else: e . m = -tau, for a slide e . q = -tau."""
    tree = system.tree
    state, loads = random_state(tree, seed), random_loads(len(tree.mass), seed)
    motion, sweep = solved(tree, state, loads)
    force = np.einsum("ni,ni->n", motion.axis, sweep.hinge_wrench[:, :3])
    moment = np.einsum("ni,ni->n", motion.axis, sweep.hinge_wrench[:, 3:])
    along = np.where(tree.kind == SLIDE, force, moment)[1:]
    assert_allclose(along, -loads.torque[1:], rtol=0, atol=ROUNDING * np.abs(sweep.hinge_wrench).max())


@pytest.mark.property
@pytest.mark.parametrize("gravity", [0.0, -9.81])
@FEW
@given(seed=SEEDS)
def test_free_flight_keeps_momentum_and_energy(system, random_state, solved, gravity, seed):
    """Without loads only gravity changes momentum, angular momentum and energy, at the rate of its force."""
    tree = system.tree._replace(gravity=np.array([0.0, 0.0, gravity]))
    state = random_state(tree, seed)
    _, sweep = solved(tree, state)
    body = newton_euler(tree, state, sweep)
    weight = tree.mass[:, None] * tree.gravity
    linear = body.rate_of_momentum - weight
    angular = np.cross(body.c, linear) + body.rate_of_spin
    power = np.einsum("ni,ni->n", linear, body.v) + np.einsum("ni,ni->n", body.rate_of_spin, body.om)
    for residual in (linear, angular, power):
        # each body for itself is far from free, only the sum is
        assert np.abs(residual.sum(axis=0)).max() < ROUNDING * np.abs(residual).sum()


@pytest.mark.property
@FEW
@given(seed=SEEDS)
def test_orientation_of_the_global_frame_does_not_matter(system, random_state, random_loads, solved, seed):
    """Turning attitude, speeds, gravity and loads together turns the result and changes nothing else."""
    tree, n = system.tree, len(system.tree.mass)
    state, loads = random_state(tree, seed), random_loads(n, seed)
    _, sweep = solved(tree, state, loads)
    turn = Rotation.random(rng=np.random.default_rng(seed))
    attitude = (turn * Rotation.from_quat(state.attitude, scalar_first=True)).as_quat(scalar_first=True)
    turned = state._replace(
        position=turn.apply(state.position),
        attitude=attitude,
        velocity=turn.apply(state.velocity),
        rate=turn.apply(state.rate),
    )
    loads_turned = loads._replace(force=turn.apply(loads.force), moment=turn.apply(loads.moment))
    tree_turned = tree._replace(gravity=turn.apply(tree.gravity))
    _, result = solved(tree_turned, turned, loads_turned)
    for expected, got in (
        (turn.apply(sweep.linear), result.linear),
        (turn.apply(sweep.angular), result.angular),
        (sweep.hinge_acceleration, result.hinge_acceleration),
        (turn.apply(sweep.hinge_wrench[1:, :3]), result.hinge_wrench[1:, :3]),
        (turn.apply(sweep.hinge_wrench[1:, 3:]), result.hinge_wrench[1:, 3:]),
    ):
        assert_allclose(got, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


@pytest.mark.property
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_accelerations_invert_the_mass_matrix(system, random_state, random_loads, solved, seed):
    """Unit loads at rest give the columns of M^-1, M being the dense mass matrix from the kinetic energy."""
    tree = system.tree._replace(gravity=np.zeros(3))
    n = len(tree.mass)
    still = random_state(tree, seed, speed=0.0)
    inverse, jacobian_v, jacobian_om = np.zeros((46, 46)), np.zeros((n, 3, 46)), np.zeros((n, 3, 46))
    for k in range(46):
        loads = random_loads(n, 0, size=0.0)
        moving = still._replace(velocity=np.zeros(3), rate=np.zeros(3), hinge_rate=np.zeros(n))
        for load, speed, index in (
            (loads.force[0], moving.velocity, k),
            (loads.moment[0], moving.rate, k - 3),
            (loads.torque, moving.hinge_rate, k - 5),
        ):
            if 0 <= index < len(load) and (load is loads.torque) == (k >= 6):
                load[index] = speed[index] = 1.0
        _, sweep = solved(tree, still, loads)
        inverse[:, k] = np.concatenate((sweep.linear[0], sweep.angular[0], sweep.hinge_acceleration[1:]))
        body = newton_euler(tree, moving, sweep)
        jacobian_v[:, :, k], jacobian_om[:, :, k] = body.v, body.om
    mass = np.einsum("n,nik,nil->kl", tree.mass, jacobian_v, jacobian_v)
    mass += np.einsum("nik,nij,njl->kl", jacobian_om, body.inertia, jacobian_om)
    scale = np.sqrt(np.diag(mass))
    inverse *= np.outer(scale, scale)
    mass /= np.outer(scale, scale)
    # scaled to a unit diagonal, both are of size 1 ... 1e3
    assert_allclose(inverse, inverse.T, rtol=0, atol=ROUNDING * np.abs(inverse).max())
    assert np.linalg.eigvalsh(inverse)[0] > 0.0
    assert_allclose(mass @ inverse, np.eye(46), rtol=0, atol=ROUNDING * np.abs(inverse).max())


@pytest.mark.property
def test_integrated_free_flight_keeps_momentum_and_energy(system, random_state, solved):
    """A fourth-order run of half a second without gravity keeps momentum and energy to the order of the method."""
    tree = system.tree._replace(gravity=np.zeros(3))
    n, dt = len(tree.mass), 1e-3
    state = random_state(tree, 5, hinge=0.2)
    sizes = np.cumsum((3, 4, 3, 3, n))

    def unpack(y):
        return type(state)(*np.split(y, sizes))

    def slope(y):
        s = unpack(y)
        _, sweep = solved(tree, s)
        w, (x1, y1, z1) = s.rate, s.attitude[1:]
        vector = s.attitude[0] * w + np.cross(w, (x1, y1, z1))
        turning = 0.5 * np.concatenate(([-w @ s.attitude[1:]], vector))
        return np.concatenate((
            s.velocity, turning, sweep.linear[0], sweep.angular[0], s.hinge_rate, sweep.hinge_acceleration,
        ))  # fmt: skip

    def constants(y):
        s = unpack(y)
        body = newton_euler(tree, s, solved(tree, s)[1])
        momentum = tree.mass[:, None] * body.v
        energy = 0.5 * np.sum(momentum * body.v) + 0.5 * np.sum(body.spin * body.om)
        return np.concatenate((momentum.sum(0), (np.cross(body.c, momentum) + body.spin).sum(0), [energy]))

    y = np.concatenate(state)
    before = constants(y)
    for _ in range(500):
        k1 = slope(y)
        k2 = slope(y + 0.5 * dt * k1)
        k3 = slope(y + 0.5 * dt * k2)
        k4 = slope(y + dt * k3)
        y = y + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    # rates up to some 3 rad/s: (rate dt)^4 = 1e-10 in a period of them
    assert_allclose(constants(y), before, rtol=0, atol=1e-9 * np.abs(before).max())
    assert np.abs(y - np.concatenate(state)).max() > 0.1
