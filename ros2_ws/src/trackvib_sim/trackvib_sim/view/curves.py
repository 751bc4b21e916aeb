"""What is plotted beside the vehicle: accelerations, currents, forces, and spectra that go along with the time."""

import numpy as np
import rerun as rr
from mr_mount_controller.node_base import topics

from ..analysis.report.thinning import thinned
from ..analysis.vibration import psd
from ..numerics.units import NANO
from ..scene.colours import OTHER_SENSOR, SENSORS, of_load
from .vehicle_log import GRAVITY_UP, TIMELINE, send_columns

ACCELERATION, CURRENT, FORCE, SPECTRUM = "vertical_acceleration", "coil_current", "mount_force", "spectrum"
_MOST_POINTS = 60_000  # of a curve
_WINDOW, _EVERY = 1.0, 0.1  # s over which a spectrum is taken, and from one to the next
_HIGHEST = 200.0  # Hz


def log_curves(stream, recording, names, first, last):
    """Write all curves of a `Recording` from a time to another [s]; `names` are those of the mounts."""
    of_sensors = {"chassis": recording.chassis, "powertrain": recording.powertrain}
    for name, sensor in of_sensors.items():
        vertical = sensor.specific_force[:, 2] - GRAVITY_UP[2]
        line = (f"{ACCELERATION}/{name}", f"{name}, m/s^2", SENSORS[name])
        _curve(stream, line, sensor.stamp, vertical, first, last)
        _spectra(stream, name, sensor.stamp, vertical, first, last)
    mounts = recording.mounts
    if mounts is None:
        return
    for k in range(mounts.current.shape[1]):
        line = (f"{CURRENT}/{names[k]}", f"{names[k]}, A", _colour(k, len(names)))
        _curve(stream, line, mounts.stamp, mounts.current[:, k], first, last)
    for k in range(mounts.force.shape[1]):
        line = (f"{FORCE}/{names[k]}", f"{names[k]}, kN upwards", _colour(k, len(names)))
        _curve(stream, line, mounts.stamp, 1e-3 * mounts.force[:, k, 2], first, last)


def log_now(stream, path, time, value):
    """Write the next point of a curve at a time (1,) [ns]."""
    send_columns(stream, path, time, rr.Scalars.columns(scalars=np.array([value])))


def _colour(number, count):
    return tuple(of_load(number / max(count - 1, 1)).tolist()) if count > 1 else OTHER_SENSOR


def _curve(stream, line, stamp, values, first, last):
    path, words, colour = line
    stream.log(path, rr.SeriesLines(colors=[colour], names=[words], widths=[1.0]), static=True)
    shown = (stamp >= first * NANO) & (stamp <= last * NANO)
    # floats of 32 bits for the times would be too coarse
    index, value = thinned(np.arange(shown.sum(), dtype=float), values[shown], np.inf, _MOST_POINTS)
    send_columns(stream, path, stamp[shown][index.astype(np.int64)], rr.Scalars.columns(scalars=value))


def _spectra(stream, name, stamp, values, first, last):
    """Square root of the power spectral density over the last second, every tenth of one."""
    if len(stamp) < 2:
        return
    rate = NANO / float(np.median(np.diff(stamp)))
    path = f"{SPECTRUM}/{name}"
    for end in np.arange(first + _WINDOW, last + 1e-9, _EVERY):
        low, high = np.searchsorted(stamp, ((end - _WINDOW) * NANO, end * NANO + 1))
        if high - low < 0.9 * _WINDOW * rate:
            continue
        frequency, density = psd(values[low:high], rate)
        shown = slice(1, int(np.searchsorted(frequency, _HIGHEST)))
        stream.set_time(TIMELINE, duration=float(end))
        bars = rr.BarChart(np.sqrt(density[shown]), abscissa=frequency[shown], color=SENSORS[name])
        stream.log(path, bars)
    stream.reset_time()


def sensor_vectors(recording, time):
    """Yield name, times (m,) [ns] and specific force (m, 3) [m/s^2] of every sensor at those of some times it knows."""
    sensors = {"chassis": recording.chassis, "powertrain": recording.powertrain, **recording.sensors}
    for name, sensor in sensors.items():
        if topics.imu_topic(name) in recording.streams and len(sensor.stamp):
            row = np.clip(np.searchsorted(sensor.stamp, time, "right") - 1, 0, None)
            yield name, time, sensor.specific_force[row]
