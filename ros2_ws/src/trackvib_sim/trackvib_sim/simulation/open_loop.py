"""A run under constant current, without controller and without a crossing to Python a period."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..road.feeder import HasHeights, RoadFeeder
from .simulation import HORIZON, Simulation

CHUNK = 100  # periods in one compiled call, and between two calls of `on_progress`


class OpenLoopRecord(NamedTuple):
    """The signals of a run: one row per control period for sensors, one per physics step for probes.

    Sensors are in the order of the simulation's sample, probes in theirs.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.OpenLoopRecord._fields
    ('time', 'specific_force', 'probed', 'speed')
    """

    time: np.ndarray  # (k,) s
    specific_force: np.ndarray  # (k, m, 3) m/s^2
    probed: np.ndarray  # (k steps, p, 3) specific force in the axes of the probes' bodies, m/s^2
    speed: np.ndarray  # (k,) of the hull, along its own x axis, m/s


def run_open_loop(
    simulation: Simulation, road: HasHeights, periods: int, on_progress: Callable[[int], None] = lambda done: None
) -> OpenLoopRecord:
    """Run a `simulation.Simulation` on a road with its passive current for a number of control periods.

    The result equals that of `closed_loop.run_closed_loop` under the passive law with that current, to the last bit.
    `on_progress(done)` is called now and then with the periods done.

    Raises
    ------
    RunFailed
        The state left what the model can describe.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    >>> settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    >>> record = tv.run_open_loop(tv.Simulation(vehicle, settings), tv.Iso8608Road("C", seed=7), periods=100)
    >>> bool(abs(record.speed.mean() - 10.0) < 0.1)  # the driver keeps the speed, m/s
    True
    """
    feeder = RoadFeeder(road, HORIZON)
    current = np.full(simulation.mounting.coils, simulation.settings.passive_current)
    force = np.zeros((periods, *simulation.sample.specific_force.shape))
    probed, speed = np.zeros((periods, *simulation.sample.probed.shape)), np.zeros(periods)
    for first in range(0, periods, CHUNK):
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        part = slice(first, first + CHUNK)
        simulation.advance_many(current, force[part], probed[part], speed[part])
        on_progress(min(first + CHUNK, periods))
    time = np.arange(1, periods + 1) / simulation.settings.rates.control
    return OpenLoopRecord(time, force, joined(probed), speed)


def joined(probed):
    """Return what probes met in the steps of all periods (k, steps, p, 3) as one array (k steps, p, 3), no copy."""
    periods, steps, *rest = probed.shape
    return probed.reshape(periods * steps, *rest)
