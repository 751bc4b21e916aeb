"""The linear model of the mounts, and the LQG design on it against an independent solution of its Riccati equations."""

import numpy as np
import pytest
from mr_mount_controller.laws.clipped_optimal import (
    ENGINE_NOISE,
    ROAD_NOISE,
    SENSOR_NOISE,
    ClippedOptimal,
    discrete_filter,
    kalman_gain,
    regulator_gain,
    weights,
)
from mr_mount_controller.laws.mount_model import mount_model
from mr_mount_controller.mount import PUBLISHED
from mr_mount_controller.mounting import DEFAULT_CARRIED, PAIR
from numpy.testing import assert_allclose

PERIOD = 1e-3
TRAVEL, FORCE = 3e-3, 2e4


@pytest.fixture(scope="module")
def model():
    """The model at the soft current of the law."""
    return mount_model(0.8, PAIR)


def stable_subspace(a, b, q, r, n):
    """Gain and closed-loop poles from the eigenvectors of the Hamiltonian, in states scaled to like sizes."""
    r_inverse = np.linalg.inv(r)
    f = a - b @ r_inverse @ n.T
    hamiltonian = np.block([[f, -b @ r_inverse @ b.T], [-(q - n @ r_inverse @ n.T), -f.T]])
    values, vectors = np.linalg.eig(hamiltonian)
    stable = values.real < 0.0
    x1, x2 = np.split(vectors[:, stable], 2)
    p = (x2 @ np.linalg.inv(x1)).real
    return r_inverse @ (b.T @ p + n.T), np.sort_complex(values[stable])


@pytest.mark.analytic
@pytest.mark.parametrize("current", [0.8, 3.0])
def test_powertrain_alone_has_its_own_frequency(current):
    """With the hull held, by hand: (2 k + K) over the powertrain's inertia at the mounts, and its damping."""
    model = mount_model(current, PAIR)
    a = model.a[np.ix_([1, 3], [1, 3])]
    carried = DEFAULT_CARRIED
    inertia = carried.mount_mass
    # the hull moves a little with it: its mass is 36 t, the coupling r m
    inertia -= (carried.coupling * carried.powertrain_mass) ** 2 / (carried.hull_mass + carried.powertrain_mass)
    spring = 2.0 * PUBLISHED.stiffness(current) + carried.other_stiffness
    assert_allclose(a, [[0.0, 1.0], [-spring / inertia, -2.0 * PUBLISHED.damping(current) / inertia]], rtol=1e-12)


@pytest.mark.analytic
def test_free_fall_and_rigid_push(model):
    """A force of the engine in the powertrain's centre, at rest, accelerates hull and powertrain as one hinged pair.

    Lagrange's equations by hand for the two unknown accelerations, checked by momentum: force = M a_hull + m a_centre.
    """
    heave, across = model.f[1, 1], model.f[0, 1] - model.f[1, 1]
    powertrain = DEFAULT_CARRIED.powertrain_mass * (heave + DEFAULT_CARRIED.coupling * across)
    assert DEFAULT_CARRIED.hull_mass * heave + powertrain == pytest.approx(1.0)


@pytest.mark.analytic
@pytest.mark.parametrize(("travel", "force"), [(3e-3, 2e4), (1e-3, 5e3), (1e-2, 1e5)])
def test_regulator_against_the_hamiltonian(model, travel, force):
    """Gain and poles are those of the stable subspace of the Hamiltonian."""
    q, r, n = weights(model, travel, force)
    gain, poles = stable_subspace(model.a, model.b, q, r, n)
    found = regulator_gain(model, travel, force)
    assert_allclose(found, gain, rtol=1e-6)
    assert_allclose(np.sort_complex(np.linalg.eigvals(model.a - model.b @ found)), poles, rtol=1e-6)
    assert poles.real.max() < 0.0


@pytest.mark.analytic
def test_filter_against_the_hamiltonian(model):
    """The Kalman filter is the regulator of the transposed system; its poles are stable."""
    noise = np.diag([ROAD_NOISE, ENGINE_NOISE])
    q, n = model.g @ noise @ model.g.T, model.g @ noise @ model.f.T
    r = model.f @ noise @ model.f.T + SENSOR_NOISE * np.eye(2)
    gain, poles = stable_subspace(model.a.T, model.c.T, q, r, n)
    found = kalman_gain(model)
    assert_allclose(found, gain.T, rtol=1e-6, atol=1e-9 * np.abs(gain).max())
    assert_allclose(np.sort_complex(np.linalg.eigvals(model.a - found @ model.c)), poles, rtol=1e-6)
    assert poles.real.max() < 0.0


@pytest.mark.property
@pytest.mark.parametrize("period", [1e-4, 1e-3, 0.1])
def test_discrete_filter_is_stable(model, period):
    """At every rate all poles lie inside the unit circle, where the continuous ones map to."""
    step = discrete_filter(model, kalman_gain(model), period)[:, :4]
    expected = np.exp(period * np.linalg.eigvals(model.a - kalman_gain(model) @ model.c))
    assert_allclose(np.sort(np.abs(np.linalg.eigvals(step))), np.sort(np.abs(expected)), rtol=1e-6)
    assert np.abs(np.linalg.eigvals(step)).max() < 1.0


@pytest.mark.analytic
@pytest.mark.parametrize("source", [0, 1])
def test_filter_finds_the_motion_of_the_model(sample, source):
    """On samples of the model itself, shaken by road or engine at soft current, deflection and rate are found.

    The estimator's washouts lead by 2 * 0.2 / 7 rad, and the filter, which does not know the forces, forgets what it
    integrates with corners at 0.5 and 2.5 Hz: some 2.5 / 7 of the deflection, less of its rate.
    """
    law = ClippedOptimal(PERIOD, corner=0.2, firm_current=0.8)
    model, w = mount_model(0.8, PAIR), 2.0 * np.pi * 7.0
    response = np.linalg.solve(1j * w * np.eye(4) - model.a, model.g[:, [source]] * 3000.0)[:, 0]
    measured = model.c @ response + model.f[:, source] * 3000.0
    errors, sizes = [], []
    for k in range(10_000):
        turn = np.exp(1j * w * PERIOD * (k + 0.5))
        powertrain, hull = (float(value) for value in (measured * turn).imag)
        law.update(sample(PERIOD * (k + 1), hull, powertrain))
        true = (response * np.exp(1j * w * PERIOD * (k + 1))).imag
        if k > 8_000:
            errors.append(np.array(law._state)[[1, 3]] - true[[1, 3]])
            sizes.append(true[[1, 3]])
    rms = np.sqrt(np.mean(np.square(errors), axis=0) / np.mean(np.square(sizes), axis=0))
    assert rms[0] < 0.4 and rms[1] < 0.2, rms
    assert np.abs(sizes).max() > 1e-5


@pytest.mark.property
def test_gain_knows_no_last_bits(model):
    """A change of the design in its eleventh digit, as another LAPACK may make, does not reach the law."""
    law = ClippedOptimal(PERIOD)
    assert law._gain == tuple(float(f"{value:.9g}") for value in regulator_gain(model, TRAVEL, FORCE)[0])
