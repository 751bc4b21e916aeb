"""Frequency response: closed forms, reciprocity, limits, the dense matrices of an independent linearisation."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.linear.frequency_response import (
    At,
    AtHinge,
    GroundMotion,
    MountForce,
    frequency_response,
    transmissibility,
)
from trackvib_sim.rui.linear.model import GroundSpring, LinearModel
from trackvib_sim.rui.state import rest_state
from trackvib_sim.rui.table import Body, Hinge

from .linear_models import random_model, settled_vehicle
from .linear_reference import Dense

SAME = 1e-9  # relative to the largest response
SEEDS = range(20)
FREQUENCIES = np.geomspace(0.05, 200.0, 25)


@pytest.fixture(scope="module")
def vehicle():
    """The illustrative vehicle of 41 bodies in equilibrium."""
    return settled_vehicle()


@pytest.fixture(scope="module")
def block():
    """A free block of 3 kg on one spring and damper under its centre, k = 1200 N/m, c = 24 N s/m, no gravity."""
    table = [Body(0, "block", 3.0, (0, 0, 0), np.diag([0.1, 0.2, 0.25]))]
    spring = GroundSpring("block", (0, 0, 0), 1200.0 * np.eye(3), 24.0 * np.eye(3))
    return LinearModel(table, rest_state(table), (0, 0, 0), springs=(spring,))


def points(model):
    """Two points in skew directions on the first and last body, and a rotation of the last."""
    last = model.bodies[-1].name
    return [
        At("b0", (0.1, 0.2, -0.3), (1, -2, 3)),
        At(last, (0.1, 0.2, 0.3), (1, 2, 3)),
        At(last, (0, 0, 0), (0.5, -1, 1), turning=True),
    ]


def dense_points(dense, places):
    """Generalised forces (size, len(places)) of the same points."""
    return np.array([dense.direction(at.body, at.point, at.direction, at.turning) for at in places]).T


@pytest.mark.analytic
def test_oscillator(block):
    """Receptance 1 / (k - m w^2 + i w c), mobility and accelerance with i w each, lag: negative phase."""
    w = 2.0 * np.pi * FREQUENCIES
    expected = 1.0 / (1200.0 - 3.0 * w**2 + 24j * w)
    for derivative in range(3):
        found = frequency_response(block, FREQUENCIES, [At("block")], [At("block")], derivative)[:, 0, 0]
        assert_allclose(found, expected * (1j * w) ** derivative, rtol=SAME)
    assert np.all(expected.imag < 0.0)


@pytest.mark.analytic
def test_ground_motion(block):
    """Displacement by that of the ground: (k + i w c) / (k - m w^2 + i w c)."""
    w = 2.0 * np.pi * FREQUENCIES
    expected = (1200.0 + 24j * w) / (1200.0 - 3.0 * w**2 + 24j * w)
    found = transmissibility(block, FREQUENCIES, GroundMotion((0,)), At("block"), None)
    assert_allclose(found, expected, rtol=SAME)


@pytest.mark.analytic
def test_high_frequency_limit_of_a_point(block):
    """Far above all springs a point's accelerance is that of the free body: |d|^2 / m + (r x d) J^-1 (r x d)."""
    r, d = np.array([0.3, -0.2, 0.4]), np.array([1.0, 0.5, -2.0])
    arm = np.cross(r, d)
    expected = d @ d / 3.0 + arm @ np.linalg.solve(np.diag([0.1, 0.2, 0.25]), arm)
    found = frequency_response(block, [1e7], [At("block", r, d)], [At("block", r, d)], derivative=2)[0, 0, 0]
    assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.analytic
