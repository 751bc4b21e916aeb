"""One case of the study: the M113, or a variant of it, on one of the reference's roads."""

from dataclasses import dataclass

import numpy as np

from ...simulation.open_loop import CHUNK, run_open_loop
from ...simulation.run_in import CannotRoll
from ...simulation.settings import RunSettings
from ...simulation.simulation import Probe, RunFailed, Simulation
from ...vehicle.sensors import sensors_of
from ...vehicle.system import Operation
from ..case import GOOD, rates_for
from .measures import ROAD_BORNE, levels, within
from .reference import RATE, ROUGH, references, road_of
from .road_share import road_share
from .variants import VARIANTS

CORRELATION, ROAD_SHARE, RESISTANCE = "correlation", "follows the road", "resistance"
TENSIONERS = ("left tensioner", "right tensioner")
_STEP = 0.1  # m between samples of the road-borne part


@dataclass(frozen=True)
class M113Case:
    """What distinguishes one run from the next."""

    variant: str  # one of `VARIANTS`
    road: str
    speed: int  # m/s, nominal
    track_phase: float  # part of a pitch by which the right track lies ahead of the left one


@dataclass(frozen=True)
class M113Result:
    """What a case gave; plain values."""

    status: str  # `GOOD`, or "failed: " and why
    numbers: dict[str, float]  # by name: levels [m/s^2], correlation, tensioners and resistance [N]; empty where failed
    road_borne: list[float]  # part of the acceleration within `ROAD_BORNE`, every 0.1 m from where it is compared


def drive_m113(vehicle, case):
    """Run a case and return its `M113Result`; a run that leaves the valid range is a result, too."""
    reference = references()[case.road, case.speed]
    driven = VARIANTS[case.variant].change(vehicle)
    settings = RunSettings(Operation(reference.speed, 0.0, False, case.track_phase), rates_for(driven), 0.0)
    try:
        chassis, *_ = sensors_of(driven)
        simulation = Simulation(driven, settings, [Probe(chassis.body, chassis.place)])
        vertical, place, forces = _drive(simulation, road_of(case.road), reference)
    except (CannotRoll, RunFailed) as error:
        return M113Result(f"failed: {error}", {}, [])
    numbers = levels(vertical, RATE, reference.speed / vehicle.tracks.pitch)
    grid = places(reference)
    ours = np.interp(grid, place, within(vertical, RATE, ROAD_BORNE))
    numbers[CORRELATION] = float(np.corrcoef(ours, road_borne(reference))[0, 1])
    if case.road == ROUGH:
        numbers[ROAD_SHARE] = road_share(within(vertical, RATE, ROAD_BORNE), place, reference.speed, wheel_x(vehicle))
    numbers |= dict(zip((*TENSIONERS, RESISTANCE), forces.mean(axis=0).tolist(), strict=True))
    return M113Result(GOOD, numbers, ours.round(4).tolist())


def places(reference):
    """Return where the road-borne parts are compared, (g,) m along the road."""
    return np.arange(reference.start + _STEP, reference.place[-1] - _STEP, _STEP)


def road_borne(reference):
    """Return the reference's part of the acceleration within `ROAD_BORNE` at `places`, (g,) m/s^2."""
    return np.interp(places(reference), reference.place, within(reference.vertical, RATE, ROAD_BORNE))


def wheel_x(vehicle):
    """Return the places of the axles along the hull, (2, n) m, left and right."""
    arms = vehicle.swing_arms
    return np.array([arms.wheel_x, arms.right_wheel_x])


def _drive(simulation, road, reference):
    """Return vertical specific forces (k,) and places (k,) along the reference's way, and forces (chunks, 3) [N].

    Forces are those of both tensioners and of the driver.
    """
    before = round(reference.start / reference.speed * RATE / CHUNK) * CHUNK
    tensioner, state = simulation.system.tracks.tensioner, simulation.state
    begun, distances, forces = [0], [simulation.distance], []

    def look(periods):
        begun.append(periods)
        distances.append(simulation.distance)
        pushed = tensioner.preload - tensioner.stiffness * state.tracks.tensioner.travel
        forces.append([*np.abs(pushed), state.drive.driving.speed_integral[0]])

    run = run_open_loop(simulation, road, before + len(reference.vertical), look)
    place = np.interp(np.arange(len(run.time)), begun, distances)
    vertical = run.probed[:, 0, 2].reshape(len(run.time), -1).mean(axis=1)  # as the reference has it
    return vertical[before:], place[before:], np.array(forces[before // CHUNK :])
