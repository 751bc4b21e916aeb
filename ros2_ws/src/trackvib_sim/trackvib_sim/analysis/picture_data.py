"""What pictures of a run show: accelerations of both sensors at the same instants."""

from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from .numbers import SENSORS
from .stamps import period_of, start_of
from .vibration import band_limited


class Prepared(NamedTuple):
    """Accelerations of both sensors, ready to be drawn."""

    time: np.ndarray  # (k,) s from the start
    raw: dict  # sensor -> (k, 3) specific force as recorded, m/s^2
    limited: dict  # sensor -> (k, 3) the same, band-limited
    rate: float  # Hz
    settled: np.ndarray  # (k,) bool, False while the run settles


def prepare(recording, settle):
    """Return what pictures show: samples that both sensors have; the first `settle` seconds count as settling."""
    sensors = [getattr(recording, sensor) for sensor in SENSORS]
    rate = NANO / period_of(sensors[0].stamp)
    stamp, *there = np.intersect1d(*(sensor.stamp for sensor in sensors), return_indices=True)
    raw = {name: sensor.specific_force[index] for name, sensor, index in zip(SENSORS, sensors, there, strict=True)}
    time = (stamp - start_of(recording)) / NANO
    limited = {sensor: band_limited(values, rate) for sensor, values in raw.items()}
    return Prepared(time, raw, limited, rate, time > settle)