def test_two_masses_in_line():
    """A mass on a prismatic hinge of a held one: receptances of the driven and the other mass by the 2 x 2 matrix."""
    table = [
        Body(0, "base", 5.0, (0, 0, 0), np.eye(3)),
        Body(1, "slider", 2.0, (0, 0, 0), np.eye(3), Hinge(1, "prismatic", "base", (0, 0, 0), (0, 0, 1))),
    ]
    spring = GroundSpring("base", (0, 0, 0), 9e3 * np.eye(3), 30.0 * np.eye(3))
    model = LinearModel(table, rest_state(table), (0, 0, 0), [0, 4e3], [0, 11.0], springs=(spring,))
    found = frequency_response(model, FREQUENCIES, [At("base"), At("slider")], [At("base"), At("slider")])
    for frequency, matrix in zip(FREQUENCIES, found, strict=True):
        s = 2j * np.pi * frequency
        k1, k2 = 9e3 + 30.0 * s, 4e3 + 11.0 * s
        assert_allclose(matrix, np.linalg.inv([[5 * s**2 + k1 + k2, -k2], [-k2, 2 * s**2 + k2]]), rtol=SAME)


@pytest.mark.cross_engine
@pytest.mark.parametrize("even", [True, False], ids=["with potential", "uneven bushings"])
@pytest.mark.parametrize("seed", SEEDS)
def test_against_dense_matrices(seed, even):
    """(s^2 M + s C + K)^-1 between forces, moments, points and rotations of two bodies."""
    model = random_model(seed, even=even)
    dense, places = Dense(model), points(model)
    V = dense_points(dense, places)
    found = frequency_response(model, FREQUENCIES, places, places)
    for frequency, matrix in zip(FREQUENCIES, found, strict=True):
        expected = V.T @ np.linalg.solve(dense.stiffness_at(2j * np.pi * frequency), V)
        assert_allclose(matrix, expected, rtol=0.0, atol=SAME * np.abs(expected).max())


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", SEEDS)
def test_hinges_mounts_and_ground_against_dense_matrices(seed):
    """Torque on a hinge, force in a mount, motion of the ground: same generalised forces in the dense equations."""
    model = random_model(seed, kinds=("revolute", "prismatic"))
    dense = Dense(model)
    row = dense.hinges[0] if dense.hinges else 0
    inputs, V = [GroundMotion((0, 1), (1, 2, 3))], np.zeros((3, dense.size, 1))
    for spring in model.springs[:2]:
        linear = np.array([dense.direction(spring.body, spring.point, unit) for unit in np.eye(3)]).T
        turning = np.array([dense.direction(spring.body, spring.point, unit, True) for unit in np.eye(3)]).T
        both = np.hstack((linear, turning))[:, : len(spring.stiffness)]
        V[0, :, 0] += both @ spring.stiffness[:, :3] @ (1, 2, 3)
        V[1, :, 0] += both @ spring.damping[:, :3] @ (1, 2, 3)
    if row:
        inputs.append(AtHinge(model.bodies[row].name))
        unit = np.zeros((3, dense.size, 1))
        unit[0, 6 + dense.hinges.index(row)] = 1.0
        V = np.concatenate((V, unit), axis=2)
    for k, mount in enumerate(model.mounts):
        child, parent = dense.rows[mount.body], model.bodies[dense.rows[mount.body]].hinge.parent
        origin, rotation, _ = dense.home
        force = rotation[dense.rows[parent]] @ (1, 2, -1)
        at = origin[child] + rotation[child] @ mount.point - origin[dense.rows[parent]]
        pair = np.zeros((3, dense.size, 1))
        pair[0, :, 0] = dense.direction(mount.body, mount.point, force)
        pair[0, :, 0] -= dense.direction(parent, rotation[dense.rows[parent]].T @ at, force)
        inputs.append(MountForce(k, (1, 2, -1)))
        V = np.concatenate((V, pair), axis=2)
    outputs = points(model)
    found = frequency_response(model, FREQUENCIES, inputs, outputs)
    for frequency, matrix in zip(FREQUENCIES, found, strict=True):
        s = 2j * np.pi * frequency
        expected = dense_points(dense, outputs).T @ np.linalg.solve(dense.stiffness_at(s), V[0] + s * V[1])
        assert_allclose(matrix, expected, rtol=0.0, atol=SAME * np.abs(expected).max())


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", range(8))
def test_high_frequency_limit_of_trees(seed):
    """Far above all springs the accelerance goes to that of the mass matrix alone."""
    model = random_model(seed)
    dense, places = Dense(model), points(model)
    V = dense_points(dense, places)
    expected = V.T @ np.linalg.solve(dense.M, V)
    found = frequency_response(model, [1e6], places, places, derivative=2)[0]
    assert_allclose(found, expected, rtol=0.0, atol=1e-3 * np.abs(expected).max())
    nearer = frequency_response(model, [1e8], places, places, derivative=2)[0]
    assert_allclose(nearer, expected, rtol=0.0, atol=1e-5 * np.abs(expected).max())


