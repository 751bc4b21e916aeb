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
_WINDOW, _EVERY = NANO, NANO // 10  # ns over which a spectrum is taken, and from one to the next
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
    """Write points (k,) of a curve at times (k,) [ns], thinned where there are very many."""
    # numbers of samples in place of times: these would not fit 32 bits
    index, value = thinned(np.arange(len(values), dtype=float), values, np.inf, _MOST_POINTS)
    send_columns(stream, f"{kind}/{name}", time[index.astype(np.int64)], rr.Scalars.columns(scalars=value))


def log_curves(stream, recording, names, first, last):
    """Write the curves of a `Recording` from a time to another [ns]; `names` are those of the mounts."""
    accelerations, mounts = Accelerations(stream), recording.mounts
    for name, sensor in ((CHASSIS, recording.chassis), (POWERTRAIN, recording.powertrain)):
        shown = _between(first, last, sensor.stamp)
        accelerations.add(name, sensor.stamp[shown], sensor.specific_force[shown])
    if mounts is not None:
        shown = _between(first, last, mounts.stamp)
        add_mounts(stream, names, mounts.stamp[shown], mounts.current[shown], mounts.force[shown, :, 2])


def _between(first, last, stamps):
    return (stamps >= first) & (stamps <= last)


def add_mounts(stream, names, time, current, force):
    """Write currents (k, coils) [A] and forces (k, m) [N] of mounts called `names` at times (k,) [ns]."""
    for name, values in zip(names, current.T, strict=False):
        add_points(stream, CURRENT, name, time, values)
    for name, values in zip(names, force.T, strict=True):
        add_points(stream, FORCE, name, time, 1e-3 * values)


class Accelerations:
    """Vertical accelerations of hull and powertrain and their spectra, written to a stream as samples come."""

    def __init__(self, stream):
        self._stream = stream
        self._spectra = {name: _MovingSpectrum(stream, name) for name in (CHASSIS, POWERTRAIN)}

    def add(self, name, time, specific_force):
        """Write the next samples of a sensor, specific force (k, 3) [m/s^2] at times (k,) [ns], if it is shown."""
        if name in self._spectra and len(time):
            vertical = specific_force[:, 2] - GRAVITY_UP[2]
            add_points(self._stream, ACCELERATION, name, time, vertical)
            self._spectra[name].add(time, vertical)


class _MovingSpectrum:
    """Square root of the power spectral density over the last second, every tenth of one."""

    def __init__(self, stream, name):
        self._stream, self._name = stream, name
        self._begin_anew()

    def add(self, time, values):
        """Take samples (k,) at times (k,) [ns], and write every spectrum that they complete."""
        for part in np.split(np.arange(len(time)), np.flatnonzero(np.diff(time) <= 0) + 1):
            if len(self._time) and time[part[0]] <= self._time[-1]:
                self._begin_anew()  # after a reset
            self._time = np.concatenate((self._time, time[part]))
            self._values = np.concatenate((self._values, values[part]))
            self._write()

    def _begin_anew(self):
        self._time, self._values, self._end = np.zeros(0, np.int64), np.zeros(0), None

    def _write(self):
        if self._end is None:
            self._end = self._time[0] // _EVERY * _EVERY + _WINDOW
        while self._end <= self._time[-1]:
            low, high = np.searchsorted(self._time, (self._end - _WINDOW, self._end), "right")
            self._show(slice(low, high))
            self._end += _EVERY
        left = np.searchsorted(self._time, self._end - _WINDOW, "right")
        self._time, self._values = self._time[left:], self._values[left:]

    def _show(self, window):
        time = self._time[window]
        if len(time) < 2:
            return
        period = float(np.median(np.diff(time)))
        if time[0] - period > self._end - _WINDOW or len(time) < 0.9 * _WINDOW / period:
            return
        frequency, density = psd(self._values[window], NANO / period)
        shown = slice(1, int(np.searchsorted(frequency, _HIGHEST)))
        self._stream.set_time(TIMELINE, duration=np.timedelta64(self._end, "ns"))
        bars = rr.BarChart(np.sqrt(density[shown]), abscissa=frequency[shown], color=SENSORS[self._name])
        self._stream.log(f"{SPECTRUM}/{self._name}", bars)
        self._stream.reset_time()


def sensor_vectors(recording, time):
    """Yield name and specific force (m, 3) [m/s^2] of every sensor, the latest at some times (m,) [ns]."""
    sensors = {CHASSIS: recording.chassis, POWERTRAIN: recording.powertrain, **recording.sensors}
    for name, sensor in sensors.items():
        if len(sensor.stamp):
            row = np.clip(np.searchsorted(sensor.stamp, time, "right") - 1, 0, None)
            yield name, sensor.specific_force[row]
