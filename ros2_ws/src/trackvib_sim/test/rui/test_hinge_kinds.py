"""Elastic, prescribed and locked hinges in the two sweeps."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.reference.form_a import form_a
from trackvib_sim.rui.reference.placement import parent_rows, place_bodies
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.state import no_loads, rest_state
from trackvib_sim.rui.sweeps.articulated import CutOffset, new_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.elastic import apply_elastic_hinges
from trackvib_sim.rui.sweeps.integrator import integrate
from trackvib_sim.rui.sweeps.tree import build_tree, rest_lanes, to_lanes
from trackvib_sim.rui.table import Body, Hinge

from .cases import EVERY_KIND, NO_GRAVITY, ROUNDING, G, differ, seeds, shapes


@pytest.mark.property
@pytest.mark.parametrize("shape", ["chain", "hung"])
def test_elastic_hinges_have_a_wrench_as_well(shaped_table, shape):
    """What a bushing exerts on the parent, about the hinge point on the parent, is that of Form A."""
    case = shaped_table(shape, 100, EVERY_KIND)
    elastic = [body.hinge is not None and body.hinge.kind == "elastic" for body in case[0]]
    assert differ([accelerations(*case, G).wrench[elastic]], [form_a(*case, G).wrench[elastic]]) < ROUNDING


def _rates_of_momentum(bodies, state, found):
    """Linear and angular (about the global origin) rates of momentum of each body."""
    at, rates = place_bodies(bodies, state), []
    for row, body in enumerate(bodies):
        om, al, arm = at.angular_velocity[row], found.angular[row], at.rotation[row] @ body.centre
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
    wrench, spring = columns(cuts, CutOffset.FORCE, 6)[tree.row], columns(undamped, CutOffset.FORCE, 6)[tree.row]
    moment = wrench[:, 3:] + np.cross(at.origin, wrench[:, :3])
    assert_allclose(wrench[:, :3].sum(0), 0.0, atol=1e-12 * np.abs(wrench).max())
    assert_allclose(moment.sum(0), 0.0, atol=1e-12 * np.abs(moment).max())
    assert not columns(cuts, CutOffset.TORQUE, 1).any()
    damper = wrench - spring
    assert np.sum(damper[:, :3] * at.velocity) + np.sum(damper[:, 3:] * at.angular_velocity) < 0.0


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
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
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
    assert differ(accelerations(bodies, state, more, G), accelerations(bodies, state, loads, G)) < ROUNDING


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
    assert differ(found, free) < ROUNDING
    axis = place_bodies(bodies, state).axis
    for row in range(1, len(bodies)):
        part = slice(0, 3) if bodies[row].hinge.kind == "prismatic" else slice(3, 6)
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
    assert differ([part[keep] for part in found[:3]], one[:3]) < ROUNDING
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
