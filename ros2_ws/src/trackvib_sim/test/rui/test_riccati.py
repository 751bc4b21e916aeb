"""The two sweeps on small trees: the example of the method's statement, and random trees against dense algebra."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.cells import columns
from trackvib_sim.rui.cuts import (
    FORCE,
    TORQUE,
    P,
    Q,
    R,
    apply_force,
    apply_implicit_bush,
    apply_implicit_spring,
    apply_wrench,
    new_cuts,
)
from trackvib_sim.rui.elastic import apply_elastic_hinges
from trackvib_sim.rui.integrator import integrate
from trackvib_sim.rui.kinematics import point_place
from trackvib_sim.rui.overall import form_a
from trackvib_sim.rui.placement import parent_rows, place_bodies
from trackvib_sim.rui.riccati import hinge_wrench, point_specific_force
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import TreeState, free_bodies, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge
from trackvib_sim.rui.tree import build_tree, new_rows, rest_lanes, to_lanes, to_table

PRINTED = 0.6e-10  # half of the last printed digit, a little more for the rounding of the comparison
ROUNDING = 1e-11  # of the largest value; some 1e2 operations a body, at 1e-16, and condition numbers of some 1e2
G = (0.0, 0.0, -9.81)
NO_GRAVITY = (0.0, 0.0, 0.0)
SHAPES = ("single", "chain", "bush", "branches", "stalk", "hung")
EVERY_KIND = ("revolute", "slide", "prescribed", "locked", "elastic")
shapes = pytest.mark.parametrize("shape", SHAPES)
seeds = pytest.mark.parametrize("seed", range(5))


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
             Hinge(3, "slide", "base", (0, 0.5, 0), (1, 0, 0))),
    ]  # fmt: skip
    state = TreeState(
        position=np.zeros((1, 3)),
        attitude=np.array([[np.cos(0.15), 0.0, 0.0, np.sin(0.15)]]),
        velocity=np.array([[1.0, 0.0, 0.5]]),
        rate=np.array([[0.1, -0.2, 0.3]]),
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

    p, q, r = (columns(cuts, first, count)[row] for first, count in ((P, 6), (Q, 9), (R, 6)))
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
    om, mass = place_bodies(bodies, state).rate[1], bodies[1].mass
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
        Body(1, "bead", 0.5, (0, 0, 0), 1e-3 * np.eye(3), Hinge(1, "slide", "rod", (0.1, 0, 0), (1, 0, 0))),
    ]
    state = rest_state(bodies)
    state.rate[0, 2], state.hinge[1], state.hinge_rate[1] = rate, 0.4, 0.7
    found = accelerations(bodies, state, no_loads(bodies), NO_GRAVITY)
    assert_allclose(found.hinge[1], rate**2 * 0.5, rtol=1e-12, atol=1e-12)
    # the rod takes the Coriolis force 2 m om v, against the turning, at the bead: 0.4 m from the hinge point on the rod
    assert_allclose(found.wrench[1, 1], -2.0 * 0.5 * rate * 0.7, rtol=1e-9, atol=1e-12)
    assert_allclose(found.wrench[1, 5], -2.0 * 0.5 * rate * 0.7 * 0.4, rtol=1e-9, atol=1e-12)


def _differ(found, expected):
    """Largest difference over the largest entry, quantity by quantity (1 at least: some are all zero)."""
    pairs = [(a, b) for a, b in zip(found, expected, strict=True) if np.size(b)]
    return max(np.max(np.abs(a - b)) / max(np.max(np.abs(b)), 1.0) for a, b in pairs)


@pytest.mark.cross_engine
@shapes
@seeds
def test_trees_against_pinocchio(shaped_table, pinocchio, shape, seed):
    """Accelerations and hinge wrenches of trees of every shape are those of an independent engine."""
    case = shaped_table(shape, seed)
    assert _differ(accelerations(*case, G), pinocchio(*case, G)) < ROUNDING


@pytest.mark.property
@shapes
@seeds
def test_sweeps_solve_the_overall_equation(shaped_table, shape, seed):
    """With hinges of every kind the sweeps find what the dense overall transfer equation (Form A) has as solution."""
    case = shaped_table(shape, 100 + seed, EVERY_KIND)
    found, dense = accelerations(*case, G), form_a(*case, G)
    rigid = [body.hinge is not None and body.hinge.kind != "elastic" for body in case[0]]
    # of the dense equation with up to 300 unknowns
    assert _differ((*found[:3], found.wrench[rigid]), (*dense[:3], dense.wrench[rigid])) < 1e-9


@pytest.mark.property
@pytest.mark.parametrize("shape", ["chain", "hung"])
def test_elastic_hinges_have_a_wrench_as_well(shaped_table, shape):
    """What a bushing exerts on the parent, about the hinge point on the parent, is that of Form A."""
    case = shaped_table(shape, 100, EVERY_KIND)
    elastic = [body.hinge is not None and body.hinge.kind == "elastic" for body in case[0]]
    assert _differ([accelerations(*case, G).wrench[elastic]], [form_a(*case, G).wrench[elastic]]) < ROUNDING


def _dense(bodies, state):
    """Mass matrix from the kinetic energy: `freedom` (each a part of the state and its index), `speed`, `mass`.

    `speed[k]` is the `Placement` with speed k at 1 and all others at 0.
    """
    free = free_bodies(bodies)
    freedom = [(part, (k, i)) for k in range(len(free)) for part in ("velocity", "rate") for i in range(3)]
    freedom += [
        ("hinge_rate", row) for row, body in enumerate(bodies)
        if body.hinge is not None and body.hinge.kind in ("revolute", "slide") and not body.hinge.prescribed
    ]  # fmt: skip
    mass, speeds, momenta = np.zeros((len(freedom),) * 2), [], []
    for part, index in freedom:
        moving = state._replace(**{item: np.zeros_like(getattr(state, item)) for item in state._fields[2:4]},
                                hinge_rate=np.zeros(len(bodies)))  # fmt: skip
        getattr(moving, part)[index] = 1.0
        at = place_bodies(bodies, moving)
        centre = [A @ body.centre for A, body in zip(at.rotation, bodies, strict=True)]
        spin = [A @ body.inertia @ A.T @ om for A, body, om in zip(at.rotation, bodies, at.rate, strict=True)]
        v = at.velocity + np.cross(at.rate, centre)
        speeds.append(SimpleNamespace(velocity=at.velocity, rate=at.rate, v=v))
        momenta.append((np.array([[body.mass] for body in bodies]) * v, np.array(spin)))
    for i, speed in enumerate(speeds):
        for j, (linear, angular) in enumerate(momenta):
            mass[i, j] = np.sum(speed.v * linear) + np.sum(speed.rate * angular)
    return SimpleNamespace(freedom=freedom, speed=speeds, mass=mass)


def _generalised(dense, found, bodies):
    """The accelerations of the freedoms of `_dense`."""
    free = free_bodies(bodies)
    parts = {"velocity": found.linear[free], "rate": found.angular[free], "hinge_rate": found.hinge}
    return np.array([parts[part][index] for part, index in dense.freedom])


@pytest.mark.analytic
@shapes
@seeds
def test_root_matrix_is_the_inertia_with_free_hinges(shaped_table, solved, shape, seed):
    """S of the root is symmetric, and minus the mass matrix reduced by the hinges: M_rr - M_rh M_hh^-1 M_hr."""
    bodies, state, _ = shaped_table(shape, seed, ("revolute", "slide", "prescribed", "locked"))
    tree = build_tree(bodies)
    _, cuts, _ = solved(tree, to_lanes(tree, state))
    s = _root_matrix(cuts, tree.row[0])
    mass = _dense(bodies, state).mass
    reduced = mass[:6, :6] - mass[:6, 6:] @ np.linalg.solve(mass[6:, 6:], mass[6:, :6])
    assert_allclose(s, s.T, rtol=0, atol=0)
    assert_allclose(-s, reduced, rtol=0, atol=ROUNDING * np.abs(mass).max())
    assert np.linalg.eigvalsh(s)[-1] < 0.0


@pytest.mark.analytic
@shapes
@seeds
def test_accelerations_invert_the_mass_matrix(shaped_table, shape, seed):
    """From rest, without loads but one, the accelerations are columns of the inverse mass matrix."""
    bodies, state, _ = shaped_table(shape, seed, ("revolute", "slide", "locked"))
    still = state._replace(velocity=np.zeros((1, 3)), rate=np.zeros((1, 3)), hinge_rate=np.zeros(len(bodies)))
    dense = _dense(bodies, still)
    loads_of = {"velocity": "force", "rate": "moment", "hinge_rate": "torque"}
    inverse = np.zeros_like(dense.mass)
    for k, (part, index) in enumerate(dense.freedom):
        loads = no_loads(bodies)
        getattr(loads, loads_of[part])[index] = 1.0
        inverse[:, k] = _generalised(dense, accelerations(bodies, still, loads, NO_GRAVITY), bodies)
    scale = np.sqrt(np.outer(np.diag(dense.mass), np.diag(dense.mass)))
    # scaled to a unit diagonal of the mass matrix
    inverse *= scale
    assert_allclose(inverse, inverse.T, rtol=0, atol=ROUNDING * np.abs(inverse).max())
    assert_allclose(dense.mass / scale @ inverse, np.eye(len(inverse)), rtol=0, atol=ROUNDING * np.abs(inverse).max())


def _rates_of_momentum(bodies, state, found):
    """Linear and angular (about the global origin) rates of momentum of each body."""
    at, rates = place_bodies(bodies, state), []
    for row, body in enumerate(bodies):
        om, al, arm = at.rate[row], found.angular[row], at.rotation[row] @ body.centre
        inertia = at.rotation[row] @ body.inertia @ at.rotation[row].T
        force = body.mass * (found.linear[row] + np.cross(al, arm) + np.cross(om, np.cross(om, arm)))
        moment = np.cross(at.origin[row] + arm, force) + inertia @ al + np.cross(om, inertia @ om)
        rates.append((*force, *moment))
    return np.array(rates)


@pytest.mark.property
@pytest.mark.parametrize("shape", ["chain", "hung"])
@seeds
def test_elastic_hinges_keep_momentum(shaped_table, shape, seed):
    """Bushings (and hinges of every other kind) change neither the linear nor the angular momentum of the whole."""
    bodies, state, loads = shaped_table(shape, 200 + seed, EVERY_KIND)
    assert any(body.hinge.kind == "elastic" for body in bodies[1:])
    rates = _rates_of_momentum(bodies, state, accelerations(bodies, state, no_loads(bodies), NO_GRAVITY))
    assert np.abs(rates.sum(0)).max() < ROUNDING * np.abs(rates).sum()
    # and external loads by what they are
    rates = _rates_of_momentum(bodies, state, accelerations(bodies, state, loads, NO_GRAVITY))
    origin = place_bodies(bodies, state).origin
    outside = np.hstack((loads.force, loads.moment + np.cross(origin, loads.force))).sum(0)
    assert_allclose(rates.sum(0), outside, rtol=0, atol=ROUNDING * np.abs(rates).sum())


@pytest.mark.property
def test_elastic_hinges_load_both_bodies_alike(shaped_table, moved):
    """What a bushing exerts on both bodies cancels, about any point, and damping takes power."""
    bodies, state, _ = shaped_table("hung", 7, EVERY_KIND)
    tree = build_tree(bodies)
    motion, cuts, undamped = moved(tree, to_lanes(tree, state)), new_cuts(tree), new_cuts(tree)
    apply_elastic_hinges(tree, motion, cuts)
    still = tree._replace(elastic=tree.elastic._replace(damping=0.0 * tree.elastic.damping))
    apply_elastic_hinges(still, motion, undamped)
    at = place_bodies(bodies, state)
    wrench, spring = columns(cuts, FORCE, 6)[tree.row], columns(undamped, FORCE, 6)[tree.row]
    moment = wrench[:, 3:] + np.cross(at.origin, wrench[:, :3])
    assert_allclose(wrench[:, :3].sum(0), 0.0, atol=1e-12 * np.abs(wrench).max())
    assert_allclose(moment.sum(0), 0.0, atol=1e-12 * np.abs(moment).max())
    assert not columns(cuts, TORQUE, 1).any()
    damper = wrench - spring
    assert np.sum(damper[:, :3] * at.velocity) + np.sum(damper[:, 3:] * at.rate) < 0.0


@pytest.mark.analytic
@pytest.mark.parametrize("direction", range(6))
def test_mass_on_a_bushing_has_its_frequency(solved, direction):
    """Two bodies on a bushing swing against each other with k (1 / m_1 + 1 / m_2), moments of inertia for rotations.

    Symplectic Euler with steps h swings by the angle phi a step, 2 cos(phi) = 2 - (h om)^2, and symmetrically about
    half a step before the start.
    """
    stiffness = (1e3, 2e3, 3e3, 40.0, 50.0, 60.0)
    masses = np.array([[20.0, 20.0, 20.0, 1.0, 2.0, 2.5], [5.0, 5.0, 5.0, 0.3, 0.2, 0.4]])
    bodies = [
        Body(1, "frame", masses[0, 0], (0, 0, 0), np.diag(masses[0, 3:])),
        Body(2, "engine", masses[1, 0], (0, 0, 0), np.diag(masses[1, 3:]),
             Hinge(3, "elastic", "frame", (0, 0, 0), stiffness=stiffness)),
    ]  # fmt: skip
    tree, small = build_tree(bodies, NO_GRAVITY), 1e-3
    state = rest_lanes(tree)
    if direction < 3:
        state.position[1, direction] = small
    else:
        turned = Rotation.from_rotvec(small * np.eye(3)[direction - 3])
        state.attitude[1] = turned.as_quat(scalar_first=True)
    omega = np.sqrt(stiffness[direction] * np.sum(1.0 / masses[:, direction]))
    h = 2.0 * np.pi / omega / 40.0
    phi = np.arccos(1.0 - 0.5 * (h * omega) ** 2)
    found = []
    for _ in range(400):
        _, _, response = solved(tree, state, load=lambda motion, cuts: apply_elastic_hinges(tree, motion, cuts))
        integrate(tree, state, response, h)
        first, second = Rotation.from_quat(state.attitude, scalar_first=True)
        apart = np.concatenate((state.position[1] - state.position[0], (first.inv() * second).as_rotvec()))
        found.append(apart[direction])
        apart[direction] = 0.0
        assert np.abs(apart).max() < 1e-12 * small
    expected = small * np.cos((np.arange(1, 401) + 0.5) * phi) / np.cos(0.5 * phi)
    assert_allclose(found, expected, rtol=0, atol=1e-10 * small)


@pytest.mark.analytic
@pytest.mark.parametrize("kind", ["revolute", "slide"])
def test_prescribed_hinge_drives_its_body(kind):
    """A drive that accelerates one of two coaxial bodies against the other drives that one back by a known torque."""
    bodies = [
        Body(1, "stator", 4.0, (0, 0, 0), np.diag([1.0, 1.0, 2.0])),
        Body(2, "rotor", 1.0, (0, 0, 0), np.diag([0.3, 0.3, 0.5]),
             Hinge(3, kind, "stator", (0, 0, 0), (0, 0, 1), prescribed=True)),
    ]  # fmt: skip
    loads = no_loads(bodies)
    loads.acceleration[1] = 6.0
    loads.torque[1] = 123.0  # of no consequence where motion is prescribed
    found = accelerations(bodies, rest_state(bodies), loads, NO_GRAVITY)
    stays, moves = (2.0, 0.5) if kind == "revolute" else (4.0, 1.0)
    back = -moves / (stays + moves) * 6.0
    driven, other = (found.angular, found.linear) if kind == "revolute" else (found.linear, found.angular)
    assert found.hinge[1] == 6.0
    assert_allclose(driven, [(0.0, 0.0, back), (0.0, 0.0, back + 6.0)], rtol=1e-14)
    assert not other.any()
    assert_allclose(found.wrench[1, 5 if kind == "revolute" else 2], stays * back, rtol=1e-14)


@pytest.mark.property
@shapes
def test_acceleration_given_to_a_free_hinge_is_of_no_consequence(shaped_table, shape):
    """Of the accelerations among the loads only those of prescribed hinges count."""
    bodies, state, loads = shaped_table(shape, 8, EVERY_KIND)
    free = np.array([body.hinge is None or not body.hinge.prescribed for body in bodies])
    more = loads._replace(acceleration=np.where(free, 5.0, loads.acceleration))
    assert _differ(accelerations(bodies, state, more, G), accelerations(bodies, state, loads, G)) < ROUNDING


@pytest.mark.property
@shapes
@seeds
def test_prescribed_motion_needs_the_torque_that_caused_it(shaped_table, shape, seed):
    """Prescribing every other hinge to accelerate as it did under a torque changes nothing and gives the torque."""
    bodies, state, loads = shaped_table(shape, 300 + seed)
    free = accelerations(bodies, state, loads, G)
    driven = [
        replace(body, hinge=replace(body.hinge, prescribed=True)) if row % 2 else body
        for row, body in enumerate(bodies)
    ]
    odd = np.arange(len(bodies)) % 2 == 1
    given = loads._replace(acceleration=np.where(odd, free.hinge, 0.0), torque=np.where(odd, 0.0, loads.torque))
    found = accelerations(driven, state, given, G)
    assert _differ(found, free) < ROUNDING
    axis = place_bodies(bodies, state).axis
    for row in range(1, len(bodies)):
        part = slice(0, 3) if bodies[row].hinge.kind == "slide" else slice(3, 6)
        torque = -axis[row] @ found.wrench[row, part]
        assert torque == pytest.approx(loads.torque[row], abs=ROUNDING * np.abs(found.wrench).max())


@pytest.mark.property
@pytest.mark.parametrize("shape", ["chain", "bush", "branches", "stalk"])
@pytest.mark.parametrize("row", [1, 2, 5])
def test_locked_hinge_makes_one_body(shaped_table, shape, row):
    """A body on a locked hinge moves as if its mass and inertia were its parent's, whatever its coordinate says."""
    bodies, state, loads = shaped_table(shape, 400 + row)
    bodies[row] = replace(bodies[row], hinge=replace(bodies[row].hinge, kind="locked"))
    found = accelerations(bodies, state, loads, G)
    p, body, place = parent_rows(bodies)[row], bodies[row], np.asarray(bodies[row].hinge.place)
    at = place_bodies(bodies, state)
    merged = list(bodies)
    merged[p] = _merged(bodies[p], body, place)
    for k, other in enumerate(bodies):
        if other.hinge is not None and other.hinge.parent == body.name:
            merged[k] = replace(other, hinge=replace(other.hinge, parent=bodies[p].name,
                                                     place=place + other.hinge.place))  # fmt: skip
    force, moment = loads.force.copy(), loads.moment.copy()
    force[p] += force[row]
    moment[p] += moment[row] + np.cross(at.origin[row] - at.origin[p], force[row])
    keep = [k for k in range(len(bodies)) if k != row]
    one = accelerations(
        [merged[k] for k in keep],
        state._replace(hinge=state.hinge[keep], hinge_rate=state.hinge_rate[keep]),
        loads._replace(force=force[keep], moment=moment[keep], torque=loads.torque[keep],
                       acceleration=loads.acceleration[keep]),
        G,
    )  # fmt: skip
    assert _differ([part[keep] for part in found[:3]], one[:3]) < ROUNDING
    assert found.hinge[row] == 0.0
    same_point = [k for k in keep if k and bodies[k].hinge.parent != body.name]
    index = [keep.index(k) for k in same_point]
    assert_allclose(found.wrench[same_point], one.wrench[index], rtol=0, atol=ROUNDING * np.abs(one.wrench).max())


