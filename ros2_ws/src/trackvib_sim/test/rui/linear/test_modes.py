"""Natural frequencies and undamped modes: closed forms, printed example, an independent linearisation."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import eigh
from trackvib_sim.rui.linear.model import LinearModel
from trackvib_sim.rui.linear.modes import natural_frequencies
from trackvib_sim.rui.linear.natural_modes import mode_shapes, natural_values, number_of_freedoms
from trackvib_sim.rui.linear.sweep import count_below, tips_to_root
from trackvib_sim.rui.linear.tree import linearise, move
from trackvib_sim.rui.reference.elements import cross_matrix
from trackvib_sim.rui.state import no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

from .linear_models import pendulum, planar_vehicle, random_model, settled_vehicle
from .linear_reference import Dense

SAME = 1e-9  # relative: two routes in double precision, each with condition numbers up to 1e6
SEEDS = range(20)
ROTATION = slice(3, 6)
UNDAMPED = [
    0.9892, 1.1852, 1.4414, 1.4871, 1.9092, 2.4702, 6.6142, 8.9783, 9.4752, 13.7333, 14.7850, 14.7859, 14.8022, 14.8035,
    14.8193, 14.8208, 14.8363, 14.8383, 14.8537, 14.8561, 14.8776, 14.9250,
]  # fmt: skip
WITHOUT_LOADS = [1.0343, 1.2163, 1.4829, 1.4874, 1.9409, 2.5481, 6.6141, 8.9762, 9.4790, 13.7345, 14.8844]


@pytest.fixture(scope="module")
def vehicle():
    """The illustrative vehicle of 41 bodies in equilibrium."""
    return settled_vehicle()


@pytest.mark.analytic
@pytest.mark.parametrize("angle", [0.0, 0.7, 2.5, np.pi])
def test_pendulum(angle):
    """omega^2 = m g l cos(angle) / (J + m l^2): positive hanging, negative (falling over) above the hinge."""
    expected = 2.0 * 9.81 * 0.5 * np.cos(angle) / (0.1 + 2.0 * 0.5**2)
    assert_allclose(natural_values(linearise(pendulum(angle=angle))), [expected], rtol=SAME)


@pytest.mark.analytic
def test_equal_pendulums_give_one_frequency_with_independent_modes():
    """Four equal pendulums on a held root: a fourfold frequency, four orthonormal modes, though the root rests."""
    shapes = mode_shapes(linearise(pendulum(4)))
    assert_allclose(shapes.omega_squared, np.full(4, 2.0 * 9.81 * 0.5 / 0.6), rtol=SAME)
    assert_allclose(0.6 * shapes.coordinate[1:].T @ shapes.coordinate[1:], np.eye(4), atol=1e-9)


@pytest.mark.golden
def test_planar_vehicle():
    """Hull and powertrain in the plane, to all digits given; the other four motions are free."""
    found = natural_frequencies(planar_vehicle(), 100.0)
    assert_allclose(found[:-3], 0.0, atol=1e-3)
    assert_allclose(found[-3:], [1.3347723895, 1.6245852422, 13.6182585716], rtol=0.0, atol=0.6e-10)


@pytest.mark.golden
def test_illustrative_vehicle_undamped(vehicle):
    """24 free motions and 22 frequencies to the digits given."""
    found = natural_frequencies(vehicle, 40.0)
    assert np.count_nonzero(np.abs(found) < 1e-3) == 24
    assert_allclose(found[24:], UNDAMPED, rtol=0.0, atol=0.51e-4)


@pytest.mark.golden
def test_illustrative_vehicle_without_static_loads(vehicle):
    """In the same pose without weight and static forces the low frequencies are up to 4.6 % higher."""
    unloaded = replace(
        vehicle,
        gravity=(0.0, 0.0, 0.0),
        springs=tuple(replace(spring, force=np.zeros(3)) for spring in vehicle.springs),
        mounts=tuple(replace(mount, force=np.zeros(3)) for mount in vehicle.mounts),
        loads=no_loads(vehicle.bodies),
    )
    found = natural_frequencies(unloaded, 40.0)
    assert_allclose(found[24 : 24 + len(WITHOUT_LOADS)], WITHOUT_LOADS, rtol=0.0, atol=0.51e-4)


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", SEEDS)
def test_natural_values_against_dense_matrices(seed):
    """Sweeps find the eigenvalues of (K, M) of the independent linearisation."""
    model = random_model(seed)
    assert_allclose(natural_values(linearise(model)), Dense(model).eigenvalues(), rtol=1e-8)
    assert_allclose(np.sort(mode_shapes(linearise(model)).omega_squared), Dense(model).eigenvalues(), rtol=SAME)


@pytest.mark.cross_engine
def test_illustrative_vehicle_against_dense_matrices(vehicle):
    """All 46 eigenvalues of the vehicle, 24 of them zero."""
    dense = Dense(vehicle)
    expected = eigh(dense.K, dense.M, eigvals_only=True)
    found = mode_shapes(linearise(vehicle)).omega_squared
    assert_allclose(found[24:], expected[24:], rtol=SAME)
    assert_allclose(found[:24], 0.0, atol=1e-6)


@pytest.mark.cross_engine
@pytest.mark.parametrize("seed", SEEDS)
def test_held_trees_against_pinocchio(seed):
    """Revolute and prismatic hinges on a held root: mass matrix and gravity's stiffness from Pinocchio."""
    model, engine, data = _held_tree(seed)
    q = model.state.hinge[1:]
    stiffness = pin.computeGeneralizedGravityDerivatives(engine, data, q) + np.diag(model.stiffness[1:])
    mass = pin.crba(engine, data, q)
    expected = eigh(stiffness, np.triu(mass) + np.triu(mass, 1).T, eigvals_only=True)
    assert_allclose(mode_shapes(linearise(model)).omega_squared, expected, rtol=SAME)


