"""How the vehicle moved in a recording: speed, way and engine speed as slow signals, as far as the bag tells them."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.ndimage import uniform_filter1d

from ..bags.provenance import parameters_with
from ..numerics.units import NANO
from .mount_numbers import moments
from .stamps import period_of

SMOOTHED = 1.0  # s, over which the speed is averaged: pitch and shocks are no change of speed


class Slow(NamedTuple):
    """A signal that changes little between its samples."""

    stamp: np.ndarray  # (k,) ns, rising
    value: np.ndarray  # (k,)

    def at(self, stamp):
        """Return the values at stamps [ns], nan before the first sample and after the last."""
        return np.interp(stamp, self.stamp, self.value, left=np.nan, right=np.nan)

    def after(self, stamp):
        """Return the signal later than a stamp [ns]."""
        later = self.stamp > stamp
        return Slow(self.stamp[later], self.value[later])


class MeanMotion(NamedTuple):
    """Means over the measured time and standard deviations about them; nan where the bag does not tell them."""

    speed: float  # of the hull, m/s
    speed_deviation: float
    engine_speed: float  # as recorded, else as the simulator was told, r/min
    engine_speed_deviation: float  # 0 where it was only told
    speed_range: tuple  # least and greatest speed over a second, m/s
    engine_speed_range: tuple  # r/min


def speed_of(recording):
    """Return the hull's forward speed [m/s] as a `Slow` signal, averaged over a second; None without odometry."""
    if recording.odometry is None:
        return None
    stamp, value = _rising(recording.odometry.stamp, recording.odometry.speed)
    width = round(SMOOTHED * NANO / period_of(stamp)) if len(stamp) > 1 else 1
    return Slow(stamp, uniform_filter1d(value, max(width, 1), mode="nearest"))


def way_of(recording):
    """Return the distance along the path [m] as a `Slow` signal; None if the bag does not tell it.

    It is that of the drive; without one the integral of the speed by odometry, 0 at its first sample.
    """
    if recording.drive is not None:
        return Slow(*_rising(recording.drive.stamp, recording.drive.distance))
    if recording.odometry is None:
        return None
    stamp, speed = _rising(recording.odometry.stamp, recording.odometry.speed)
    return Slow(stamp, cumulative_trapezoid(speed, (stamp - stamp[:1]) / NANO, initial=0.0) if len(stamp) else speed)


def engine_speed_of(recording):
    """Return the engine's recorded speed [r/min] as a `Slow` signal; None without a recorded drive."""
    if recording.drive is None:
        return None
    return Slow(*_rising(recording.drive.stamp, recording.drive.engine_speed))


def gear_of(recording):
    """Return the engaged gear as a `Slow` signal; None without a recorded drive."""
    if recording.drive is None:
        return None
    return Slow(*_rising(recording.drive.stamp, recording.drive.gear))


def shifts_of(recording):
    """Return the stamps (k,) [ns] at which another gear is first engaged; none without a recorded drive."""
    gear = gear_of(recording)
    return np.empty(0, np.int64) if gear is None else gear.stamp[1:][np.diff(gear.value) != 0.0]


def mean_motion(recording, settled):
    """Return the `MeanMotion` after a stamp [ns]."""
    odometry, engine = recording.odometry, engine_speed_of(recording)
    if engine is None:
        told = float(parameters_with(recording.provenance, "engine_speed")[1].get("engine_speed", "nan"))
        turned, turning = (told, 0.0), (told, told)
    else:
        turned, turning = _moments(engine.stamp, engine.value, settled), _range(engine, settled)
    moved = (np.nan, np.nan) if odometry is None else _moments(odometry.stamp, odometry.speed, settled)
    return MeanMotion(*moved, *turned, _range(speed_of(recording), settled), turning)


def _range(slow, settled):
    value = np.empty(0) if slow is None else slow.after(settled).value
    return (float(value.min()), float(value.max())) if len(value) else (np.nan, np.nan)


def _moments(stamp, values, settled):
    found = moments(stamp, values[:, None], settled)
    return float(found.mean[0]), float(found.deviation[0])


def _rising(stamp, values):
    """Return stamps (k,) and finite values (k,), without samples that are not later than all before them."""
    stamp, values = np.array(stamp), np.array(values, dtype=float)
    finite = np.isfinite(values)
    stamp, values = stamp[finite], values[finite]
    later = np.append(True, stamp[1:] > np.maximum.accumulate(stamp)[:-1]) if len(stamp) else np.empty(0, bool)
    return stamp[later], values[later]
