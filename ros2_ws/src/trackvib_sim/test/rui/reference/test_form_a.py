"""The overall transfer equation, Forms A and X: printed example, blocks and paths by number, an independent engine."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.form_a import overall_transfer
from trackvib_sim.rui.reference.form_x import form_x_transfer
from trackvib_sim.rui.state import TreeState, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

PRINTED = 0.6e-10  # half of the last printed digit, a little more for the rounding of the comparison
ENGINES = 1e-9  # relative to the largest; rounding of products along up to 40 bodies leaves some 1e-12


@pytest.fixture(scope="module")
def e1():
    """Example E1 of docs/method.md, y axis up: table, state, loads and gravity."""
    bodies = [
        Body(1, "base", 10.0, (0.1, 0.2, 0), np.diag([1.0, 2.0, 3.0])),
        Body(2, "one", 2.0, (0.3, 0, 0), np.diag([0.02, 0.06, 0.07]),
             Hinge(12, "revolute", "base", (1, 0, 0), (0, 0, 1))),
        Body(3, "two", 1.0, (0, 0, 0.2), np.diag([0.03, 0.03, 0.01]),
             Hinge(13, "revolute", "one", (0.6, 0, 0), (0, 1, 0))),
        Body(4, "three", 3.0, (0.2, 0.1, 0), np.diag([0.05, 0.04, 0.03]),
             Hinge(14, "prismatic", "base", (0, 0.5, 0), (1, 0, 0))),
    ]  # fmt: skip
    state = TreeState(
        np.zeros((1, 3)),
        np.array([[np.cos(0.15), 0.0, 0.0, np.sin(0.15)]]),
        np.array([[1.0, 0.0, 0.5]]),
        np.array([[0.1, -0.2, 0.3]]),
        np.array([0.0, 0.4, -0.5, 0.1]),
        np.array([0.0, 1.0, -2.0, 0.5]),
    )
    loads = no_loads(bodies)
    loads.torque[1:] = 0.5, -0.3, 2.0
    # the load of body "two" is given at its centre of mass
    to_centre = Rotation.from_euler("ZY", (0.7, -0.5)).apply((0.0, 0.0, 0.2))
    loads.force[2] = 1.0, 2.0, 3.0
    loads.moment[2] = (0.1, 0.0, -0.2) + np.cross(to_centre, loads.force[2])
    return bodies, state, loads, (0.0, -9.81, 0.0)


@pytest.mark.golden
def test_e1_accelerations(e1, form):
    """E1's accelerations of base and hinges are the printed ones."""
    result = form(*e1)
    assert_allclose(result.linear[0], (0.1454802033, -9.8343102641, 0.0127414976), rtol=0, atol=PRINTED)
    assert_allclose(result.angular[0], (-0.0419304198, -0.7000648856, 0.2862313768), rtol=0, atol=PRINTED)
    assert_allclose(result.hinge, (0.0, 1.4746125642, 5.1028241439, 0.7530312306), rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_hinge_wrenches(e1, form):
    """E1's wrenches of child on parent, about the point on the parent, are the printed ones."""
    printed = (
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (2.4098373671, 0.9764759234, 0.9055524173, 0.3492028088, -0.6175053942, -0.5),
        (0.7891582777, 1.5192129431, 2.4985059087, -0.3061239052, 0.1343931696, -0.3306731947),
        (-1.6779994003, -1.3432108371, -0.7370558661, -0.1322894758, 0.2177873672, -0.0448679908),
    )
    assert_allclose(form(*e1).wrench, printed, rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_known_column(e1):
    """Column 13 of the middle body holds the printed moment and force rows (six decimals)."""
    column = overall_transfer(*e1).U(2)[:, 12]
    assert_allclose(column[6:9], (-0.003539, 0.008588, -4.500268), rtol=0, atol=0.6e-6)
    assert_allclose(column[9:12], (-0.801637, -20.28628, -0.04084), rtol=0, atol=6e-6)


@pytest.mark.golden
def test_e1_sizes(e1):
    """E1 leaves 15 unknowns in Form A (21 with the base's own), 12 in Form X."""
    transfer = overall_transfer(*e1)
    assert transfer.with_boundary_conditions()[0].shape == (15, 15)
    assert transfer.with_boundary_conditions(keep_root=True)[0].shape == (21, 21)
    assert form_x_transfer(transfer).matrix.shape == (12, 12)


@pytest.mark.analytic
def test_look_ahead_elimination_fails_in_e1(e1):
    """Eliminating a hinge by the next one's axis divides by zero where consecutive axes are perpendicular."""
    transfer = overall_transfer(*e1)
    row = transfer.hinge[1].E @ transfer.U(2)  # the hinge after body "one", in terms of what enters the body
    assert abs(row @ transfer.hinge[2].b) < 1e-15


@pytest.fixture(scope="module")
def tracked_vehicle():
    """A function `tracked_vehicle(root)`: bodies and hinges with the numbers of [Tao2025], root "recoil" or "hull"."""

    def build(root):
        random = np.random.default_rng(1)
        gun = [(1, "recoil"), (3, "mount"), (5, "turret"), (7, "hull")]
        chain = [(2, "prismatic", (1, 0, 0)), (4, "revolute", (0, 1, 0)), (6, "revolute", (0, 0, 1))]
        if root == "hull":
            gun.reverse()
            chain.reverse()
        hinges = [None] + [
            Hinge(number, kind, gun[k][1], 0.5 * random.normal(size=3), axis)
            for k, (number, kind, axis) in enumerate(chain)
        ]
        parts = [(*body, hinge) for body, hinge in zip(gun, hinges, strict=True)]
        branches = [(10, 64, "hull"), *((11 + k, 34 + k, "hull") for k in range(6)),
                    *((17 + k, 65 + k, "hull") for k in range(5)), (22, 76, "hull"),
                    *((23 + k, 40 + k, "hull") for k in range(6)), *((29 + k, 77 + k, "hull") for k in range(5)),
                    (8, 9, "hull"), *((46 + k, 58 + k, str(34 + k)) for k in range(6)),
                    *((52 + k, 70 + k, str(40 + k)) for k in range(6))]  # fmt: skip
        for number, body, parent in branches:
            parts.append((body, str(body), Hinge(number, "revolute", parent, random.normal(size=3), (0, 1, 0))))
        bodies = [Body(number, name, 100.0, 0.1 * random.normal(size=3), np.diag([8.0, 9.0, 10.0]), hinge)
                  for number, name, hinge in parts]  # fmt: skip
        state, loads = rest_state(bodies), no_loads(bodies)
        state.angular_velocity[:], loads.torque[:] = random.normal(size=3), random.normal(size=len(bodies))
        state.hinge[:], state.hinge_rate[:] = 0.3 * random.normal(size=(2, len(bodies)))
        return bodies, state, loads

    return build


@pytest.mark.literature
def test_paths_of_the_paper(tracked_vehicle):
    """With the recoil part as root, the products along the paths are those of [Tao2025]."""
    transfer = overall_transfer(*tracked_vehicle("recoil"))
    U = transfer.U
    assert transfer.path(1, 64) == [1, 2, 3, 4, 5, 6, 7, 10, 64]
    assert transfer.path(1, 58) == [1, 2, 3, 4, 5, 6, 7, 11, 34, 46, 58]
    T = U(1) @ U(2) @ U(3) @ U(4) @ U(5) @ U(6) @ U(7) @ U(10) @ U(64)
    assert_allclose(transfer.T(1, 64), T, rtol=1e-12)
    T = U(1) @ U(2) @ U(3) @ U(4) @ U(5) @ U(6) @ U(7, hinge=8) @ U(8) @ U(9)
    assert_allclose(transfer.T(1, 9), T, rtol=1e-12)


@pytest.mark.literature
def test_number_of_ends_of_the_paper(tracked_vehicle):
    """26 free ends of six unknowns [Tao2025]: 156 with those of the root; Form A has 40 hinge accelerations more."""
    transfer = overall_transfer(*tracked_vehicle("recoil"))
    assert len(transfer.tips) == 25
    assert form_x_transfer(transfer).matrix.shape == (150, 150)
    assert transfer.with_boundary_conditions(keep_root=True)[0].shape == (196, 196)
    assert transfer.with_boundary_conditions()[0].shape == (190, 190)
    transfer = overall_transfer(*tracked_vehicle("hull"))
    assert form_x_transfer(transfer).matrix.shape == (156, 156)
    assert transfer.with_boundary_conditions()[0].shape == (196, 196)


@pytest.mark.property
def test_blocks_are_products_along_paths(tracked_vehicle):
    """Every main block of U_all is the product T, every geometric one the product G."""
    transfer = overall_transfer(*tracked_vehicle("recoil"))
    tips = [transfer.bodies[row].number for row in transfer.tips]
    assert_allclose(transfer.block(("main", 1), ("root", 1)), -np.eye(13))
    for tip in tips:
        assert_allclose(transfer.block(("main", 1), ("tip", tip)), transfer.T(1, tip), rtol=1e-10, atol=1e-9)
        for kind, hinge in transfer.equations:
            if kind == "geometry":
                block = transfer.block((kind, hinge), ("tip", tip))
                assert_allclose(block, transfer.G(hinge, tip), rtol=1e-10, atol=1e-9)
    assert np.any(transfer.G(11, 64)) and np.any(transfer.G(11, 58)) and not np.any(transfer.G(11, 59))


@pytest.mark.property
def test_solution_fulfils_the_overall_equation(tracked_vehicle):
    """U_all z_all = 0 for the z_all of both forms, and z_all is the same."""
    transfer = overall_transfer(*tracked_vehicle("recoil"))
    z_all = transfer.solve()
    scale = np.abs(transfer.U_all) @ np.abs(z_all)
    assert np.all(np.abs(transfer.U_all @ z_all) <= 1e-12 * np.maximum(scale, 1.0))
    assert_allclose(form_x_transfer(transfer).solve(), z_all, rtol=0, atol=1e-9 * np.max(np.abs(z_all)))


@pytest.mark.cross_engine
@pytest.mark.parametrize("root", ["recoil", "hull"])
def test_vehicle_against_pinocchio(tracked_vehicle, pinocchio, relative, form, root):
    """The vehicle's tree, from either root."""
    case = tracked_vehicle(root)
    for value, reference in zip(form(*case), pinocchio(*case), strict=True):
        assert relative(value, reference) < ENGINES


@pytest.mark.slow(reason="solves hundreds of trees in plain matrices")
@pytest.mark.cross_engine
@pytest.mark.parametrize("hundred", [0, 1, 2])
def test_random_trees_against_pinocchio(random_table, pinocchio, relative, form, hundred):
    """300 random trees of 2 to 40 bodies: accelerations against ABA, hinge wrenches against RNEA."""
    for seed in range(100 * hundred, 100 * hundred + 100):
        case = random_table(seed, 2 + seed % 39)
        value, reference = form(*case), pinocchio(*case)
        size = np.max(np.abs(reference.hinge))
        assert np.max(np.abs(value.hinge - reference.hinge)) < ENGINES * size, seed
        assert relative(value.linear, reference.linear) < ENGINES, seed
        assert relative(value.angular, reference.angular) < ENGINES, seed
        assert relative(value.wrench, reference.wrench) < ENGINES, seed


@pytest.mark.property
def test_numbers_that_name_nothing_are_refused(e1):
    """Look-ups by wrong numbers say what is wrong; so does a table whose numbers are not distinct."""
    transfer = overall_transfer(*e1)
    with pytest.raises(ValueError, match="99"):
        transfer.U(99)
    with pytest.raises(ValueError, match="body 2 has children"):
        transfer.T(1, 2)
    with pytest.raises(ValueError, match="body 4 is not on the way"):
        transfer.path(4, 3)
    with pytest.raises(ValueError, match="first input"):
        transfer.G(12, 3)
    bodies, *rest = e1
    twice = [*bodies[:3], Body(3, "three", 1.0, (0, 0, 0), np.eye(3), bodies[3].hinge)]
    with pytest.raises(ValueError, match="differ"):
        overall_transfer(twice, *rest)
