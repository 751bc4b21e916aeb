"""Static equilibrium and the rolling state that a run starts from."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.rui.cells import columns
from trackvib_sim.rui.cuts import new_cuts
from trackvib_sim.rui.kinematics import ORIGIN, ROTATION, VELOCITY
from trackvib_sim.vehicle.body_tree import STATIONS
from trackvib_sim.vehicle.equilibrium import NoEquilibrium, rolling_state, static_equilibrium
from trackvib_sim.vehicle.mr_mounts import mount_deflection, mount_force
from trackvib_sim.vehicle.running_gear.wheels_on_road import WheelsState, add_wheels_on_road
from trackvib_sim.vehicle.system import Operation, build_system, new_state


def standing(vehicle, speed=0.0):
    """The system of a vehicle with its engine off."""
    return build_system(vehicle, Operation(speed, 0.0, False), 1e-4)


@pytest.fixture(scope="module")
def ground_forces(level_road, moved, added):
    """A function that returns the ground's loads on all bodies, and the brushes, which were straight before."""

    def evaluate(system, state):
        cuts, brushes = new_cuts(system.tree), WheelsState(np.zeros(12), np.zeros(12))
        add_wheels_on_road(system.wheels, brushes, level_road, moved(system.tree, state.tree), cuts, system.dt)
        return added(cuts), brushes

    return evaluate


@pytest.mark.analytic
@pytest.mark.parametrize("current", [0.7, 1.0, 4.0])
def test_wheels_carry_the_weight(vehicle, table, ground_forces, current):
    """At rest the wheels' forces are vertical and add up to the weight, left as right."""
    system = standing(vehicle)
    loads, _ = ground_forces(system, static_equilibrium(system, current))
    force = loads.force[system.wheels.row]
    # accelerations are below 1e-8 m/s^2, a part in 1e9 of gravity
    assert force[:, 2].sum() == pytest.approx(sum(body.mass for body in table) * 9.81, rel=1e-6)
    assert_allclose(force[:, :2], 0.0, atol=1e-3)
    assert_allclose(force[:STATIONS], force[STATIONS:], rtol=1e-6, atol=1e-3)


@pytest.mark.analytic
def test_wheels_balance_the_centre_of_mass(table, system, ground_forces, moved):
    """At rest the wheels' forces have the moment of the weight about the global axes."""
    state = static_equilibrium(system, 1.0)
    loads, _ = ground_forces(system, state)
    motion = moved(system.tree, state.tree)
    origin, turn = columns(motion, ORIGIN, 3), columns(motion, ROTATION, 9).reshape(-1, 3, 3)
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
        force, power = mount_force(system.mounts, 1.0, l, l_d)
        assert force[2] == pytest.approx(9800.0, rel=0.1)
        assert power == 0.0


@pytest.mark.property
def test_standing_vehicle_stays(simulation, level):
    """A standing vehicle with its engine off feels gravity and nothing else, for a second."""
    still = simulation(speed=0.0)
    still.road.add(-20.0, 0.05, *level.heights(-400, 801))
    before = np.concatenate([part.ravel() for part in still.state.tree])
    force = []
    for _ in range(1000):
        still.advance(np.ones(2))
        force.append(still.sample.specific_force.copy())
    # 1e-8 m/s^2 of the equilibrium, 1e-12 m of it times 1e6 N/m of a spring on 200 kg
    assert_allclose(np.linalg.norm(force, axis=2), 9.81, atol=1e-6)
    assert_allclose(np.ptp(force, axis=0), 0.0, atol=1e-6)
    after = np.concatenate([part.ravel() for part in still.state.tree])
    assert_allclose(after, before, atol=1e-7)


@pytest.mark.property
@pytest.mark.parametrize("speed", [0.0, 5.0, 20.0])
def test_vehicle_starts_rolling_without_slip(vehicle, ground_forces, moved, speed):
    """At the start every wheel moves at the wanted speed and its contact does not slip."""
    system = standing(vehicle, speed)
    state = rolling_state(system, 1.0)
    loads, brushes = ground_forces(system, state)
    velocity = columns(moved(system.tree, state.tree), VELOCITY, 3)[system.wheels.row]
    assert_allclose(velocity, np.tile((speed, 0.0, 0.0), (12, 1)), atol=1e-12)
    # a brush deflects by dt times the slip, so this is 1e-11 m/s
    assert np.abs(brushes.longitudinal).max() < 1e-15
    # what the ground does then goes through the hub
    assert_allclose(loads.moment[system.wheels.row], 0.0, atol=1e-6)


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


@pytest.mark.property
@pytest.mark.parametrize(
    ("section", "items"),
    [
        ("hull", {"centre": [10.0, 0.0, 1.05]}),  # topples
        ("tyres", {"radial_stiffness": 1e3}),  # sinks to its axles
        ("gun_mount", {"stiffness": 0.0}),  # its gun drops
        ("recoil_part", {"stiffness": 0.0}),  # slides off the sloping gun
    ],
)
def test_vehicle_that_cannot_stand_is_refused(changed, section, items):
    """Where something would move, the refusal says by how much and what is accepted."""
    with pytest.raises(NoEquilibrium, match=r"still accelerates by .* accepted is < 1e-08"):
        static_equilibrium(standing(changed(section, **items)), 1.0)


@pytest.mark.property
def test_new_state_is_all_zero(system):
    """A new state has every coordinate, brush and current at zero and the hull upright."""
    state = new_state(system)
    assert state.tree.attitude.tolist() == [[1.0, 0.0, 0.0, 0.0]]
    for part in (*state.tree[:1], *state.tree[2:], *state.brushes, *state[2:]):
        assert not part.any()
