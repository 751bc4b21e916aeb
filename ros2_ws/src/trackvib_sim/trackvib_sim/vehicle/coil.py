"""Driver and coil of the mounts: a first-order lag with the current limits of the driver."""

from math import exp
from typing import NamedTuple

import numpy as np

from ..rui.compiled import kernel


class Coil(NamedTuple):
    """Both mounts have the same driver and coil."""

    decay: float  # exp(-dt / time constant) of one physics step
    lowest: float  # A
    highest: float  # A


def coil(vehicle, dt):
    """Return the record for steps of dt [s]."""
    return Coil(exp(-dt / vehicle.coil.time_constant), *vehicle.coil.current_limits)


def usable_current(vehicle):
    """Return the range of demanded current that neither the driver nor the fits of the mounts cut [A]."""
    limits, fits = vehicle.coil.current_limits, vehicle.mr_mounts.current_range
    return np.array([max(limits[0], fits[0]), min(limits[1], fits[1])])


@kernel
def drive_coils(coil, demanded, currents):
    """Let both coil currents follow the demanded ones for one step; exact for a constant demand."""
    for i in range(currents.size):
        target = min(max(demanded[i], coil.lowest), coil.highest)
        currents[i] = target + (currents[i] - target) * coil.decay
