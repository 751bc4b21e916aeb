"""One case of the study: a vehicle at constant speed on level ground, its energy booked step by step."""

from dataclasses import dataclass

import numpy as np

from ...road.obstacles import LevelRoad
from ...simulation.open_loop import run_open_loop
from ...simulation.run_in import CannotRoll
from ...simulation.settings import Rates, RunSettings
from ...simulation.simulation import RunFailed, Simulation
from ...vehicle.energy import Part, Source, energy
from ...vehicle.energy_meter import EnergyMeter
from ...vehicle.system import Operation
from ..case import GOOD, rates_for, settling

MEASURING = 1.0  # s
AROUND = 30.0  # m of road before and behind a vehicle
SPACING = 0.5  # m
TRACK_PHASE = 0.25  # neither in step nor in opposition
CURRENT = 1.0  # A
LEVEL = LevelRoad(SPACING)


@dataclass(frozen=True)
class ResistanceCase:
    """What distinguishes one run from the next."""

    speed: float  # m/s


@dataclass(frozen=True)
class ResistanceResult:
    """What a case gave; plain values."""

    status: str  # `GOOD`, or "failed: " and why
    speed: float | None  # m/s, mean
    drive: float | None  # W, mean power of the sprockets' drive
    heat: dict[str, float]  # W by the names of `Part` in small letters; empty where failed
    left_over: float | None  # part of the drive's work that is neither heat nor held


def pull(vehicle, case):
    """Return the mean force [N] that keeps a vehicle's speed in a case, without an account of where it goes.

    It is the work of the drive per way. The driver's integral alone comes out 3 % less.

    Raises
    ------
    CannotRoll, RunFailed
        The vehicle leaves the valid range.
    """
    rates = rates_for(vehicle)
    simulation = Simulation(vehicle, RunSettings(Operation(case.speed, 0.0, False, TRACK_PHASE), rates, CURRENT))
    settled, end = (round(time * rates.control) for time in (settling(case.speed), settling(case.speed) + MEASURING))
    booked = []  # work of the drive and way so far

    def look(done):
        if done >= settled:
            booked.append(simulation.state.drive.driving.done.copy())

    run_open_loop(simulation, LEVEL, end, look)
    work, way = booked[-1] - booked[0]
    return float(work / way)


def roll(vehicle, case):
    """Run a case and return its `ResistanceResult`; a run that leaves the valid range is a result, too."""
    rate = rates_for(vehicle).physics
    operation = Operation(case.speed, 0.0, False, TRACK_PHASE)
    try:
        # a control period of one step, so that the meter can look at each
        simulation = Simulation(vehicle, RunSettings(operation, Rates(rate, rate, rate), CURRENT))
        settled = round(settling(case.speed) * rate)
        way = case.speed * (settled / rate + MEASURING) + 2.0 * AROUND
        simulation.road.add(simulation.distance - AROUND, SPACING, *np.zeros((2, round(way / SPACING))))
        current = np.full(simulation.mounting.coils, CURRENT)
        for _ in range(settled):
            simulation.advance(current)
        return _booked(simulation, current, round(MEASURING * rate))
    except (CannotRoll, RunFailed) as error:
        return ResistanceResult(f"failed: {error}", None, None, {}, None)


def _booked(simulation, current, steps):
    meter, held, speed, drive, heat = EnergyMeter(simulation.system), [], 0.0, 0.0, np.zeros(len(Part))
    road = simulation.road.around(simulation.distance - 0.5 * AROUND, simulation.distance + 0.5 * AROUND)
    for _ in range(steps):
        meter.open(simulation.state)
        simulation.advance(current)
        meter.close(simulation.state, road)
        heat += meter.account.dissipation / steps
        drive += float(meter.account.given[Source.DRIVER]) / steps
        speed += float(simulation.sample.hull_velocity[0, 0]) / steps
        held.append(energy(meter.account))
    by_name = dict(zip((part.name.lower() for part in Part), heat.tolist(), strict=True))
    left_over = drive - heat.sum() - (held[-1] - held[0]) / MEASURING
    return ResistanceResult(GOOD, speed, drive, by_name, float(left_over / drive))
