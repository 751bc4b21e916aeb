"""The linear model of the standing vehicle: against the simulator's own forces by differences, and what is in it."""

import numpy as np
import pytest
from trackvib_sim.rui.linear.equilibrium import check_equilibrium
from trackvib_sim.rui.linear.modes import modes
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.response import ResponseOffset
from trackvib_sim.rui.sweeps.tree import new_rows, rest_lanes
from trackvib_sim.vehicle.equilibrium import static_equilibrium
from trackvib_sim.vehicle.hinge_springs import add_hinge_springs
from trackvib_sim.vehicle.linear_vehicle import build_linear_vehicle
from trackvib_sim.vehicle.mount_law import lay_fields, new_field_state
from trackvib_sim.vehicle.mounts import add_mounts
from trackvib_sim.vehicle.supports import add_supports
from trackvib_sim.vehicle.suspension import add_suspension
from trackvib_sim.vehicle.system import Operation, build_system

SMALL = 1e-6  # m, rad, m/s and rad/s, for differences
POLES = 1e-7  # relative; the differences leave some 4e-9
CURRENT = 1.0  # A
SURGE = 0  # column of `whole_share`


@pytest.fixture(scope="module")
def standing(vehicle):
    """The system of the vehicle at rest with its engine off."""
    return build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)


@pytest.fixture(scope="module")
def unbraked(standing):
    """The same with sprockets that let the tracks run, against damping; 1 N/m is left to say where it stands."""
    supports = standing.supports
    return standing._replace(supports=supports._replace(longitudinal=(1.0, supports.longitudinal[1])))


@pytest.fixture(scope="module")
def accelerate(solved):
    """A function that returns the 46 accelerations under all forces of the standing vehicle."""

    def find(system, tree_state):
        fields = new_field_state(2)
        lay_fields(system.mounts, np.full(2, CURRENT), fields)
        torques = new_rows(system.tree)
        add_hinge_springs(system.springs, tree_state, torques)
        add_suspension(system.suspension, tree_state, torques)

        def load(motion, cuts):
            add_mounts(system.mounts, fields, motion, cuts, np.full(2, CURRENT), 0.0, 0.0)
            add_supports(system.supports, motion, cuts)

        _, _, response = solved(system.tree, tree_state, torques, load)
        root, hinges = system.tree.row[0], system.tree.row[1:]
        linear = columns(response, ResponseOffset.LINEAR, 3)[root] + system.tree.gravity
        return np.concatenate(
            (
                linear,
                columns(response, ResponseOffset.ANGULAR, 3)[root],
                columns(response, ResponseOffset.HINGE, 1)[hinges, 0],
            )
        )

    return find


@pytest.fixture(scope="module")
def slopes(accelerate, drifted):
    """A function that returns the slopes (46, 46) of the accelerations with places and with speeds, by differences."""

    def moving(tree, state, k, speed):
        still = rest_lanes(tree)
        state = state._replace(
            velocity=still.velocity, angular_velocity=still.angular_velocity, hinge_rate=still.hinge_rate
        )
        if k < 6:
            (state.velocity if k < 3 else state.angular_velocity)[0, k % 3] = speed
        else:
            state.hinge_rate[tree.row[k - 5]] = speed
        return state

    def at_speed(system, state, k, way):
        return accelerate(system, moving(system.tree, state, k, way))

    def at_place(system, state, k, way):
        moved_there = drifted(moving(system.tree, state, k, way), 1.0)
        return accelerate(system, moving(system.tree, moved_there, k, 0.0))

    def find(system, state):
        def slope(accelerations):
            ahead, back = (
                np.stack([accelerations(system, state, k, way) for k in range(46)], axis=1) for way in (SMALL, -SMALL)
            )
            return (ahead - back) / (2.0 * SMALL)

        return slope(at_place), slope(at_speed)

    return find


@pytest.mark.cross_engine
@pytest.mark.parametrize("kind", ["standing", "unbraked"])
def test_poles_are_those_of_the_simulator(vehicle, slopes, request, kind):
    """All oscillating poles are those of the simulator's accelerations, differenced about the equilibrium."""
    system = request.getfixturevalue(kind)
    by_place, by_speed = slopes(system, static_equilibrium(system, CURRENT).tree)
    expected = _oscillating(np.linalg.eigvals(np.block([[np.zeros((46, 46)), np.eye(46)], [by_place, by_speed]])))
    found = _oscillating(np.array([mode.pole for mode in modes(build_linear_vehicle(vehicle, system, CURRENT))]))
    assert len(found) == len(expected) > 12
    apart = np.abs(found[:, None] - expected).min(axis=0) / np.abs(expected)
    assert apart.max() < POLES, dict(zip(expected.tolist(), apart.tolist(), strict=True))


def _oscillating(poles):
    return poles[poles.imag > 1.0]


@pytest.mark.slow(reason="several vehicles come to rest")
@pytest.mark.property
def test_mounts_stiffen_the_powertrain(vehicle, unbraked):
    """The powertrain's pitching on its mounts rises with the current, and the vehicle is at rest at each.

    With brakes the whole vehicle's swinging to and fro lies near it in frequency and has its part in the motion.
    """
    frequencies = []
    for current in (0.7, 1.0, 2.0, 4.0):
        model = build_linear_vehicle(vehicle, unbraked, current)
        check_equilibrium(model)
        row = [body.name for body in model.bodies].index("powertrain")
        pitch = max(modes(model), key=lambda mode: mode.hinge_share[row])
        assert pitch.hinge_share[row] > 0.9 and not pitch.overdamped
        frequencies.append(pitch.frequency)
    assert np.all(np.diff(frequencies) > 0.1), frequencies


@pytest.mark.property
def test_brakes_hold_the_vehicle(vehicle, table, standing, unbraked):
    """Only with its sprockets braked the vehicle swings to and fro on its tracks; without, it creeps.

    It swings about as its mass would alone; powertrain, gun and pitching shift that by some percent.
    """
    held, loose = (
        [mode for mode in modes(build_linear_vehicle(vehicle, each, CURRENT)) if mode.whole_share[SURGE] > 0.5]
        for each in (standing, unbraked)
    )
    assert [mode.overdamped for mode in held] == [False]
    alone = np.sqrt(2.0 * standing.supports.longitudinal[0] / sum(body.mass for body in table)) / (2.0 * np.pi)
    assert held[0].frequency == pytest.approx(alone, rel=0.1)
    # bearings alone brake it, so weakly that rounding decides whether both poles, at zero but for minutes, are real
    assert loose and all(mode.overdamped or mode.frequency < 0.01 for mode in loose)