@pytest.mark.property
def test_reciprocity(vehicle):
    """What a force at one place does at another, it does back: also with gravity, mounts and 41 bodies."""
    places = [
        At("powertrain", (2.0, -0.15, 0.0), (0, 1, 0)),
        At("hull", (-3.0, 1.05, 0.3), (0.3, 1, 0)),
        At("wheel left 3", (0, 0, 0), (1, 1, 1)),
        At("recoil part", (1.2, 0, 0), (0, 0, 1)),
        AtHinge("turret"),
    ]
    found = frequency_response(vehicle, FREQUENCIES, places, places)
    assert_allclose(found, np.swapaxes(found, 1, 2), rtol=0.0, atol=1e-12 * np.abs(found).max())


@pytest.mark.property
def test_transmissibility_is_the_ratio_of_two_responses(vehicle):
    """From the powertrain's mount to its point on the hull under a force at the powertrain."""
    drive, up = At("powertrain", (1.0, 0.1, 0.0), (0, 1, 0)), (0, 1, 0)
    hull, engine = At("hull", (-1.0, 0.9, 0.0), up), At("powertrain", (2.0, -0.15, 0.0), up)
    both = frequency_response(vehicle, FREQUENCIES, [drive], [hull, engine], derivative=2)[:, :, 0]
    found = transmissibility(vehicle, FREQUENCIES, drive, hull, engine)
    assert_allclose(found, both[:, 0] / both[:, 1], rtol=1e-12)


@pytest.mark.property
def test_all_ground_lifted_lifts_the_vehicle(vehicle):
    """Under all wheels together and slowly, every body follows the ground."""
    ground = GroundMotion(tuple(range(len(vehicle.springs))), (0, 1, 0))
    outputs = [At(name, (0, 0, 0), (0, 1, 0)) for name in ("hull", "turret", "wheel right 6", "powertrain")]
    found = frequency_response(vehicle, [1e-3], [ground], outputs)[0, :, 0]
    assert_allclose(found, 1.0, atol=1e-5)


@pytest.mark.property
def test_many_frequencies_are_the_same_as_one(block):
    """Frequencies are worked off in groups; the borders do not show."""
    frequencies = np.linspace(1.0, 30.0, 600)
    all_at_once = frequency_response(block, frequencies, [At("block")], [At("block")])
    for k in (0, 255, 256, 511, 512, 599):
        one = frequency_response(block, frequencies[k : k + 1], [At("block")], [At("block")])
        assert_allclose(all_at_once[k], one[0], rtol=1e-13)


@pytest.mark.property
def test_what_is_refused(block):
    """Frequency zero, an unknown body, a ground motion as output, a missing reference."""
    for frequencies in ([0.0], [1.0, -2.0], 3.0):
        with pytest.raises(ValueError, match="must be a list of values > 0 Hz"):
            frequency_response(block, frequencies, [At("block")], [At("block")])
    with pytest.raises(ValueError, match="no body 'hull'; known are block"):
        frequency_response(block, [1.0], [At("hull")], [At("block")])
    with pytest.raises(ValueError, match="is no output"):
        frequency_response(block, [1.0], [At("block")], [GroundMotion((0,))])
    with pytest.raises(ValueError, match="must be driven by a GroundMotion"):
        transmissibility(block, [1.0], At("block"), At("block"), None)
