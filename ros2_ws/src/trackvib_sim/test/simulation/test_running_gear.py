"""What is measured in the running gear, against statics and balances; looking at it changes nothing."""

import numpy as np
import pytest
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.running_gear import RUNS, RunningGear
from trackvib_sim.vehicle.body_tree import GRAVITY, whole_mass
from trackvib_sim.vehicle.tracks.sprockets import pitch_radius

pytestmark = pytest.mark.analytic

RESTING = 8000  # periods; to and fro on its tracks the vehicle swings with hardly any damping
STEADY = 1000  # periods of which the mean is taken
SPEED, ENGINE = 5.0, 1650.0  # m/s, r/min


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
def rolling(vehicle, simulation, level):
    """The means of the numbers of the vehicle at a steady speed on level ground, and how it rolled at the end."""
    rolls = simulation(speed=SPEED, engine_speed=ENGINE)
    gear, means = RunningGear(vehicle, rolls), []
    run_open_loop(rolls, level, 2000)
    for _ in range(STEADY):
        rolls.advance(np.full(rolls.mounting.coils, rolls.settings.passive_current))
        means.append(np.concatenate(gear.read()))
    names = [(kind.name, name) for kind in gear.kinds for name in kind.names]
    return dict(zip(names, np.mean(means, axis=0).tolist(), strict=True))


def test_ground_carries_the_weight(vehicle, standing):
    """Of the vehicle and its shoes, to 0.1 %, left as right; nothing pushes it along or aside."""
    force = standing["ground_force"]
    weight = whole_mass(vehicle) * GRAVITY
    assert force["left_z"] + force["right_z"] == pytest.approx(weight, rel=1e-3)
    assert force["left_z"] == pytest.approx(force["right_z"], rel=1e-3)
    for axis in "xy":
        assert force[f"left_{axis}"] + force[f"right_{axis}"] == pytest.approx(0.0, abs=1e-3 * weight)


def test_wheels_carry_the_sprung_weight(vehicle, standing):
    """The wheels carry what the tracks do not, and more where runs pull them up; dampers of a standing one are at rest."""
    travel, force = standing["suspension_travel"], standing["wheel_force"]
    assert max(map(abs, travel.values())) < 0.1 and min(force.values()) > 0.0
    assert all(abs(value) < 50.0 for value in standing["damper_force"].values())
    total, weight = sum(force.values()), whole_mass(vehicle) * GRAVITY
    shoes = sum(vehicle.tracks.links) * vehicle.tracks.shoe_mass * GRAVITY
    assert weight - shoes < total < 1.15 * weight
    assert len(force) == 2 * vehicle.swing_arms.stations


def test_tension_at_rest_is_the_pretension(vehicle, standing):
    """Of every run, to 20 %: the upper run sags, and the hull sinks after the tracks were laid."""
    for side, pretension in zip(("left", "right"), vehicle.tracks.pretension, strict=True):
        for run in RUNS:
            assert standing["track_tension"][f"{side}_{run}"] == pytest.approx(pretension, rel=0.2)


def test_torque_balances_the_runs_at_the_sprocket(vehicle, rolling):
    """At a steady speed the torque is the difference of tension before and behind the sprocket, to 10 %."""
    radius = pitch_radius(vehicle)
    near, far = ("front", "upper") if vehicle.sprockets.x > vehicle.idlers.x else ("rear", "upper")
    for side in ("left", "right"):
        pull = rolling["track_tension", f"{side}_{near}"] - rolling["track_tension", f"{side}_{far}"]
        assert abs(rolling["sprocket_torque", side]) == pytest.approx(abs(pull) * radius, rel=0.1)


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
