"""Damped poles and modes, their shares and names: closed forms, printed example, an independent linearisation."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.linear.mode import describe
from trackvib_sim.rui.linear.model import GroundSpring, LinearModel
from trackvib_sim.rui.linear.modes import modes, natural_frequencies
from trackvib_sim.rui.state import rest_state
from trackvib_sim.rui.table import Body, Hinge

from .linear_models import pendulum, random_model, settled_vehicle
from .linear_reference import Dense

SAME = 1e-9  # relative: two routes in double precision, each with condition numbers up to 1e6
SEEDS = range(20)
DAMPED = [
    (1.002, 0.124), (1.211, 0.098), (1.487, 0.031), (1.490, 0.203), (1.876, 0.123), (2.494, 0.235), (6.614, 0.013),
    (8.988, 0.018), (9.477, 0.025), (13.748, 0.525),
]  # fmt: skip


@pytest.fixture(scope="module")
def vehicle():
    """The illustrative vehicle of 41 bodies in equilibrium."""
    return settled_vehicle()


@pytest.fixture(scope="module")
def vehicle_modes(vehicle):
    """Its damped modes up to 15 Hz."""
    return modes(vehicle, 15.0)


def oscillator(stiffness, damping):
    """A body of 2 kg that slides on a held root against a spring and damper, without gravity."""
    table = [
        Body(0, "root", 1.0, (0, 0, 0), np.eye(3)),
        Body(1, "mass", 2.0, (0, 0, 0), np.eye(3), Hinge(1, "prismatic", "root", (0, 0, 0), (1, 0, 0))),
    ]
    return LinearModel(table, rest_state(table), (0, 0, 0), [0, stiffness], [0, damping], fixed_root=True)


@pytest.mark.analytic
def test_unstable_pendulum_has_two_real_poles():
    """Upside down: one pole out, one in, of equal size; natural_frequencies gives minus the rate."""
    rate = np.sqrt(2.0 * 9.81 * 0.5 / 0.6)
    found = modes(pendulum(angle=np.pi))
    assert_allclose([mode.pole for mode in found], [-rate, rate], rtol=SAME)
    assert [mode.damping_ratio for mode in found] == [1.0, -1.0]
    assert_allclose(natural_frequencies(pendulum(angle=np.pi), 10.0), [-rate / (2.0 * np.pi)], rtol=SAME)


@pytest.mark.analytic
@pytest.mark.parametrize("ratio", [0.0, 0.01, 0.6, 0.999])
def test_damped_oscillator(ratio):
    """s = omega (-zeta + i sqrt(1 - zeta^2))."""
    omega = np.sqrt(800.0 / 2.0)
    (mode,) = modes(oscillator(800.0, 2.0 * ratio * omega * 2.0))
    assert_allclose(mode.pole, omega * (-ratio + 1j * np.sqrt(1.0 - ratio**2)), rtol=SAME)
    assert_allclose([mode.frequency, mode.damping_ratio], [omega / (2.0 * np.pi), ratio], rtol=SAME, atol=1e-12)
    assert not mode.overdamped


@pytest.mark.analytic
@pytest.mark.parametrize("ratio", [1.001, 3.0, 50.0])
def test_overdamped_oscillator_gives_two_real_modes(ratio):
    """s = omega (-zeta +- sqrt(zeta^2 - 1)), reported as two modes with damping ratio 1."""
    omega = np.sqrt(800.0 / 2.0)
    found = modes(oscillator(800.0, 2.0 * ratio * omega * 2.0))
    expected = omega * (-ratio + np.array([1.0, -1.0]) * np.sqrt(ratio**2 - 1.0))
    assert_allclose([mode.pole for mode in found], expected, rtol=SAME)
    assert all(mode.overdamped and mode.damping_ratio == 1.0 for mode in found)


@pytest.mark.analytic
@pytest.mark.parametrize("damping", [1.5, 20.0])
def test_equal_damped_pendulums_have_independent_modes(damping):
    """A threefold pole (pair), J s^2 + c s + m g l = 0, with three independent shapes; overdamped, two of them."""
    found = modes(pendulum(3, damping=damping))
    expected = np.roots([0.6, damping, 2.0 * 9.81 * 0.5])
    expected = expected[expected.imag >= 0.0]
    for pole in expected:
        shapes = [mode.coordinate[1:] for mode in found if abs(mode.pole - pole) < 1e-7 * abs(pole)]
        assert len(shapes) == 3
        assert np.linalg.svd(shapes, compute_uv=False)[-1] > 0.1 * np.linalg.norm(shapes[0])
    assert len(found) == 3 * len(expected)


@pytest.mark.golden
def test_illustrative_vehicle_damped(vehicle_modes):
    """Frequency and damping ratio to the digits given; then twelve wheel hops between 14.3 and 14.9 Hz, about 0.66."""
    values = np.array([(mode.frequency, mode.damping_ratio) for mode in vehicle_modes])
    assert_allclose(values[:10], DAMPED, rtol=0.0, atol=0.51e-3)
    assert len(values) == 22
    assert np.all((values[10:, 0] > 14.3) & (values[10:, 0] < 14.95) & (np.abs(values[10:, 1] - 0.66) < 0.04))


@pytest.mark.golden
def test_illustrative_vehicle_descriptions(vehicle, vehicle_modes):
    """The modes are called by what moves: turret, mantlet, recoil part, powertrain, arms with their wheels."""
    names = [describe(vehicle, mode, group=lambda name: name.split()[0]) for mode in vehicle_modes[6:]]
    expected = ["turret", "mantlet", "recoil", "powertrain"] + ["arm"] * 12
    assert [name.split()[0] for name in names] == expected


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", SEEDS)
def test_poles_and_shapes_against_dense_matrices(seed):
    """Every pole of the dense system is found once, and every shape solves the dense equations."""
    model = random_model(seed)
    dense, found = Dense(model), modes(model)
    assert len(found) == len(dense.poles())
    for pole in dense.poles():
        assert min(abs(mode.pole - pole) for mode in found) < SAME * abs(pole)
    for mode in found:
        q = dense.coordinates(mode.x, mode.coordinate)
        size = np.abs(mode.pole) ** 2 * np.abs(dense.M) + np.abs(mode.pole) * np.abs(dense.C) + np.abs(dense.K)
        assert np.abs(dense.stiffness_at(mode.pole) @ q).max() < SAME * np.max(size @ np.abs(q))


@pytest.mark.property
@pytest.mark.parametrize("seed", SEEDS)
def test_energy_shares(seed):
    """Shares of bodies and of motions each sum up to the whole kinetic energy, that of the mode being 1."""
    model = random_model(seed)
    dense = Dense(model)
    for mode in modes(model):
        q = dense.coordinates(mode.x, mode.coordinate)
        assert_allclose(np.real(np.conj(q) @ dense.M @ q), 1.0, rtol=SAME)
        assert_allclose(mode.energy_share.sum(), 1.0, rtol=SAME)
        assert_allclose(mode.root_share.sum(), mode.energy_share[0], rtol=SAME, atol=1e-12)
        assert_allclose(mode.whole_share.sum() + mode.hinge_share.sum(), 1.0, rtol=SAME)
        assert np.all(mode.energy_share >= 0.0)


@pytest.mark.property
def test_only_what_lies_below_the_limit(vehicle_modes, vehicle):
    """A lower limit returns the same modes as far as it goes."""
    low = modes(vehicle, 9.0)
    assert_allclose([mode.pole for mode in low], [mode.pole for mode in vehicle_modes[: len(low)]], rtol=1e-12)
    assert len(low) == 8


@pytest.mark.property
def test_a_state_of_motion_or_unrest_is_refused():
    """A pendulum off its equilibrium, and a spring on an unknown body."""
    with pytest.raises(ValueError, match="hinge 1 of body 'p0': acceleration is"):
        modes(replace(pendulum(angle=0.7), loads=None))
    with pytest.raises(ValueError, match="no such body; known are root, p0"):
        replace(pendulum(), springs=(GroundSpring("hull"),))
