"""Static equilibrium of the standing vehicle, its tracks taken as springs."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset
from trackvib_sim.vehicle.body_tree import GRAVITY, build_body_table
from trackvib_sim.vehicle.equilibrium import NoEquilibrium, static_equilibrium
from trackvib_sim.vehicle.mount_law import mount_force
from trackvib_sim.vehicle.mounts import mount_deflection
from trackvib_sim.vehicle.supports import add_supports
from trackvib_sim.vehicle.system import Operation, build_system, new_state


def standing(vehicle):
    """The system of a vehicle with its engine off."""
    return build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)


@pytest.fixture(scope="module")
def support_loads(moved, added):
    """A function that returns the supports' loads on all bodies."""

    def evaluate(system, state):
        cuts = new_cuts(system.tree)
        add_supports(system.supports, moved(system.tree, state.tree), cuts)
        return added(cuts)

    return evaluate


@pytest.mark.analytic
@pytest.mark.parametrize("current", [0.7, 1.0, 4.0])
def test_supports_carry_the_weight(vehicle, table, support_loads, current):
    """At rest all that acts on wheels and hull adds up to the weight; every wheel is pushed up, left as right."""
    system = standing(vehicle)
    loads = support_loads(system, static_equilibrium(system, current))
    weight = sum(body.mass for body in table) * GRAVITY
    # accelerations are below 1e-8 m/s^2, a part in 1e9 of gravity
    assert_allclose(loads.force.sum(0), (0.0, 0.0, weight), rtol=0, atol=1e-6 * weight)
    force = loads.force[system.supports.wheel]
    assert force[:, 2].min() > 0.0
    left, right = np.split(force, 2)
    assert_allclose(left, right, rtol=1e-6, atol=1e-3)


@pytest.mark.analytic
def test_supports_balance_the_centre_of_mass(table, system, support_loads, moved):
    """At rest the supports' forces have the moment of the weight about the global axes."""
    state = static_equilibrium(system, 1.0)
    loads = support_loads(system, state)
    motion = moved(system.tree, state.tree)
    origin, turn = columns(motion, MotionOffset.ORIGIN, 3), columns(motion, MotionOffset.ROTATION, 9).reshape(-1, 3, 3)
    row = system.tree.row
    centre = origin[row] + np.einsum("nij,nj->ni", turn[row], [body.centre for body in table])
    weight = np.array([[body.mass] for body in table]) * system.tree.gravity
    moment = np.cross(centre, weight).sum(0) + (loads.moment + np.cross(origin, loads.force)).sum(0)
    # of 4e5 N with levers of metres
    assert_allclose(moment, 0.0, atol=1e-3)


@pytest.mark.property
def test_mounts_carry_about_their_rated_load(system, moved):
    """In equilibrium each mount carries the rated load to within 10 %, for which the powertrain's mass is chosen."""
    state = static_equilibrium(system, 1.0)
    motion = moved(system.tree, state.tree)
    for index in range(2):
        _, l, l_d = mount_deflection(system.mounts, motion, index, 0.0, 0.0)
        force, power = mount_force(system.mounts, state.fields, index, 1.0, l, l_d)
        assert force[2] == pytest.approx(9800.0, rel=0.1)
        assert power == 0.0


@pytest.mark.property
def test_symmetric_hull_rolls_by_its_offset(changed):
    """A hull whose centre is left of the middle leans to the left, one right of it by as much to the right."""
    lean = [
        static_equilibrium(standing(changed("hull", centre=[-0.1, y, 1.05])), 1.0).tree.attitude[0, 1]
        for y in (0.0, 0.05, -0.05)
    ]
    assert lean[0] == pytest.approx(0.0, abs=1e-12)
    assert lean[1] < -1e-4
    assert lean[2] == pytest.approx(-lean[1], rel=1e-6)


@pytest.mark.property
def test_equilibrium_needs_no_rubber_mounts(changed, rows):
    """Without the rubber's stiffness the powertrain rests on hinge and MR mounts, and turns a little further."""
    angle = [
        static_equilibrium(standing(changed("powertrain", stiffness=k)), 1.0).tree.hinge[rows["powertrain"]]
        for k in (0.0, 2e5)
    ]
    assert angle[0] != 0.0 and abs(angle[0]) > abs(angle[1]) > 0.0


@pytest.mark.slow(reason="vehicles of several weights come to rest")
@pytest.mark.analytic
@pytest.mark.parametrize("mass", [50e3, 54e3, 150e3])
def test_vehicle_on_its_bump_stops_stands(changed, support_loads, mass):
    """However many stops are in contact, the supports carry the weight."""
    vehicle = changed("hull", mass=mass)
    system = standing(vehicle)
    loads = support_loads(system, static_equilibrium(system, 1.0))
    weight = sum(body.mass for body in build_body_table(vehicle)) * GRAVITY
    assert_allclose(loads.force.sum(0), (0.0, 0.0, weight), rtol=0, atol=1e-6 * weight)


@pytest.mark.property
@pytest.mark.parametrize(
    ("section", "items"),
    [
        ("gun_mount", {"stiffness": 0.0}),  # its gun drops
        ("recoil_part", {"stiffness": 0.0}),  # slides off the sloping gun
    ],
)
def test_vehicle_that_cannot_stand_is_refused(changed, section, items):
    """Where something would move, the refusal says by how much and what is accepted."""
    with pytest.raises(NoEquilibrium, match=r"still accelerates by .* accepted: below 1e-8"):
        static_equilibrium(standing(changed(section, **items)), 1.0)


@pytest.mark.property
@pytest.mark.parametrize(
    ("axis", "centre"), [("x", [10.0, 0.0, 1.05]), ("x", [-7.0, 0.0, 1.05]), ("y", [0.0, 4.0, 1.05])]
)
def test_vehicle_that_topples_is_refused(changed, axis, centre):
    """Where the weight acts beside the wheels, the refusal says where, and where they stand."""
    with pytest.raises(NoEquilibrium, match=rf"topples: the weight acts at {axis} = .* between the wheels"):
        static_equilibrium(standing(changed("hull", centre=centre)), 1.0)


@pytest.mark.property
def test_new_state_is_all_zero(system):
    """A new state has every coordinate, node, current and field at zero, none yields, and the hull is upright."""
    state = new_state(system)
    assert state.tree.attitude.tolist() == [[1.0, 0.0, 0.0, 0.0]]
    fields = state.fields
    assert np.isinf(fields.limit).all()
    drive = state.drive
    alone = (state.tracks.nodes, drive.crank.angle, *drive.driving, drive.path.distance, state.flight)
    springs = fields.place, fields.force, fields.stiffness
    records = (*state.tree[:1], *state.tree[2:], *state.tracks.tensioner, *state.coils, *springs)
    for part in (*records, *alone, *state.mount_energy):
        assert not part.any()