def _held_tree(seed):
    rng = np.random.default_rng(seed)
    n, path = 8, [0]
    engine, table = pin.Model(), [Body(0, "root", 1.0, (0, 0, 0), np.eye(3))]
    for row in range(1, n):
        path = path[: rng.integers(len(path)) + 1]  # the engine wants every branch in one piece
        parent, prismatic = path[-1], rng.uniform() < 0.4
        path.append(row)
        axis, place, centre = rng.normal(size=3), rng.normal(0, 0.5, 3), rng.normal(0, 0.2, 3)
        axis /= np.linalg.norm(axis)
        inertia, mass = np.diag(rng.uniform(0.5, 0.9, 3)), rng.uniform(1.0, 20.0)
        hinge = Hinge(row, "prismatic" if prismatic else "revolute", f"b{parent}" if parent else "root", place, axis)
        table.append(Body(row, f"b{row}", mass, centre, inertia, hinge))
        joint = pin.JointModelPrismaticUnaligned(axis) if prismatic else pin.JointModelRevoluteUnaligned(axis)
        engine.addJoint(parent, joint, pin.SE3(np.eye(3), place), f"b{row}")
        engine.appendBodyToJoint(row, pin.Inertia(mass, centre, inertia), pin.SE3.Identity())
    data = engine.createData()
    state = rest_state(table)._replace(hinge=np.r_[0.0, rng.normal(0, 0.6, n - 1)])
    loads = no_loads(table)
    loads.torque[1:] = pin.computeGeneralizedGravity(engine, data, state.hinge[1:])
    stiffness = np.r_[0.0, rng.uniform(500, 3e3, n - 1)]
    return LinearModel(table, state, stiffness=stiffness, loads=loads, fixed_root=True), engine, data


@pytest.mark.property
@pytest.mark.parametrize("seed", range(8))
def test_count_over_a_scan(seed):
    """The count is the number of dense eigenvalues below, at every one of 300 values from negative to the highest."""
    model = random_model(seed)
    expected = Dense(model).eigenvalues()
    values = np.concatenate((np.linspace(-1e3, 1e3, 100), np.geomspace(1.0, 2.0 * expected[-1], 200)))
    below = np.count_nonzero(expected[None] < values[:, None], axis=1)
    assert np.array_equal(count_below(linearise(model), values), below)
    assert below[-1] == number_of_freedoms(linearise(model))


@pytest.mark.property
@pytest.mark.parametrize("seed", SEEDS)
def test_symmetry_of_cuts(seed):
    """S + [m0]x / 2 is symmetric on the child's side of every cut, S of the root itself."""
    tree = linearise(random_model(seed))
    sweep = tips_to_root(tree, np.array([-300.0]))
    for row in range(len(tree.parent)):
        S = sweep.body[row][0].copy()
        scale = np.abs(S).max()
        if row:
            m0 = (move(-tree.offset[row]).T @ tree.static[row])[ROTATION]
            S[ROTATION, ROTATION] += 0.5 * cross_matrix(m0)
        assert_allclose(S, S.T, atol=1e-11 * scale)


@pytest.mark.property
def test_modes_are_orthogonal(vehicle):
    """All 46 modes of the vehicle, some of which have frequencies 5e-5 apart: generalised masses 1, nothing between."""
    dense, shapes = Dense(vehicle), mode_shapes(linearise(vehicle))
    q = np.array([dense.coordinates(shapes.x[:, :, k], shapes.coordinate[:, k]) for k in range(46)]).T
    assert_allclose(q.T @ dense.M @ q, np.eye(46), atol=SAME)


@pytest.mark.property
@pytest.mark.parametrize("difference", [0.0, 1e-7, 2e-5, 1e-4])
def test_nearly_equal_frequencies_have_separate_modes(difference):
    """Two pendulums that differ by a little mass: whatever the difference, two orthogonal modes."""
    model = pendulum(2)
    bodies = [*model.bodies[:2], replace(model.bodies[2], mass=2.0 * (1.0 + difference))]
    shapes = mode_shapes(linearise(replace(model, bodies=bodies)))
    inertia = 0.1 + 0.5 * np.array([1.0, 1.0 + difference])
    assert_allclose(shapes.coordinate[1:].T @ np.diag(inertia) @ shapes.coordinate[1:], np.eye(2), atol=1e-9)
    expected = 2.0 * 9.81 * 0.5 * np.array([1.0, 1.0 + difference]) / inertia
    assert_allclose(shapes.omega_squared, np.sort(expected), rtol=SAME)
    if difference > 1e-6:
        assert_allclose(np.sort(np.abs(shapes.coordinate[1:]), axis=None)[:2], 0.0, atol=1e-9)
