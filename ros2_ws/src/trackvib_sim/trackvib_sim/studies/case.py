"""One case of a study: the whole vehicle over one road under constant current, as [Tao2025] drives it."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..analysis.settling import settling_time
from ..analysis.vibration import LOWEST, band_limited, rms
from ..road.iso8608 import FADE, LEVEL_UNTIL, Iso8608Road, Isotropic
from ..simulation.open_loop import run_open_loop
from ..simulation.run_in import CannotRoll
from ..simulation.settings import Rates, RunSettings
from ..simulation.simulation import Probe, RunFailed, Simulation
from ..vehicle.sensors import sensors_of
from ..vehicle.step_size import recommended_rate
from ..vehicle.system import Operation

# [Tao2025]: the engine at its maximum; its second order, 70 Hz, moves the mounts by 0.2 mm
ENGINE_SPEED = 2100.0  # r/min
IMPOSED_DISPLACEMENT = True
RATES = Rates()
BAND = LOWEST, 500.0  # Hz, of all RMS values; measured at every physics step
MEASURING = 5.0  # s
PROBES = ("chassis", "powertrain", "rigid")
GOOD = "ok"


@dataclass(frozen=True)
class Case:
    """What distinguishes one run of a study from the next."""

    road_class: str
    speed: float  # m/s
    seed: int  # of the road
    track_phase: float  # part of a pitch by which the right track lies ahead of the left one
    current: float = 1.0  # A, in both coils


@dataclass(frozen=True)
class Result:
    """What a case gave; plain values."""

    status: str  # `GOOD`, or "failed: " and why
    rms: dict[str, tuple[float, float, float]]  # by probe, over `BAND`, body axes, m/s^2; empty where failed
    mean_speed: float | None  # m/s


class Drive(NamedTuple):
    """The settled part of a run, one row a physics step."""

    rate: float  # Hz, of the rows
    time: np.ndarray  # (k,) s
    specific_force: dict  # probe -> (k, 3) body axes, m/s^2
    limited: dict  # probe -> (k, 3) the same within `BAND`
    speed: np.ndarray  # (n,) m/s, one row a control period


def probes(vehicle):
    """Return the measuring points, in the order of `PROBES`.

    Chassis is the hull at the powertrain's rear connection, powertrain its input end, in the middle between the
    mounts [Tao2025]. The third is the hull's own point at the latter place: what a rigid mount would give there.
    """
    rear = vehicle.powertrain.place
    _, powertrain, *_ = sensors_of(vehicle)
    x, y, z = powertrain.place
    return (
        Probe("hull", rear),
        Probe("powertrain", (x, y, z)),
        Probe("hull", (rear[0] + x, rear[1] + y, rear[2] + z)),
    )


def rates_for(vehicle):
    """Return `RATES` with as many physics steps as the vehicle's contacts need."""
    return replace(RATES, physics=max(RATES.physics, recommended_rate(vehicle)))


def settling(speed):
    """Return how long a drive at a speed [m/s] settles before it is measured [s]."""
    return settling_time(speed, LEVEL_UNTIL + FADE)


def prepare(vehicle, case, kind=Simulation):
    """Return the simulation of a case, with its `probes`, and its road.

    `kind` is `Simulation` or a subclass of it.
    """
    operation = Operation(case.speed, ENGINE_SPEED, IMPOSED_DISPLACEMENT, case.track_phase)
    simulation = kind(vehicle, RunSettings(operation, rates_for(vehicle), case.current), probes(vehicle))
    return simulation, rough_road(vehicle, case.road_class, case.seed)


def rough_road(vehicle, road_class, seed):
    """Return a road under the tracks of a vehicle."""
    return Iso8608Road(road_class, seed, LEVEL_UNTIL, FADE, Isotropic(2.0 * vehicle.road_wheels.y))


def record(simulation, road, duration=MEASURING, progress=lambda done: None):
    """Drive what `prepare` gave until it has settled and `duration` [s] more; returns a `Drive`.

    `progress(done)` is called now and then with the control periods done.

    Raises
    ------
    RunFailed
        The state left what the model can describe.
    """
    rates = simulation.settings.rates
    settled = round(settling(simulation.settings.operation.speed) * rates.control)
    run = run_open_loop(simulation, road, settled + round(duration * rates.control), progress)
    force = dict(zip(PROBES, np.moveaxis(run.probed, 1, 0), strict=True))
    # filtered before it is cut, so that the filter's own settling at the start is cut as well
    begin = settled * rates.steps
    limited = {probe: band_limited(values, rates.physics, BAND[1])[begin:] for probe, values in force.items()}
    force = {probe: values[begin:] for probe, values in force.items()}
    time = np.arange(begin + 1, begin + 1 + len(limited[PROBES[0]])) / rates.physics
    return Drive(rates.physics, time, force, limited, run.speed[settled:])


def drive(vehicle, case, duration=MEASURING):
    """Drive a case and return its `Result`; a run that leaves the valid range is a result, too."""
    try:
        measured = record(*prepare(vehicle, case), duration)
    except (CannotRoll, RunFailed) as error:
        return Result(f"failed: {error}", {}, None)
    levels = {probe: tuple(rms(values).tolist()) for probe, values in measured.limited.items()}
    return Result(GOOD, levels, float(measured.speed.mean()))
