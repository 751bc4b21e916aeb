"""All that drives the vehicle: the records, and what of it comes before and after the forces of a step."""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...numerics.table import interpolate
from .driveline import Driveline, Shaft, build_driveline, crank_speed, new_shaft
from .driver import Driver, Driving, build_driver, new_driving
from .engine import Crank, Engine, build_engine, turn_crank
from .path import Path, follow_path, new_path
from .schedule import Schedule, Wanted, new_wanted, wanted_speed

AHEAD = 1.0  # m of path and road beyond sprockets and idlers


class Drive(NamedTuple):
    """Everything that does not change during a run."""

    schedule: Schedule
    driver: Driver
    engine: Engine
    driveline: Driveline
    reach: float  # m from the hull's origin, either way, of the road that is needed and of the path that is laid


class DriveState(NamedTuple):
    """Everything that does, changed in place."""

    wanted: Wanted
    path: Path
    driving: Driving
    crank: Crank
    shaft: Shaft


def build_drive(vehicle, rows, schedule, imposed_displacement, gears):
    """Return the record for a vehicle; raises as `build_driveline` does."""
    return Drive(
        schedule=schedule,
        driver=build_driver(vehicle, rows),
        engine=build_engine(vehicle, rows, imposed_displacement),
        driveline=build_driveline(vehicle, gears),
        reach=max(abs(vehicle.idlers.x), abs(vehicle.sprockets.x)) + AHEAD,
    )


def new_drive_state(drive):
    """Return the state of a vehicle that is driven at the schedule's first speed."""
    shaft = new_shaft(drive.driveline, drive.schedule.speed[0] / drive.driver.radius)
    speed = crank_speed(drive.driveline, shaft) if drive.driveline.ratio.size else drive.schedule.engine_speed[0]
    crank = Crank(np.zeros(1), np.array([speed]))
    return DriveState(new_wanted(drive.schedule), new_path(), new_driving(), crank, shaft)


def begin_drive(drive, state):
    """Begin time, path and what the drive has done anew, the hull's origin at x = y = 0; returns the state."""
    state = state._replace(path=new_path())
    state.wanted.time[0] = 0.0
    state.driving.done[:] = 0.0
    follow_path(state.path, drive.schedule, state.wanted, 0.0, 0.0, drive.reach)
    return state


@inlined
def end_drive_step(drive, state, x, y, dt):
    """Advance time and crankshaft by dt, and find where the hull's origin, now at x and y [m], is on the path.

    The wanted speed follows the schedule or command as fast as the driver accelerates and brakes.
    """
    wanted, path = state.wanted, state.path
    wanted.time[0] += dt
    follow_path(path, drive.schedule, wanted, x, y, drive.reach)
    most = drive.driver.acceleration_limit
    change = (wanted_speed(drive.schedule, wanted, path.distance[0]) - wanted.speed[0]) / dt
    wanted.acceleration[0] = min(max(change, -most), most)
    wanted.speed[0] += dt * wanted.acceleration[0]

    if drive.driveline.ratio.size > 0:
        speed = crank_speed(drive.driveline, state.shaft)
    else:
        at = path.distance[0] if drive.schedule.by_distance else wanted.time[0]
        speed = interpolate(drive.schedule.at, drive.schedule.engine_speed, at)
    turn_crank(state.crank, speed, dt)
