"""The two sweeps on small trees: the example of the method's statement, and random trees against dense algebra."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.form_a import form_a
from trackvib_sim.rui.reference.placement import place_bodies
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import TreeState, no_loads, rest_state
from trackvib_sim.rui.sweeps.articulated import CutOffset, apply_wrench
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.response import hinge_wrench, point_specific_force
from trackvib_sim.rui.sweeps.tree import build_tree, to_lanes
from trackvib_sim.rui.table import Body, Hinge

from ..cases import EVERY_KIND, NO_GRAVITY, ROUNDING, G, dense_mass, differ, generalised, in_rows, seeds, shapes

PRINTED = 0.6e-10  # half of the last printed digit, a little more for the rounding of the comparison


@pytest.fixture(scope="module")
def e1():
    """Example E1 of the method's statement (section 12): table, state, loads, what the sweeps find, gravity."""
    bodies = [
        Body(0, "base", 10.0, (0.1, 0.2, 0.0), np.diag([1.0, 2.0, 3.0])),
        Body(1, "one", 2.0, (0.3, 0, 0), np.diag([0.02, 0.06, 0.07]),
             Hinge(1, "revolute", "base", (1, 0, 0), (0, 0, 1))),
        Body(2, "two", 1.0, (0, 0, 0.2), np.diag([0.03, 0.03, 0.01]),
             Hinge(2, "revolute", "one", (0.6, 0, 0), (0, 1, 0))),
        Body(3, "three", 3.0, (0.2, 0.1, 0), np.diag([0.05, 0.04, 0.03]),
             Hinge(3, "prismatic", "base", (0, 0.5, 0), (1, 0, 0))),
    ]  # fmt: skip
    state = TreeState(
        position=np.zeros((1, 3)),
        attitude=np.array([[np.cos(0.15), 0.0, 0.0, np.sin(0.15)]]),
        velocity=np.array([[1.0, 0.0, 0.5]]),
        angular_velocity=np.array([[0.1, -0.2, 0.3]]),
        hinge=np.array([0.0, 0.4, -0.5, 0.1]),
        hinge_rate=np.array([0.0, 1.0, -2.0, 0.5]),
    )
    loads = no_loads(bodies)
    loads.torque[1:] = 0.5, -0.3, 2.0
    # f and l act at C of body 2, the loads are taken about its origin
    to_c = _turns(0.3, 0.4, -0.5) @ (0, 0, 0.2)
    loads.force[2] = 1.0, 2.0, 3.0
    loads.moment[2] = (0.1, 0.0, -0.2) + np.cross(to_c, loads.force[2])
    gravity = (0.0, -9.81, 0.0)
    return bodies, state, loads, accelerations(bodies, state, loads, gravity), gravity


def _turns(base, first, second):
    return Rotation.from_euler("ZY", (base + first, second)).as_matrix()


def _root_matrix(cuts, row):
    """The 6 x 6 matrix S of a free body after the sweep."""

    def square(s):
        return np.array([[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]])

    p, q, r = (
        columns(cuts, first, count)[row] for first, count in ((CutOffset.P, 6), (CutOffset.Q, 9), (CutOffset.R, 6))
    )
    q = q.reshape(3, 3)
    return np.block([[square(p), q], [q.T, square(r)]])


