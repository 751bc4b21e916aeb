"""One case of the controller study: the whole vehicle in a scenario under a control law, in process."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from mr_mount_controller.laws import find_law
from mr_mount_controller.laws.running import make_law
from scipy import signal

from ...analysis.iso2631 import weighted
from ...analysis.settling import SHORTEST_SETTLING, VEHICLE_BEHIND, settling_time
from ...analysis.vibration import band_limited, rms
from ...numerics.units import NANO, RPM
from ...road.bump import Bump
from ...road.iso8608 import FADE, LEVEL_UNTIL, SPACING
from ...road.obstacles import LevelRoad
from ...simulation.closed_loop import run_closed_loop
from ...simulation.run_in import CannotRoll
from ...simulation.settings import RunSettings
from ...simulation.simulation import Probe, RunFailed, Simulation
from ...vehicle.drive.schedule import Schedule
from ...vehicle.mount_energy import mount_energy_account
from ...vehicle.sensors import sensors_of
from ...vehicle.system import Operation
from ..case import BAND, GOOD, RATES, rates_for, rough_road

PASSIVE, PASSIVE_CURRENT = "passive", 1.0  # A; the coils of every run carry it before the law's first answer
DRIVING, IDLE, HIGHEST = 1650.0, 450.0, 2100.0  # r/min
RAMP = 75.0  # r/min a second
CALMING = 24.0  # s; superstructure and gun, which are hardly damped, ring on after the tracks were laid
HEIGHT, LENGTH = 0.1, 1.0  # m, of the bump
RINGING = 1.5  # s that a bump's measurement goes on once the rear wheels have left it
ABOVE_BAND = 30.0  # Hz, from which on the mounts' resonance plays no part


class Scenario(NamedTuple):
    """What the vehicle does while it is measured, from `settling` [s] on for `measuring` [s]."""

    title: str
    speed: float  # m/s
    engine_speed: float  # r/min, where there is no schedule
    settling: float
    measuring: float
    road: object  # function of vehicle and seed
    varies: bool = True  # whether seed and track phase matter
    schedule: Schedule | None = None


def _rough(road_class, speed):
    title = f"class {road_class}, {speed:g} m/s"
    settling = settling_time(speed, LEVEL_UNTIL + FADE)
    return Scenario(title, speed, DRIVING, settling, 5.0, lambda vehicle, seed: rough_road(vehicle, road_class, seed))


def _bump(speed):
    over = (LENGTH + 2.0 * VEHICLE_BEHIND) / speed  # from the foremost wheels' meeting it to the rearmost's leaving it
    start = SHORTEST_SETTLING * speed + VEHICLE_BEHIND
    title = f"bump of {HEIGHT:g} m x {LENGTH:g} m, {speed:g} m/s"
    return Scenario(title, speed, DRIVING, SHORTEST_SETTLING, over + RINGING, lambda *_: Bump(HEIGHT, LENGTH, start))


def _run_up():
    title = f"standing, engine {IDLE:g}-{HIGHEST:g} r/min"
    level = LevelRoad(SPACING)
    duration = (HIGHEST - IDLE) / RAMP
    at, engine_speed = np.array([CALMING, CALMING + duration]), RPM * np.array([IDLE, HIGHEST])
    faster = Schedule(False, at, np.zeros(2), np.zeros(2), engine_speed)
    return Scenario(title, 0.0, IDLE, CALMING, duration, lambda *_: level, varies=False, schedule=faster)


SCENARIOS = {"e10": _rough("E", 10.0), "c20": _rough("C", 20.0), "run_up": _run_up(), "bump": _bump(5.0)}


@dataclass(frozen=True)
class ControlCase:
    """What distinguishes one run from the next."""

    scenario: str  # one of `SCENARIOS`
    seed: int  # of the road
    track_phase: float  # part of a pitch by which the right track lies ahead of the left one
    law: str  # as `find_law` takes it
    current: float = PASSIVE_CURRENT  # A, of the passive law; without effect on others


@dataclass(frozen=True)
class ControlResult:
    """What a case gave; not a number where the run failed."""

    status: str  # `GOOD`, or "failed: " and why
    levels: dict[str, float]  # by name in `QUANTITIES`; empty where failed


QUANTITIES = {  # name: what it is, unit
    "powertrain": ("vertical RMS acceleration of the powertrain", "m/s²"),
    "powertrain_wk": ("the same, weighted with Wk", "m/s²"),
    "powertrain_high": (f"the same, unweighted, above {ABOVE_BAND:g} Hz", "m/s²"),
    "hull": ("vertical RMS acceleration of the hull at the mounts", "m/s²"),
    "hull_wk": ("the same, weighted with Wk", "m/s²"),
    "force": ("RMS of the vertical force through both mounts", "kN"),
    "travel": ("vertical travel of the mounts, peak to peak", "mm"),
    "current": ("mean current of a coil", "A"),
    "switching": ("power lost to the field by switching, both mounts, mean of the whole run", "W"),
}


def control(vehicle, case):
    """Run a case and return its `ControlResult`; a run that leaves the valid range is a result, too."""
    scenario = SCENARIOS[case.scenario]
    operation = Operation(scenario.speed, scenario.engine_speed, False, case.track_phase, scenario.schedule)
    period = RATES.period / NANO
    values = {"current": case.current} if case.law == PASSIVE else {}
    settled, measured = (round(time * RATES.control) for time in (scenario.settling, scenario.measuring))
    try:
        simulation = Simulation(vehicle, RunSettings(operation, rates_for(vehicle), case.current), probes(vehicle))
        law = make_law(find_law(case.law), period, values)
        record = run_closed_loop(simulation, scenario.road(vehicle, case.seed), law, settled + measured)
    except (CannotRoll, RunFailed) as error:
        return ControlResult(f"failed: {error}", {})
    lost = mount_energy_account(simulation.state.mount_energy).exchanged / (simulation.time / NANO)
    return ControlResult(GOOD, _levels(record, settled, simulation.settings.rates) | {"switching": lost})


def probes(vehicle):
    """Return where levels are measured: powertrain and hull at their sensors."""
    chassis, powertrain, *_ = sensors_of(vehicle)
    return [Probe(sensor.body, sensor.place) for sensor in (powertrain, chassis)]


def _levels(record, settled, rates):
    begin, vertical = settled * rates.steps, record.probed[:, :, 2]
    # filtered before they are cut, so that the filters' own settling is cut as well
    powertrain, hull = rms(band_limited(vertical, rates.physics, BAND[1])[begin:])
    powertrain_wk, hull_wk = rms(weighted(vertical, "Wk", rates.physics)[begin:])
    above = signal.butter(4, ABOVE_BAND, "highpass", fs=rates.physics, output="sos")
    high = signal.sosfiltfilt(above, band_limited(vertical[:, 0], rates.physics, BAND[1]))
    force = record.force[:, :, 2].sum(axis=1, keepdims=True)
    levels = {
        "powertrain": powertrain,
        "powertrain_wk": powertrain_wk,
        "powertrain_high": rms(high[begin:]),
        "hull": hull,
        "hull_wk": hull_wk,
        "force": rms(band_limited(force, rates.control)[settled:])[0] / 1e3,
        "travel": np.ptp(record.deflection[settled:, :, 2], axis=0).max() * 1e3,
        "current": record.coil_current[settled:].mean(),
    }
    return {name: float(value) for name, value in levels.items()}