def _merged(a, b, place):
    """Body a with body b, of parallel axes, fixed to it at a place."""
    centres = np.array([a.centre, place + b.centre])
    masses = np.array([a.mass, b.mass])
    centre = masses @ centres / masses.sum()
    inertia = a.inertia + b.inertia
    for mass, d in zip(masses, centres - centre, strict=True):
        inertia = inertia + mass * (d @ d * np.eye(3) - np.outer(d, d))
    return replace(a, mass=masses.sum(), centre=centre, inertia=inertia)


def _in_rows(tree, torque):
    """Torques in the rows of a tree, from those in the order of its table."""
    rows = new_rows(tree)
    rows[tree.row] = torque
    return rows


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

    motion, cuts, response = solved(tree, to_lanes(tree, state), _in_rows(tree, loads.torque), load)
    found, at = form_a(bodies, state, loads, G), place_bodies(bodies, state)
    size = max(np.abs(found.linear).max(), np.abs(found.angular).max())
    for b, row in enumerate(tree.row):
        if b:
            wrench = np.concatenate(hinge_wrench(tree, motion, cuts, response, row))
            assert_allclose(wrench, found.wrench[b], rtol=0, atol=1e-9 * np.abs(found.wrench).max())
        arm = at.rotation[b] @ local
        turning = np.cross(found.angular[b], arm) + np.cross(at.rate[b], np.cross(at.rate[b], arm))
        got = point_specific_force(motion, response, row, tuple(at.origin[b] + arm))
        assert_allclose(got, found.linear[b] + turning - G, rtol=0, atol=1e-9 * size)
    # lanes that hold no body take part in everything and must stay harmless
    for part in (motion.cells, cuts.cells, response.cells):
        assert np.isfinite(part).all()


