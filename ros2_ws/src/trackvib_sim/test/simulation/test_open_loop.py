"""Runs in compiled segments: what the closed loop measures under the passive law, to the last bit."""

from dataclasses import dataclass

import numpy as np
import pytest
from mr_mount_controller.laws.passive import Passive
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.simulation import Probe, RunFailed

pytestmark = pytest.mark.property

PERIODS = 250  # not a multiple of a segment


@pytest.fixture(scope="module")
def rough():
    """A class E road that becomes rough under the vehicle."""
    return Iso8608Road("E", 1, 0.0, 4.0)


@pytest.fixture(scope="module")
def rolling(simulation):
    """A function that returns a new simulation at 10 m/s with its engine running."""
    return lambda probes=(): simulation(10.0, 1650.0, phase=0.3, probes=probes)


@pytest.fixture(scope="module")
def record(rolling, rough):
    """A run in compiled segments."""
    return run_open_loop(rolling(), rough, PERIODS)


def test_run_is_that_of_the_passive_law(rolling, record, rough):
    """Both ends of the mounts feel what they feel in the closed loop, at the same times."""
    moving = rolling()
    closed = run_closed_loop(moving, rough, Passive(1e-3), PERIODS)
    assert (closed.current == moving.settings.passive_current).all()
    assert record.specific_force.tobytes() == closed.specific_force.tobytes()
    assert record.speed[-1] == moving.sample.hull_velocity[0, 0]
    np.testing.assert_array_equal(np.round(record.time * 1e9).astype(int), closed.stamp)
    assert np.ptp(record.specific_force[:, :, 2], axis=0).min() > 0.1


def test_probes_change_nothing(rolling, record, rough):
    """With a probe the mounts feel the same."""
    probed = run_open_loop(rolling((Probe("turret", (1.0, 0.5, 0.2)),)), rough, PERIODS)
    assert probed.specific_force[:, :2].tobytes() == record.specific_force.tobytes()
    assert probed.speed.tobytes() == record.speed.tobytes()
    assert np.ptp(probed.probed[:, 0, 2]) > 0.1


def test_probes_have_a_row_a_physics_step(rolling, rough):
    """Where a sensor is, a probe meets the same before any low-pass, in the closed loop to the last bit as well."""
    moving = rolling()
    place = Probe("hull", moving.sensors[0].place)
    steps, periods = moving.settings.rates.steps, 50
    open_loop = run_open_loop(rolling((place,)), rough, periods)
    closed = run_closed_loop(rolling((place,)), rough, Passive(1e-3), periods)
    assert open_loop.probed.shape == (periods * steps, 1, 3)
    assert open_loop.probed.tobytes() == closed.probed.tobytes()
    assert len(np.unique(open_loop.probed[:, 0, 2])) == periods * steps


def test_progress_rises_to_the_end(rolling, rough):
    """Progress is told in rising counts of periods, the last of which is all."""
    told = []
    run_open_loop(rolling(), rough, PERIODS, told.append)
    assert told == sorted(set(told)) and told[-1] == PERIODS and len(told) > 1


@dataclass(frozen=True)
class Wall:
    """A level road with a wall of 3 m across it."""

    distance: float  # m
    spacing = 0.05  # m

    def heights(self, first, count):
        """Return the heights (2, count) of samples 0.05 m apart."""
        return np.tile(np.where(0.05 * np.arange(first, first + count) > self.distance, 3.0, 0.0), (2, 1))


def test_run_fails_where_the_closed_loop_does(rolling):
    """A wall ends both kinds of run for the same reason after the same time."""
    with pytest.raises(RunFailed, match=r" after t = 0\.\d{3} s$") as closed:
        run_closed_loop(rolling(), Wall(4.0), Passive(1e-3), 1000)
    with pytest.raises(RunFailed) as failed:
        run_open_loop(rolling(), Wall(4.0), 1000)
    assert str(failed.value) == str(closed.value)
