"""What a recording says about the loop: its losses, and what the simulator counted."""

import numpy as np

from ..vehicle.mount_energy import MountEnergy
from .numbers import SENSORS
from .stamps import losses

DRIVE = ("drive_work_J", "way_m", "time")  # likewise
LEAST_WAY = 1.0  # m, below which no force is told
MOUNTS = tuple(f"mount_{part}_J" for part in MountEnergy._fields)  # in the simulator's diagnostics


def loop_health(recording):
    """Return the `losses`, and what the simulator reported last as text, but for work and way."""
    other = (*MOUNTS, *DRIVE[:2])
    lost = losses(recording)
    if recording.origins:  # of a sensor that is not there nothing is lost
        lost |= {f"lost_{sensor}": None for sensor in SENSORS if sensor not in recording.origins}
    return lost | {key: text for key, text in recording.diagnostics.items() if key not in other}


def drive(recording):
    """Return mean force [N] and power [W] of the drive up to the simulator's final diagnostics, nan if unknown."""
    work, way, time = (float(recording.diagnostics.get(key, "nan")) for key in DRIVE)
    return work / way if abs(way) >= LEAST_WAY else np.nan, work / time if time > 0.0 else np.nan


def mount_energy(recording):
    """Return where the work on the mounts went, as the simulator reported at its end: a `MountEnergy`, or None."""
    values = [recording.diagnostics.get(key) for key in MOUNTS]
    return None if None in values else MountEnergy(*map(float, values))
