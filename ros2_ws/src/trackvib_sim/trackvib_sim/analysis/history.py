"""Levels along a whole bag, settling included, in bins of equal length."""

import numpy as np

from .numbers import SENSORS, History
from .stamps import BLOCK, blocks


def build_history(recording, bins, levels):
    """Return the `History` of a recording over `levels.Bins`, given the `Levels` by sensor."""
    of_sensors = {sensor: levels[sensor].history() for sensor in SENSORS}
    mounts, odometry = recording.mounts, recording.odometry
    mounting = recording.mounting
    current = np.full((bins.count, mounting.coils), np.nan)
    power = travel = np.full((bins.count, len(mounting.mounts)), np.nan)
    speed = np.full(bins.count, np.nan)
    if mounts is not None:
        current, power = (bin_means(bins, mounts.stamp, each)[0] for each in (mounts.current, mounts.dissipated_power))
        travel = bin_means(bins, mounts.stamp, mounts.deflection[:, :, 2])[1]
    if odometry is not None:
        speed = bin_means(bins, odometry.stamp, odometry.speed[:, None])[0][:, 0]
    by_sensor = (
        {sensor: getattr(found, name) for sensor, found in of_sensors.items()}
        for name in ("rms", "rms_weighted", "absorbed_power")
    )
    return History(bins.middle, *by_sensor, speed, current, power, travel, mounting.names)


def bin_means(bins, stamp, values):
    """Return mean and standard deviation (n, m) of columns (k, m) in each of `levels.Bins` or `parts.Parts`."""
    count = np.zeros(bins.count)
    total, squares = np.zeros((2, bins.count, values.shape[1]))
    for block in blocks(len(stamp), BLOCK):
        within = np.array(values[block])
        in_bin, sums = bins.sums(stamp[block], np.hstack((within, np.square(within))))
        count += in_bin
        total += sums[:, : within.shape[1]]
        squares += sums[:, within.shape[1] :]
    count = np.where(count > 0, count, np.nan)[:, None]
    mean = total / count
    return mean, np.sqrt(np.maximum(squares / count - mean**2, 0.0))