def _symmetric(s):
    return np.array([[s[0], s[3], s[4]], [s[3], s[1], s[5]], [s[4], s[5], s[2]]])


def _positive(random, size):
    """Six numbers of a random positive definite symmetric matrix."""
    half = random.normal(size=(3, 3))
    m = size * (half @ half.T + np.eye(3))
    return (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2])


@pytest.mark.analytic
@shapes
@seeds
def test_implicit_springs_solve_the_linearly_implicit_equation(shaped_table, solved, shape, seed):
    """A step with implicit springs and bushes is that of the dense equation (M + h C + h^2 K) a = f - h K v.

    f is what the explicit step has; for a bush, K = J^T k J, and the velocity-dependent part of the acceleration of
    its point is with J a.
    """
    bodies, state, loads = shaped_table(shape, 600 + seed, ("revolute", "slide", "locked"))
    random, tree, h = np.random.default_rng(seed), build_tree(bodies, G), 0.01
    n, at, dense, lanes = len(bodies), place_bodies(bodies, state), _dense(bodies, state), to_lanes(tree, state)
    springs = [(b, random.uniform(0, 1e6), random.uniform(0, 1e4)) for b in range(1, n, 2) if tree.moves[b]]
    bushes = [
        (b, at.origin[b] + random.normal(size=3), _positive(random, 1e6), _positive(random, 1e4))
        for b in sorted({0, n // 2, n - 1})
    ]

    def load(motion, cuts):
        for row, force, moment in zip(tree.row, loads.force, loads.moment, strict=True):
            apply_wrench(cuts, row, tuple(force), tuple(moment))
        for b, stiffness, damping in springs:
            apply_implicit_spring(cuts, lanes, tree.row[b], stiffness, damping, h)
        for b, place, stiffness, damping in bushes:
            apply_implicit_bush(cuts, motion, tree.gravity, tree.row[b], tuple(place), stiffness, damping, h)

    _, _, response = solved(tree, lanes, _in_rows(tree, loads.torque), load)
    integrate(tree, lanes, response, h)
    after = to_table(tree, lanes)

    explicit = accelerations(bodies, state, loads, G)
    a = _generalised(dense, explicit, bodies)
    v = np.array([getattr(state, part)[index] for part, index in dense.freedom])
    matrix, right = dense.mass.copy(), dense.mass @ a
    for b, stiffness, damping in springs:
        k = dense.freedom.index(("hinge_rate", b))
        matrix[k, k] += h * damping + h**2 * stiffness
        right[k] -= h * stiffness * v[k]
    for b, place, stiffness, damping in bushes:
        arm, om = place - at.origin[b], at.rate[b]
        jacobian = np.array([unit.velocity[b] + np.cross(unit.rate[b], arm) for unit in dense.speed]).T
        total = explicit.linear[b] + np.cross(explicit.angular[b], arm) + np.cross(om, np.cross(om, arm))
        z, k = h * _symmetric(damping) + h**2 * _symmetric(stiffness), _symmetric(stiffness)
        matrix += jacobian.T @ z @ jacobian
        right -= jacobian.T @ (h * k @ (jacobian @ v) + z @ (total - jacobian @ a))
    expected = v + h * np.linalg.solve(matrix, right)
    got = np.array([getattr(after, part)[index] for part, index in dense.freedom])
    # 1e4 times stiffer than the bodies are heavy
    assert_allclose(got, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


@pytest.mark.analytic
@pytest.mark.parametrize("wheels", [1, 12])
@pytest.mark.parametrize("kind", ["revolute", "slide"])
@pytest.mark.parametrize("implicit", [False, True])
def test_stiff_spring_in_a_hinge_stays_bounded(solved, wheels, kind, implicit):
    """With h^2 k / m = 100 the implicit step only loses energy, over 1000 steps; the explicit one blows up."""
    bodies = [Body(0, "base", 1e9, (0, 0, 0), 1e9 * np.eye(3))] + [
        Body(k, f"wheel {k}", 2.0, (0, 0, 0), 2.0 * np.eye(3), Hinge(k, kind, "base", (k, 0, 0), (0, 1, 0)))
        for k in range(1, wheels + 1)
    ]
    tree, h = build_tree(bodies, NO_GRAVITY), 1e-3
    assert len(tree.lanes) == (1 if wheels == 1 else 8)
    stiffness, state, rows = 100.0 * 2.0 / h**2, rest_lanes(tree), tree.row[1:]
    state.hinge[rows] = 0.1

    def load(motion, cuts):
        for row in rows if implicit else ():
            apply_implicit_spring(cuts, state, row, stiffness, 0.0, h)

    def energy():
        return np.sum(state.hinge_rate[rows] ** 2) + stiffness / 2.0 * np.sum(state.hinge[rows] ** 2)

    largest, start = 0.0, energy()
    before = start
    for _ in range(1000 if implicit else 10):
        torques = new_rows(tree)
        torques[rows] = -stiffness * state.hinge[rows]
        _, _, response = solved(tree, state, torques, load)
        integrate(tree, state, response, h)
        largest = max(largest, np.abs(state.hinge[rows]).max())
        if implicit:
            assert energy() <= before * (1.0 + 1e-9) + 1e-30 * start
            before = energy()
    if implicit:
        assert largest < 0.1
        assert np.abs(state.hinge[rows]).max() < 1e-12
    else:
        assert largest > 1e10


@pytest.mark.analytic
@pytest.mark.parametrize("implicit", [False, True])
def test_stiff_bush_stays_bounded(solved, implicit):
    """The same for a body on a bush to the ground, that turns while it is at it: 1000 steps bounded, 10 blow up."""
    mass, h, corner = 3.0, 1e-3, (0.2, 0.3, -0.1)
    tree = build_tree([Body(1, "block", mass, (0, 0, 0), np.diag([0.5, 0.6, 0.7]))], G)
    stiffness = (100.0 * mass / h**2,) * 3 + (0.0,) * 3
    state = rest_lanes(tree)
    # its corner is 0.01 m off
    state.position[0] = 0.01 - corner[0], -corner[1], -corner[2]
    state.rate[0] = 1.0, -2.0, 0.5

    def load(motion, cuts):
        place = point_place(motion, 0, corner)
        apply_force(cuts, motion, 0, place, tuple(-stiffness[0] * np.array(place)))
        if implicit:
            apply_implicit_bush(cuts, motion, tree.gravity, 0, place, stiffness, (0.0,) * 6, h)

    largest = []
    for _ in range(1000 if implicit else 10):
        motion, _, response = solved(tree, state, load=load)
        largest.append(np.linalg.norm(point_place(motion, 0, corner)))
        integrate(tree, state, response, h)
    if implicit:
        assert max(largest) == largest[0]
        # then it is carried: weight and turning about the corner against 1e8 N/m
        assert max(largest[500:]) < 1e-5
    else:
        assert not max(largest) < 1e6
