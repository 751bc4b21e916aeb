"""What the sensors read: of each, in its turn, what its low-pass gives, with the errors of its instruments."""

from math import sqrt
from typing import NamedTuple

import numpy as np


class Reading(NamedTuple):
    """One sample of one sensor."""

    specific_force: np.ndarray  # (3,) sensor axes, m/s^2
    angular_velocity: np.ndarray  # (3,) sensor axes, rad/s


class Readings:
    """Follows the sensors of a `Simulation` from period to period; they are in the order of its sample's rows.

    Noise is the same in every run: that of a sensor depends on its place in that order only.
    """

    def __init__(self, simulation):
        self._simulation = simulation
        self._random = {}

    def take(self):
        """Take in the last period, once; returns by name the `Reading` of each sensor whose turn it is."""
        simulation, due = self._simulation, {}
        periods, force, rate = simulation.periods, simulation.sample.specific_force, simulation.sample.angular_velocity
        for row, sensor in enumerate(simulation.sensors):
            if periods % sensor.divisor == 0:
                parts = (sensor.accelerometer, force[row]), (sensor.gyroscope, rate[row])
                due[sensor.name] = Reading(
                    *(
                        values if instrument.is_ideal else self._read(row, sensor.divisor, instrument, values)
                        for instrument, values in parts
                    )
                )
        return due

    def _read(self, row, divisor, instrument, values):
        simulation = self._simulation
        if simulation.periods == divisor or row not in self._random:  # also after a reset
            self._random[row] = np.random.default_rng(row)
        noise = noise_level(instrument, simulation.settings.rates.control / divisor)
        values = values + instrument.bias + noise * self._random[row].standard_normal(3)
        values = np.clip(values, -instrument.range, instrument.range)
        step = instrument.resolution
        return step * np.round(values / step) if step else values


def noise_level(instrument, rate):
    """Return the standard deviation of an `Instrument`'s noise at a sampling rate [Hz], which ends at half of it."""
    return instrument.noise * sqrt(0.5 * rate)
