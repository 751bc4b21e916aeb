"""What is measured in the running gear, against statics and balances; looking at it changes nothing."""

from copy import deepcopy

import numpy as np
import pytest
from trackvib_sim.rui.sweeps.articulated import new_cuts
from trackvib_sim.rui.sweeps.kinematics import new_motion, update_motion
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.running_gear import RUNS, RunningGear
from trackvib_sim.vehicle.body_tree import GRAVITY, whole_mass
from trackvib_sim.vehicle.tracks.tracks import add_tracks, new_track_work

pytestmark = pytest.mark.analytic

RESTING = 8000  # periods; to and fro on its tracks the vehicle swings with hardly any damping
STEADY = 1000  # periods of which the mean is taken
SETTLING = 2000  # of the rolling one
SPEED, ENGINE = 5.0, 1650.0  # m/s, r/min
BOTH = ("left", "right")


def numbers(gear):
    """What `gear` reads now, by kind, each by what its numbers belong to."""
    return {
        kind.name: dict(zip(kind.names, values.tolist(), strict=True))
        for kind, values in zip(gear.kinds, gear.read(), strict=True)
    }


@pytest.fixture(scope="module")
def standing(vehicle, simulation, level):
    """The numbers of the vehicle at rest."""
    stands = simulation(speed=0.0)
    run_open_loop(stands, level, RESTING)
    return numbers(RunningGear(vehicle, stands))


@pytest.fixture(scope="module")
def rolling(vehicle, simulation, level, drive):
    """The means of the numbers at a steady speed on level ground, among them the heat of the tracks [W]."""
    rolls = simulation(speed=SPEED, engine_speed=ENGINE)
    gear, rows = RunningGear(vehicle, rolls), []
    names = [(kind.name, name) for kind in gear.kinds for name in kind.names] + ["heat", "turn"]
    run_open_loop(rolls, level, SETTLING)
    tracks, path, dt = rolls.system.tracks, rolls.state.drive.path, rolls.system.dt
    work = new_track_work(tracks)
    for _ in drive(rolls, level, STEADY):
        motion, cuts = new_motion(rolls.system.tree), new_cuts(rolls.system.tree)
        update_motion(rolls.system.tree, rolls.state.tree, motion)
        state = deepcopy(rolls.state.tracks)
        add_tracks(tracks, state, rolls.state.tree, rolls.road_at_hand, path, motion, cuts, work, dt, True)
        turn = rolls.state.tree.hinge_rate[tracks.sprockets.row].mean()
        rows.append([*np.concatenate(gear.read()), work.dissipation.sum(), turn])
    return dict(zip(names, np.mean(rows, axis=0).tolist(), strict=True))


def test_ground_carries_the_weight(vehicle, standing):
    """Of the vehicle and its shoes, to 0.1 %, left as right; nothing pushes it along or aside."""
    force = standing["ground_force"]
    weight = whole_mass(vehicle) * GRAVITY
    assert force["left_z"] + force["right_z"] == pytest.approx(weight, rel=1e-3)
    assert force["left_z"] == pytest.approx(force["right_z"], rel=1e-3)
    for axis in "xy":
        assert force[f"left_{axis}"] + force[f"right_{axis}"] == pytest.approx(0.0, abs=1e-3 * weight)


def test_wheels_carry_the_bodies_and_the_pull_of_the_tracks(table, system, standing):
    """To 3 %, the runs taken at the tension that they were laid with; the dampers are at rest."""
    travel, force = standing["suspension_travel"], standing["wheel_force"]
    assert max(map(abs, travel.values())) < 0.1 and min(force.values()) > 0.0
    assert all(abs(value) < 50.0 for value in standing["damper_force"].values())
    # the runs at both ends pull sprockets and idlers down, and the upper ones lie on the rollers
    ends = system.supports
    bodies = sum(body.mass for body in table) * GRAVITY
    carried = bodies - ends.pull[:, :, 1].sum() + ends.upper_weight.sum()
    assert sum(force.values()) == pytest.approx(carried, rel=0.03)


def test_tension_at_rest_is_the_pretension(vehicle, standing):
    """Of every run, to 15 %: the upper run sags, and the hull sinks after the tracks were laid."""
    for side, pretension in zip(BOTH, vehicle.tracks.pretension, strict=True):
        for run in RUNS:
            assert standing["track_tension"][f"{side}_{run}"] == pytest.approx(pretension, rel=0.15)


def test_power_at_the_sprockets_is_the_heat_of_the_tracks(rolling):
    """At a steady speed on level ground, to 5 %: what the hull and its suspension take is less.

    A balance of torque against the pull of rear and upper runs does not hold: between teeth of a pitch other than its
    own a track is squeezed, works as it bends, and its runs leave the sprocket at different levers.
    """
    torque = sum(rolling["sprocket_torque", side] for side in BOTH)
    assert torque * rolling["turn"] == pytest.approx(rolling["heat"], rel=0.05)


def test_idlers_turn_freely(rolling):
    """So the runs on both sides of one pull alike, to 5 %, but for what its rim loses."""
    for side in BOTH:
        front, upper = (rolling["track_tension", f"{side}_{run}"] for run in ("front", "upper"))
        assert front == pytest.approx(upper, rel=0.05)


def test_steady_speed_needs_no_force_of_the_ground(vehicle, rolling):
    """What drives the shoes on and what resists them cancel: the mean along the road is below 0.2 % of the weight."""
    weight = whole_mass(vehicle) * GRAVITY
    assert abs(rolling["ground_force", "left_x"] + rolling["ground_force", "right_x"]) < 2e-3 * weight
    assert rolling["ground_force", "left_z"] + rolling["ground_force", "right_z"] == pytest.approx(weight, rel=0.01)
    assert rolling["engine_speed", "engine"] == pytest.approx(ENGINE)


@pytest.mark.property
def test_looking_changes_nothing(vehicle, simulation, level):
    """A run that is looked at every period has the bits of one that is not."""
    seen, alone = simulation(speed=SPEED), simulation(speed=SPEED)
    run_open_loop(seen, level, 5), run_open_loop(alone, level, 5)
    gear = RunningGear(vehicle, seen)
    for _ in range(50):
        for each in (seen, alone):
            each.advance(np.full(each.mounting.coils, 1.0))
        gear.read()
        np.testing.assert_array_equal(seen.sample.specific_force, alone.sample.specific_force)
    np.testing.assert_array_equal(seen.state.tracks.nodes, alone.state.tracks.nodes)
