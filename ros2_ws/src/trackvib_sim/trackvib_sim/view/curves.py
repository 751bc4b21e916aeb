"""What is plotted beside the vehicle: accelerations, currents, forces, and spectra that go along with the time."""

import numpy as np
import rerun as rr

from ..analysis.report.thinning import thinned
from ..analysis.vibration import psd
from ..numerics.units import NANO
from ..scene.colours import OTHER_SENSOR, SENSORS, of_load
from ..vehicle.parameters import CHASSIS, POWERTRAIN
from .vehicle_log import GRAVITY_UP, TIMELINE, send_columns

ACCELERATION, CURRENT, FORCE, SPECTRUM = "vertical_acceleration", "coil_current", "mount_force", "spectrum"
_MOST_POINTS = 60_000  # of a curve
_WINDOW, _EVERY = 1.0, 0.1  # s over which a spectrum is taken, and from one to the next
_HIGHEST = 200.0  # Hz


def announce_curves(stream, mounts):
    """Write names and colours of all curves; `mounts` are `scene.mounts.MountPlaces`."""
    names = mounts.names
    colours = {name: _colour(k, len(names)) for k, name in enumerate(names)}
    for path, words, colour in (
        *((f"{ACCELERATION}/{name}", name, SENSORS[name]) for name in (CHASSIS, POWERTRAIN)),
        *((f"{CURRENT}/{name}", name, colours[name]) for name in names[: mounts.coils]),
        *((f"{FORCE}/{name}", name, colours[name]) for name in names),
    ):
        stream.log(path, rr.SeriesLines(colors=[colour], names=[words], widths=[1.0]), static=True)


def _colour(number, count):
    return tuple(of_load(number / (count - 1)).tolist()) if count > 1 else OTHER_SENSOR


def add_points(stream, kind, name, time, values):
    """Write points (k,) of a curve at times (k,) [ns]."""
    send_columns(stream, f"{kind}/{name}", time, rr.Scalars.columns(scalars=values))


def log_curves(stream, recording, names, first, last):
    """Write the curves of a `Recording` from a time to another [s]; `names` are those of the mounts."""
    for name, sensor in ((CHASSIS, recording.chassis), (POWERTRAIN, recording.powertrain)):
        vertical = sensor.specific_force[:, 2] - GRAVITY_UP[2]
        _curve(stream, ACCELERATION, name, sensor.stamp, vertical, first, last)
        _spectra(stream, name, sensor.stamp, vertical, first, last)
    mounts = recording.mounts
    if mounts is None:
        return
    for name, current in zip(names, mounts.current.T, strict=False):
        _curve(stream, CURRENT, name, mounts.stamp, current, first, last)
    for name, force in zip(names, mounts.force[:, :, 2].T, strict=True):
        _curve(stream, FORCE, name, mounts.stamp, 1e-3 * force, first, last)


def _curve(stream, kind, name, stamp, values, first, last):
    shown = (stamp >= first * NANO) & (stamp <= last * NANO)
    # numbers of samples in place of times: these would not fit 32 bits
    index, value = thinned(np.arange(shown.sum(), dtype=float), values[shown], np.inf, _MOST_POINTS)
    add_points(stream, kind, name, stamp[shown][index.astype(np.int64)], value)


def _spectra(stream, name, stamp, values, first, last):
    """Square root of the power spectral density over the last second, every tenth of one."""
    if len(stamp) < 2:
        return
    rate = NANO / float(np.median(np.diff(stamp)))
    for end in np.arange(first + _WINDOW, last + 1e-9, _EVERY):
        low, high = np.searchsorted(stamp, ((end - _WINDOW) * NANO, end * NANO + 1))
        if high - low < 0.9 * _WINDOW * rate:
            continue
        frequency, density = psd(values[low:high], rate)
        shown = slice(1, int(np.searchsorted(frequency, _HIGHEST)))
        stream.set_time(TIMELINE, duration=float(end))
        bars = rr.BarChart(np.sqrt(density[shown]), abscissa=frequency[shown], color=SENSORS[name])
        stream.log(f"{SPECTRUM}/{name}", bars)
    stream.reset_time()


def sensor_vectors(recording, time):
    """Yield name and specific force (m, 3) [m/s^2] of every sensor, the latest at some times (m,) [ns]."""
    sensors = {CHASSIS: recording.chassis, POWERTRAIN: recording.powertrain, **recording.sensors}
    for name, sensor in sensors.items():
        if len(sensor.stamp):
            row = np.clip(np.searchsorted(sensor.stamp, time, "right") - 1, 0, None)
            yield name, sensor.specific_force[row]
