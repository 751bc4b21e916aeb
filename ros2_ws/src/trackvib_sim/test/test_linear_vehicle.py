"""The linear model of the standing vehicle: against the simulator's own forces by differences, and what is in it."""

import numpy as np
import pytest
from trackvib_sim.rui.cells import columns
from trackvib_sim.rui.cuts import new_cuts
from trackvib_sim.rui.equilibrium import check_equilibrium
from trackvib_sim.rui.modes import modes
from trackvib_sim.rui.riccati import ANGULAR, HINGE, LINEAR
from trackvib_sim.rui.tree import new_rows, rest_lanes
from trackvib_sim.vehicle.equilibrium import LEVEL, static_equilibrium
from trackvib_sim.vehicle.hinge_springs import add_hinge_springs
from trackvib_sim.vehicle.linear import linear_vehicle
from trackvib_sim.vehicle.mr_mounts import add_mounts
from trackvib_sim.vehicle.running_gear.wheels_on_road import WheelsState, add_wheels_on_road
from trackvib_sim.vehicle.suspension import add_suspension
from trackvib_sim.vehicle.system import Operation, build_system

SMALL = 1e-6  # m, rad, m/s and rad/s, for differences
POLES = 1e-7  # relative; the differences leave some 4e-9
CURRENT = 1.0  # A
YAW = 5


def standing(vehicle):
    """The system of a vehicle at rest with its engine off."""
    return build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)


def linear(vehicle, current=CURRENT):
    """The linear model of a vehicle."""
    return linear_vehicle(vehicle, standing(vehicle), current)


@pytest.fixture(scope="module")
def accelerate(solved):
    """A function that returns the 46 accelerations under all forces of the simulator but driver and engine."""

    def find(system, tree_state, brushes):
        torques = new_rows(system.tree)
        add_hinge_springs(system.springs, tree_state, torques)
        add_suspension(system.suspension, tree_state, torques)

        def load(motion, cuts):
            add_mounts(system.mounts, motion, cuts, np.full(2, CURRENT), 0.0, 0.0)
            add_wheels_on_road(system.wheels, brushes, LEVEL, motion, cuts, 0.0)

        _, _, response = solved(system.tree, tree_state, torques, load)
        root, hinges = system.tree.row[0], system.tree.row[1:]
        linear = columns(response, LINEAR, 3)[root] + system.tree.gravity
        return np.concatenate((linear, columns(response, ANGULAR, 3)[root], columns(response, HINGE, 1)[hinges, 0]))

    return find


@pytest.fixture(scope="module")
def slopes(accelerate, moved, drifted):
    """A function that returns the slopes (46, 46) of the accelerations with places and with speeds, by differences."""

    def moving(tree, state, k, speed):
        still = rest_lanes(tree)
        state = state._replace(velocity=still.velocity, rate=still.rate, hinge_rate=still.hinge_rate)
        if k < 6:
            (state.velocity if k < 3 else state.rate)[0, k % 3] = speed
        else:
            state.hinge_rate[tree.row[k - 5]] = speed
        return state

    def at_speed(system, state, k, speed):
        return accelerate(system, moving(system.tree, state, k, speed), _straight())

    def at_place(system, state, k, way):
        """What the vehicle feels after having moved so slowly for a second that only the brushes have felt it."""
        before, brushes = moving(system.tree, state, k, way), _straight()
        add_wheels_on_road(system.wheels, brushes, LEVEL, moved(system.tree, before), new_cuts(system.tree), 1.0)
        return accelerate(system, moving(system.tree, drifted(before, 1.0), k, 0.0), brushes)

    def find(system, state):
        def slope(accelerations):
            ahead, back = (
                np.stack([accelerations(system, state, k, way) for k in range(46)], axis=1) for way in (SMALL, -SMALL)
            )
            return (ahead - back) / (2.0 * SMALL)

        return slope(at_place), slope(at_speed)

    return find


def _straight():
    return WheelsState(np.zeros(12), np.zeros(12))


@pytest.mark.cross_engine
@pytest.mark.parametrize("springs", [True, False], ids=["brushes", "dampers"])
def test_poles_are_those_of_the_simulator(changed, slopes, springs):
    """All oscillating poles are those of the simulator's accelerations, differenced about the equilibrium.

    With tangential brushes that hold like springs (a standing brush does not relax), and with their dampers alone.
    """
    without = {} if springs else {"longitudinal_stiffness": 0.0, "lateral_stiffness": 0.0}
    vehicle = changed("tyres", relaxation_length=1e9, **without)
    system = standing(vehicle)
    by_place, by_speed = slopes(system, static_equilibrium(system, CURRENT).tree)
    expected = _oscillating(np.linalg.eigvals(np.block([[np.zeros((46, 46)), np.eye(46)], [by_place, by_speed]])))
    found = _oscillating(np.array([mode.pole for mode in modes(linear(vehicle))]))
    assert len(found) == len(expected) > 12
    apart = np.abs(found[:, None] - expected).min(axis=0) / np.abs(expected)
    assert apart.max() < POLES, dict(zip(expected.tolist(), apart.tolist(), strict=True))


def _oscillating(poles):
    return poles[poles.imag > 1.0]


@pytest.mark.property
def test_mounts_stiffen_the_powertrain(vehicle):
    """The powertrain's pitching on its mounts rises with the current, and the vehicle is at rest at each."""
    frequencies = []
    for current in (0.7, 1.0, 2.0, 4.0):
        model = linear(vehicle, current)
        check_equilibrium(model)
        row = [body.name for body in model.bodies].index("powertrain")
        pitch = max(modes(model), key=lambda mode: mode.hinge_share[row])
        assert pitch.hinge_share[row] > 0.9 and not pitch.overdamped
        frequencies.append(pitch.frequency)
    assert np.all(np.diff(frequencies) > 0.1), frequencies


@pytest.mark.property
def test_standing_brushes_hold_the_vehicle(vehicle, changed):
    """Only with the brushes' springs the vehicle swings in yaw; without, it creeps."""
    slippery = changed("tyres", longitudinal_stiffness=0.0, lateral_stiffness=0.0)
    held, loose = (
        [mode for mode in modes(linear(each)) if mode.whole_share[YAW] > 0.5] for each in (vehicle, slippery)
    )
    assert [mode.overdamped for mode in held] == [False]
    assert held[0].whole_share[YAW] > 0.9
    assert all(mode.overdamped for mode in loose)
