"""What of a recording was measured, and in what unit: samples that are none, sensors that measure nothing, g."""

import numpy as np

from .numbers import SENSORS
from .stamps import BLOCK, blocks

NOT_MEASURED = -1.0  # first number of a covariance, REP-145
STANDARD_GRAVITY = 9.80665  # m/s^2
NEAR = 0.15  # relative, by which the mean of a sensor on a slope may differ from gravity
UNITS = {"m/s2": 1.0, "g": STANDARD_GRAVITY}  # m/s^2


def sound_samples(inertial):
    """Return which samples (k,) of an `Inertial` are numbers that were measured, and how many its covariance denies."""
    sound, denied = np.empty(len(inertial.stamp), bool), 0
    for block in blocks(len(sound), BLOCK):
        sound[block] = np.isfinite(inertial.specific_force[block]).all(axis=1)
        if inertial.covariance is not None:
            never = inertial.covariance[block] == NOT_MEASURED
            sound[block] &= ~never
            denied += int(np.count_nonzero(never))
    return sound, denied


def in_unit(recording, unit):
    """Return a `bags.recording.Recording` whose accelerations were recorded in a unit, one of `UNITS`, in m/s².

    A sensor that shows gravity as 9.81 is in m/s² already, whatever was told; a note says so.
    """
    if unit == "m/s2":
        return recording
    changed, notes = {}, list(recording.notes)
    for name, inertial in {**{each: getattr(recording, each) for each in SENSORS}, **recording.sensors}.items():
        if _is_near(_mean(inertial), STANDARD_GRAVITY):
            notes.append(f"{name}: the mean acceleration is that of gravity in m/s² already, not converted")
        else:
            notes.append(f"{name}: converted from {unit} to m/s², times {UNITS[unit]:g}")
            inertial = inertial._replace(specific_force=UNITS[unit] * np.array(inertial.specific_force))
        changed[name] = inertial
    pair = {sensor: changed.pop(sensor) for sensor in SENSORS}
    return recording._replace(**pair, sensors=changed, notes=tuple(notes))


def unit_notes(sensors):
    """Say which sensors look as if they were recorded in g, of their `AxisNumbers` by axis."""
    means = {name: np.linalg.norm([numbers.mean for numbers in axes.values()]) for name, axes in sensors.items()}
    return [
        f"{name}: the mean acceleration is {mean:.3g} where gravity is 9.81 m/s²: the unit seems to be g; use "
        "`--unit g`"
        for name, mean in means.items()
        if _is_near(mean, 1.0)
    ]


def _is_near(mean, gravity):
    return abs(mean / gravity - 1.0) <= NEAR  # false for nan


def _mean(inertial):
    """Return the length of the mean specific force."""
    total, count, (sound, _) = np.zeros(3), 0, sound_samples(inertial)
    for block in blocks(len(sound), BLOCK):
        counting = inertial.specific_force[block][sound[block]]
        total, count = total + counting.sum(axis=0), count + len(counting)
    return float(np.linalg.norm(total)) / count if count else np.nan
