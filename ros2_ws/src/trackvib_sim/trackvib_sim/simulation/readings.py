"""What the sensors read: of each the mean over its own periods."""

from typing import NamedTuple

import numpy as np


class Reading(NamedTuple):
    """Mean of one sensor over its last periods."""

    specific_force: np.ndarray  # (3,) body axes, m/s^2
    angular_velocity: np.ndarray  # (3,) body axes, rad/s


class Readings:
    """Follows the sensors of a `Simulation` from period to period; they are in the order of its sample's rows."""

    def __init__(self, simulation):
        self._simulation = simulation
        self._sums = np.zeros((len(simulation.sensors), 2, 3))

    def take(self):
        """Take in the last period, once; returns by name the `Reading` of each sensor whose turn it is."""
        simulation, due = self._simulation, {}
        periods, force, rate = simulation.periods, simulation.sample.specific_force, simulation.sample.angular_velocity
        for row, sensor in enumerate(simulation.sensors):
            name, divisor = sensor.name, sensor.divisor
            if divisor == 1:
                due[name] = Reading(force[row], rate[row])
                continue
            total = self._sums[row]
            if periods % divisor == 1:  # also after a reset
                total[:] = 0.0
            total += force[row], rate[row]
            if periods % divisor == 0:
                due[name] = Reading(*(total / divisor))
        return due
