"""What is wanted of the driver over time or distance: speed, curvature of the path, speed of the engine."""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import kernel
from ...numerics.table import interpolate
from ...numerics.units import RPM


class Schedule(NamedTuple):
    """Demanded values that change linearly between points and are constant before the first and after the last.

    Over time the curvature is that of the path at the vehicle's front at that time, over distance that of the path.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> import numpy as np
    >>> faster = tv.Schedule(False, np.array([0.0, 5.0]), np.array([5.0, 10.0]), np.zeros(2), np.zeros(2))
    >>> faster.speed.tolist()  # m/s, until 0 s and from 5 s on
    [5.0, 10.0]
    """

    by_distance: bool
    at: np.ndarray  # (m,) s from the start of the run, or m along the path; growing
    speed: np.ndarray  # (m,) m/s, below zero backwards
    curvature: np.ndarray  # (m,) 1/m, to the left
    engine_speed: np.ndarray  # (m,) rad/s of the crankshaft; without effect where gears give it


def constant_schedule(speed, engine_speed):
    """Return the schedule of a run at one speed [m/s] and engine speed [r/min]."""
    return Schedule(False, np.zeros(1), np.array([float(speed)]), np.zeros(1), np.array([engine_speed * RPM]))


def arrival_time(schedule, distance):
    """Return when [s] a vehicle that follows a schedule has come so far [m] either way; infinite if it never does."""
    at, speed = schedule.at, np.abs(schedule.speed)
    if schedule.by_distance:
        inside = np.concatenate([[0.0], at[(at > 0.0) & (at < distance)], [distance]])
        # over a piece where speed grows linearly with distance
        pace, length = np.interp(inside, at, speed), np.diff(inside)
        change = np.diff(pace) / pace[:-1]
        slower = np.divide(np.log1p(change), change, out=np.ones_like(change), where=change != 0.0)
        return float(np.sum(length / pace[:-1] * slower))
    times = np.concatenate([[0.0], at[at > 0.0]])
    pace = np.interp(times, at, speed)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (pace[1:] + pace[:-1]) * np.diff(times))])
    if way[-1] < distance:
        return float(times[-1] + (distance - way[-1]) / pace[-1]) if pace[-1] else np.inf
    return float(np.interp(distance, way, times))


class Wanted(NamedTuple):
    """What is wanted now, changed in place."""

    time: np.ndarray  # (1,) s since the start of the run
    speed: np.ndarray  # (1,) m/s
    acceleration: np.ndarray  # (1,) m/s^2
    command: np.ndarray  # (2,) speed, m/s, and curvature, 1/m, that somebody has asked for in the schedule's stead
    commanded: np.ndarray  # (1,) whether anybody has


def new_wanted(schedule):
    """Return what is wanted at the start of a run."""
    return Wanted(np.zeros(1), schedule.speed[:1].copy(), np.zeros(1), np.zeros(2), np.zeros(1, np.bool_))


@kernel
def wanted_speed(schedule, wanted, distance):
    """Return the wanted speed [m/s] of a vehicle that has come so far along its path [m]."""
    if wanted.commanded[0]:
        return wanted.command[0]
    return interpolate(schedule.at, schedule.speed, distance if schedule.by_distance else wanted.time[0])


@kernel
def wanted_curvature(schedule, wanted, distance):
    """Return the wanted curvature [1/m] of the path at a distance [m] that the vehicle's front reaches now."""
    if wanted.commanded[0]:
        return wanted.command[1]
    return interpolate(schedule.at, schedule.curvature, distance if schedule.by_distance else wanted.time[0])
