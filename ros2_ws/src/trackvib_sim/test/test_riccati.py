"""The two sweeps on small trees: the example of the method's statement, and random trees against dense algebra."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.loads import new_loads
from trackvib_sim.rui.tree import Body, Hinge, build_tree, rest_state

PRINTED = 0.6e-10  # half of the last printed digit, a little more for the rounding of the comparison


@pytest.fixture(scope="module")
def e1(solved):
    """Example E1 of the method's statement (section 12): tree, state, loads, motion, sweep."""
    bodies = [
        Body(0, "base", 10.0, (0.1, 0.2, 0.0), np.diag([1.0, 2.0, 3.0])),
        Body(1, "one", 2.0, (0.3, 0, 0), np.diag([0.02, 0.06, 0.07]),
             Hinge(1, "revolute", "base", (1, 0, 0), (0, 0, 1))),
        Body(2, "two", 1.0, (0, 0, 0.2), np.diag([0.03, 0.03, 0.01]),
             Hinge(2, "revolute", "one", (0.6, 0, 0), (0, 1, 0))),
        Body(3, "three", 3.0, (0.2, 0.1, 0), np.diag([0.05, 0.04, 0.03]),
             Hinge(3, "slide", "base", (0, 0.5, 0), (1, 0, 0))),
    ]  # fmt: skip
    tree = build_tree(bodies, gravity=(0.0, -9.81, 0.0))
    state = rest_state(tree)
    state.attitude[:] = np.cos(0.15), 0.0, 0.0, np.sin(0.15)
    state.velocity[:] = 1.0, 0.0, 0.5
    state.rate[:] = 0.1, -0.2, 0.3
    state.hinge[1:] = 0.4, -0.5, 0.1
    state.hinge_rate[1:] = 1.0, -2.0, 0.5
    loads = new_loads(4)
    loads.torque[1:] = 0.5, -0.3, 2.0
    # f and l act at C of body 2, the loads are taken about its origin
    to_c = _turns(0.3, 0.4, -0.5) @ (0, 0, 0.2)
    loads.force[2] = 1.0, 2.0, 3.0
    loads.moment[2] = (0.1, 0.0, -0.2) + np.cross(to_c, loads.force[2])
    motion, sweep = solved(tree, state, loads)
    return tree, state, loads, motion, sweep


def _turns(base, first, second):
    return Rotation.from_euler("ZY", (base + first, second)).as_matrix()


def _full(p, q, r):
    """The 6 x 6 matrix S of packed blocks."""
    def square(s):
        return np.array([[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]])

    block = q.reshape(3, 3)
    return np.block([[square(p), block], [block.T, square(r)]])


