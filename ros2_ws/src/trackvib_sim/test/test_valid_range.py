"""Runs that leave what the model can describe, and how a run starts."""

import numpy as np
import pytest
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import RunFailed, Simulation
from trackvib_sim.vehicle.system import Operation


def drive(vehicle, speed, road, periods):
    """Yield the simulation after each period."""
    simulation = Simulation(vehicle, RunSettings(Operation(speed, 0.0, False), Rates(), 1.0))
    feeder = RoadFeeder(road, 50.0)
    for _ in range(periods):
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        simulation.advance(np.ones(2))
        yield simulation


@pytest.mark.property
def test_overturning_ends_a_run_with_its_reason(vehicle):
    """Class H at 25 m/s throws the vehicle over: the run fails by name and time and keeps its last sample."""
    simulation = None
    with pytest.raises(RunFailed, match=r"(overturned|below the road) after t = \d+\.\d{3} s"):
        for simulation in drive(vehicle, 25.0, Iso8608Road("H", 1, 8.0, 8.0), 20_000):
            before = [part.copy() for part in (simulation.sample.specific_force, simulation.sample.rate)]
    assert np.isfinite(before).all()
    np.testing.assert_array_equal(simulation.sample.specific_force, before[0])
    np.testing.assert_array_equal(simulation.sample.rate, before[1])


@pytest.mark.property
@pytest.mark.parametrize("speed", [0.0, 5.0, 10.0, 20.0])
def test_vehicle_is_already_rolling(vehicle, speed):
    """On a level road the speed is kept from the start; the first second brings less than 0.5 % of change."""
    speeds = [s.state.tree.velocity[0, 0] for s in drive(vehicle, speed, Iso8608Road("A", 1, 1e4, 1.0), 1000)]
    assert np.abs(np.array(speeds) - speed).max() <= max(0.005 * speed, 1e-6)


@pytest.mark.property
def test_road_is_asked_for_as_far_as_a_slow_loop_goes(vehicle):
    """At ten periods a second, 2.5 m of road go by in one; the wheels never roll beyond what is held."""
    settings = RunSettings(Operation(25.0, 0.0, False), Rates(control=10, odometry=10), 1.0)
    simulation = Simulation(vehicle, settings)
    road = Iso8608Road("A", 1, 1e4, 1.0)
    simulation.road.add(-20.0, 0.05, *road.heights(-400, 600))  # up to 9.95 m
    front = max(vehicle.swing_arms.wheel_x) + vehicle.road_wheels.radius
    while simulation.road_is_enough():
        simulation.advance(np.ones(2))
        assert simulation.distance + front < 9.95