@pytest.mark.golden
def test_e1_accelerations(e1):
    """E1's accelerations of base and hinges are the printed ones."""
    found = e1[3]
    assert_allclose(found.linear[0], (0.1454802033, -9.8343102641, 0.0127414976), rtol=0, atol=PRINTED)
    assert_allclose(found.angular[0], (-0.0419304198, -0.7000648856, 0.2862313768), rtol=0, atol=PRINTED)
    assert_allclose(found.hinge, (0.0, 1.4746125642, 5.1028241439, 0.7530312306), rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_hinge_wrenches(e1):
    """E1's wrenches of child on parent, about the hinge point on the parent, are the printed ones."""
    printed = (
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        (2.4098373671, 0.9764759234, 0.9055524173, 0.3492028088, -0.6175053942, -0.5),
        (0.7891582777, 1.5192129431, 2.4985059087, -0.3061239052, 0.1343931696, -0.3306731947),
        (-1.6779994003, -1.3432108371, -0.7370558661, -0.1322894758, 0.2177873672, -0.0448679908),
    )
    assert_allclose(e1[3].wrench, printed, rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_root_matrix(e1, solved):
    """The eigenvalues of E1's S at the base are the printed ones."""
    bodies, state, _, _, gravity = e1
    tree = build_tree(bodies, gravity)
    _, cuts, _ = solved(tree, to_lanes(tree, state))
    values = np.linalg.eigvalsh(_root_matrix(cuts, tree.row[0]))
    printed = (
        -20.0379088647, -14.7760929103, -12.4693510107, -4.9476038683, -3.6793781402, -1.3982683858,
    )  # fmt: skip
    assert_allclose(values, printed, rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_transfer_of_body_one(e1):
    """What body 1 adds between its two hinges is column 13 of the printed U_1, which has six decimals."""
    bodies, state, _, found, _ = e1
    turn = _turns(0.3, 0.4, 0.0)
    inertia = turn @ np.diag([0.02, 0.06, 0.07]) @ turn.T
    r_oc, r_oi = turn @ (0.3, 0, 0), turn @ (0.6, 0, 0)
    r_ic, r_co, r_io = r_oc - r_oi, -r_oc, -r_oi
    om, mass = place_bodies(bodies, state).angular_velocity[1], bodies[1].mass
    a_i = found.linear[1] + np.cross(found.angular[1], r_oi) + np.cross(om, np.cross(om, r_oi))
    al, m_i, q_i = found.angular[1], found.wrench[2, 3:], found.wrench[2, :3]
    # z_O = U_1 z_I of section 3.1, solved for its last column
    moved_inertia = inertia @ al + mass * np.cross(r_co, np.cross(r_ic, al))
    m = found.wrench[1, 3:] - (mass * np.cross(r_co, a_i) - moved_inertia + m_i - np.cross(r_io, q_i))
    q = found.wrench[1, :3] - (-mass * a_i + mass * np.cross(r_ic, al) + q_i)
    assert_allclose(m, (-0.003539, 0.008588, -4.500268), rtol=0, atol=0.6e-6)
    assert_allclose(q, (-0.801637, -20.28628, -0.04084), rtol=0, atol=0.6e-5)


@pytest.mark.analytic
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2])
def test_pendulum_on_a_heavy_base(angle):
    """A pendulum on a base too heavy to move swings with -m g c sin(angle) / (J + m c^2)."""
    mass, length, inertia = 3.0, 0.8, 0.2
    bodies = [
        Body(0, "base", 1e12, (0, 0, 0), 1e12 * np.eye(3)),
        Body(1, "bob", mass, (0, 0, -length), inertia * np.eye(3),
             Hinge(1, "revolute", "base", (0, 0, 0), (0, 1, 0))),
    ]  # fmt: skip
    state, loads = rest_state(bodies), no_loads(bodies)
    state.hinge[1] = angle
    loads.force[0, 2] = 1e12 * 9.81  # holds the base
    expected = -mass * 9.81 * length * np.sin(angle) / (inertia + mass * length**2)
    # the base yields by the ratio of the masses, and its own weight cancels to rounding
    assert_allclose(accelerations(bodies, state, loads).hinge[1], expected, rtol=1e-9, atol=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("rate", [0.0, 2.0])
def test_bead_on_a_turning_rod(rate):
    """A bead that slides on a rod turning at a rate is driven outwards with rate^2 times its distance."""
    bodies = [
        Body(0, "rod", 1e12, (0, 0, 0), 1e12 * np.eye(3)),
        Body(1, "bead", 0.5, (0, 0, 0), 1e-3 * np.eye(3), Hinge(1, "prismatic", "rod", (0.1, 0, 0), (1, 0, 0))),
    ]
    state = rest_state(bodies)
    state.angular_velocity[0, 2], state.hinge[1], state.hinge_rate[1] = rate, 0.4, 0.7
    found = accelerations(bodies, state, no_loads(bodies), NO_GRAVITY)
    assert_allclose(found.hinge[1], rate**2 * 0.5, rtol=1e-12, atol=1e-12)
    # the rod takes the Coriolis force 2 m om v, against the turning, at the bead: 0.4 m from the hinge point on the rod
    assert_allclose(found.wrench[1, 1], -2.0 * 0.5 * rate * 0.7, rtol=1e-9, atol=1e-12)
    assert_allclose(found.wrench[1, 5], -2.0 * 0.5 * rate * 0.7 * 0.4, rtol=1e-9, atol=1e-12)


@pytest.mark.cross_engine
@shapes
@seeds
def test_trees_against_pinocchio(shaped_table, pinocchio, shape, seed):
    """Accelerations and hinge wrenches of trees of every shape are those of an independent engine."""
    case = shaped_table(shape, seed)
    assert differ(accelerations(*case, G), pinocchio(*case, G)) < ROUNDING


@pytest.mark.property
@shapes
@seeds
def test_sweeps_solve_the_overall_equation(shaped_table, shape, seed):
    """With hinges of every kind the sweeps find what the dense overall transfer equation (Form A) has as solution."""
    case = shaped_table(shape, 100 + seed, EVERY_KIND)
    found, dense = accelerations(*case, G), form_a(*case, G)
    rigid = [body.hinge is not None and body.hinge.kind != "elastic" for body in case[0]]
    # of the dense equation with up to 300 unknowns
    assert differ((*found[:3], found.wrench[rigid]), (*dense[:3], dense.wrench[rigid])) < 1e-9


@pytest.mark.analytic
@shapes
@seeds
def test_root_matrix_is_the_inertia_with_free_hinges(shaped_table, solved, shape, seed):
    """S of the root is symmetric, and minus the mass matrix reduced by the hinges: M_rr - M_rh M_hh^-1 M_hr."""
    bodies, state, _ = shaped_table(shape, seed, ("revolute", "prismatic", "prescribed", "locked"))
    tree = build_tree(bodies)
    _, cuts, _ = solved(tree, to_lanes(tree, state))
    s = _root_matrix(cuts, tree.row[0])
    mass = dense_mass(bodies, state).mass
    reduced = mass[:6, :6] - mass[:6, 6:] @ np.linalg.solve(mass[6:, 6:], mass[6:, :6])
    assert_allclose(s, s.T, rtol=0, atol=0)
    assert_allclose(-s, reduced, rtol=0, atol=ROUNDING * np.abs(mass).max())
    assert np.linalg.eigvalsh(s)[-1] < 0.0


@pytest.mark.analytic
@shapes
@seeds
def test_accelerations_invert_the_mass_matrix(shaped_table, shape, seed):
    """From rest, without loads but one, the accelerations are columns of the inverse mass matrix."""
    bodies, state, _ = shaped_table(shape, seed, ("revolute", "prismatic", "locked"))
    still = state._replace(
        velocity=np.zeros((1, 3)), angular_velocity=np.zeros((1, 3)), hinge_rate=np.zeros(len(bodies))
    )
    dense = dense_mass(bodies, still)
    loads_of = {"velocity": "force", "angular_velocity": "moment", "hinge_rate": "torque"}
    inverse = np.zeros_like(dense.mass)
    for k, (part, index) in enumerate(dense.freedom):
        loads = no_loads(bodies)
        getattr(loads, loads_of[part])[index] = 1.0
        inverse[:, k] = generalised(dense, accelerations(bodies, still, loads, NO_GRAVITY), bodies)
    scale = np.sqrt(np.outer(np.diag(dense.mass), np.diag(dense.mass)))
    # scaled to a unit diagonal of the mass matrix
    inverse *= scale
    assert_allclose(inverse, inverse.T, rtol=0, atol=ROUNDING * np.abs(inverse).max())
    assert_allclose(dense.mass / scale @ inverse, np.eye(len(inverse)), rtol=0, atol=ROUNDING * np.abs(inverse).max())


@pytest.mark.property
@shapes
@seeds
def test_wrenches_and_points_of_the_records(shaped_table, solved, shape, seed):
    """The records of a step give the same wrenches and accelerations of points as the plain form."""
    bodies, state, loads = shaped_table(shape, 500 + seed)
    tree, local = build_tree(bodies, G), np.array([0.3, -0.4, 0.5])

    def load(motion, cuts):
        for row, force, moment in zip(tree.row, loads.force, loads.moment, strict=True):
            apply_wrench(cuts, row, tuple(force), tuple(moment))

    motion, cuts, response = solved(tree, to_lanes(tree, state), in_rows(tree, loads.torque), load)
    found, at = form_a(bodies, state, loads, G), place_bodies(bodies, state)
    size = max(np.abs(found.linear).max(), np.abs(found.angular).max())
    for b, row in enumerate(tree.row):
        if b:
            wrench = np.concatenate(hinge_wrench(tree, motion, cuts, response, row))
            assert_allclose(wrench, found.wrench[b], rtol=0, atol=1e-9 * np.abs(found.wrench).max())
        arm = at.rotation[b] @ local
        turning = np.cross(found.angular[b], arm) + np.cross(
            at.angular_velocity[b], np.cross(at.angular_velocity[b], arm)
        )
        got = point_specific_force(motion, response, row, tuple(at.origin[b] + arm))
        assert_allclose(got, found.linear[b] + turning - G, rtol=0, atol=1e-9 * size)
    # lanes that hold no body take part in everything and must stay harmless
    for part in (motion.cells, cuts.cells, response.cells):
        assert np.isfinite(part).all()