@pytest.mark.golden
def test_e1_accelerations(e1):
    """E1's accelerations of base and hinges are the printed ones."""
    sweep = e1[-1]
    assert_allclose(sweep.linear[0], (0.1454802033, -9.8343102641, 0.0127414976), rtol=0, atol=PRINTED)
    assert_allclose(sweep.angular[0], (-0.0419304198, -0.7000648856, 0.2862313768), rtol=0, atol=PRINTED)
    assert_allclose(sweep.hinge_acceleration[1:], (1.4746125642, 5.1028241439, 0.7530312306), rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_hinge_wrenches(e1):
    """E1's wrenches of child on parent are the printed ones."""
    printed = (
        (2.4098373671, 0.9764759234, 0.9055524173, 0.3492028088, -0.6175053942, -0.5),
        (0.7891582777, 1.5192129431, 2.4985059087, -0.3061239052, 0.1343931696, -0.3306731947),
        (-1.6779994003, -1.3432108371, -0.7370558661, -0.1322894758, 0.2177873672, -0.0448679908),
    )
    assert_allclose(e1[-1].hinge_wrench[1:], printed, rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_root_matrix(e1):
    """The eigenvalues of E1's S at the base are the printed ones."""
    sweep = e1[-1]
    values = np.linalg.eigvalsh(_full(sweep.p[0], sweep.q[0], sweep.r[0]))
    printed = (
        -20.0379088647, -14.7760929103, -12.4693510107, -4.9476038683, -3.6793781402, -1.3982683858,
    )  # fmt: skip
    assert_allclose(values, printed, rtol=0, atol=PRINTED)


@pytest.mark.golden
def test_e1_transfer_of_body_one(e1):
    """What body 1 adds between its two hinges is column 13 of the printed U_1, which has six decimals."""
    tree, _, _, motion, sweep = e1
    turn = _turns(0.3, 0.4, 0.0)
    inertia = turn @ np.diag([0.02, 0.06, 0.07]) @ turn.T
    r_oc, r_oi = turn @ (0.3, 0, 0), turn @ (0.6, 0, 0)
    r_ic, r_co, r_io = r_oc - r_oi, -r_oc, -r_oi
    om, mass = motion.rate[1], tree.mass[1]
    a_i = sweep.linear[1] + np.cross(sweep.angular[1], r_oi) + np.cross(om, np.cross(om, r_oi))
    al, m_i, q_i = sweep.angular[1], sweep.hinge_wrench[2, 3:], sweep.hinge_wrench[2, :3]
    # z_O = U_1 z_I of section 3.1, solved for its last column
    moved_inertia = inertia @ al + mass * np.cross(r_co, np.cross(r_ic, al))
    m = sweep.hinge_wrench[1, 3:] - (mass * np.cross(r_co, a_i) - moved_inertia + m_i - np.cross(r_io, q_i))
    q = sweep.hinge_wrench[1, :3] - (-mass * a_i + mass * np.cross(r_ic, al) + q_i)
    assert_allclose(m, (-0.003539, 0.008588, -4.500268), rtol=0, atol=0.6e-6)
    assert_allclose(q, (-0.801637, -20.28628, -0.04084), rtol=0, atol=0.6e-5)


@pytest.mark.analytic
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2])
def test_pendulum_on_a_heavy_base(solved, angle):
    """A pendulum on a base too heavy to move swings with -m g c sin(angle) / (J + m c^2)."""
    mass, length, inertia = 3.0, 0.8, 0.2
    tree = build_tree([
        Body(0, "base", 1e12, (0, 0, 0), 1e12 * np.eye(3)),
        Body(1, "bob", mass, (0, 0, -length), inertia * np.eye(3),
             Hinge(1, "revolute", "base", (0, 0, 0), (0, 1, 0))),
    ])  # fmt: skip
    state = rest_state(tree)
    state.hinge[1] = angle
    loads = new_loads(2)
    loads.force[0, 2] = 1e12 * 9.81  # holds the base
    _, sweep = solved(tree, state, loads)
    expected = -mass * 9.81 * length * np.sin(angle) / (inertia + mass * length**2)
    # the base yields by the ratio of the masses, and its own weight cancels to rounding
    assert_allclose(sweep.hinge_acceleration[1], expected, rtol=1e-9, atol=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("rate", [0.0, 2.0])
def test_bead_on_a_turning_rod(solved, rate):
    """A bead that slides on a rod turning at a rate is driven outwards with rate^2 times its distance."""
    tree = build_tree([
        Body(0, "rod", 1e12, (0, 0, 0), 1e12 * np.eye(3)),
        Body(1, "bead", 0.5, (0, 0, 0), 1e-3 * np.eye(3), Hinge(1, "slide", "rod", (0.1, 0, 0), (1, 0, 0))),
    ], gravity=(0, 0, 0))  # fmt: skip
    state = rest_state(tree)
    state.rate[2], state.hinge[1], state.hinge_rate[1] = rate, 0.4, 0.7
    _, sweep = solved(tree, state)
    assert_allclose(sweep.hinge_acceleration[1], rate**2 * 0.5, rtol=1e-12, atol=1e-12)
    # the rod takes the Coriolis force 2 m om v, against the turning
    assert_allclose(sweep.hinge_wrench[1, 1], -2.0 * 0.5 * rate * 0.7, rtol=1e-9, atol=1e-12)
