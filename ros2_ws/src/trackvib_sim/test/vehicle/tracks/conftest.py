"""Vehicles with their tracks laid or rolling, and how one moves step by step."""

import numpy as np
import pytest
from trackvib_sim.road.store import Road
from trackvib_sim.simulation.sensing import points_of
from trackvib_sim.simulation.settings import Rates
from trackvib_sim.simulation.step import Status, control_periods, new_sample, one_row
from trackvib_sim.vehicle.system import new_state, new_work

NO_SENSORS = points_of((), (), {}, Rates())


@pytest.fixture(scope="session")
def rolling(vehicle, simulation):
    """A function that returns system and state of a vehicle that has rolled in on a level road, engine off."""

    def make(speed=10.0, physics=10_000, vehicle=vehicle):
        moving = simulation(speed=speed, physics=physics, vehicle=vehicle)
        return moving.system, moving.state

    return make


@pytest.fixture(scope="session")
def mover():
    """A function of a system that returns `move(state, road, steps)`, which moves a state on with 1 A in the coils."""

    def make(system):
        work, sensors, current = new_work(system), NO_SENSORS, np.ones_like(new_state(system).coils.field)
        samples = [new_sample(sensors, 0, system.mounts) for _ in range(2)]
        rows = one_row(samples[0])

        def move(state, road, steps):
            periods = control_periods(system, state, road, current, steps, work, sensors, *samples, rows)
            assert next(periods) == Status.GOOD

        return move

    return make


@pytest.fixture(scope="session")
def valley():
    """A level road far below everything."""
    return Road(-1000, 1.0, np.full((2, 2000), -1000.0))


@pytest.fixture(scope="session")
def level_road():
    """A level road at height zero."""
    return Road(-100, 1.0, np.zeros((2, 1000)))
