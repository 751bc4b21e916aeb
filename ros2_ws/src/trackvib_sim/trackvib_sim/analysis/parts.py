"""Parts of the time that counts, by where the vehicle was and by how fast it drove, and the levels in each."""

from typing import NamedTuple

import numpy as np

from .history import bin_means
from .motion import engine_speed_of, speed_of, way_of
from .numbers import AXES, INTERVAL, SENSORS, SPEED_BAND, SpeedBand, WayInterval

KINDS = {"by_way": WayInterval, "by_speed": SpeedBand}
GREATEST = 1e12  # widths
MOST = 3600  # parts; of longer ways the intervals are longer


class Parts(NamedTuple):
    """Parts of a run by the value of a slow signal, between neighbouring edges each."""

    signal: NamedTuple  # `motion.Slow`
    edges: np.ndarray  # (n + 1,) rising

    @property
    def count(self):
        """How many parts there are."""
        return len(self.edges) - 1

    def sums(self, stamp, values):
        """Return how many samples (n,) at stamps (k,) [ns] are in each part, and the sums (n, m) of values (k, m)."""
        index = np.searchsorted(self.edges, self.signal.at(stamp), side="right") - 1
        inside = (index >= 0) & (index < self.count)  # nan sorts behind all edges
        index, values = index[inside], values[inside]
        columns = [np.bincount(index, column, self.count) for column in values.T]
        return np.bincount(index, minlength=self.count), np.reshape(columns, (-1, self.count)).T


def build_parts(recording, settled, interval=INTERVAL, speed_band=SPEED_BAND):
    """Return the `Parts` of a recording, "by_way" and "by_speed" as far as the bag tells them.

    Parameters
    ----------
    recording : Recording
    settled : int
        Stamp after which samples count, ns.
    interval : float
        Length of the intervals of way, m.
    speed_band : float
        Width of the bands of speed, m/s. A speed that stays within one width is one band.
    """
    way, speed = way_of(recording), speed_of(recording)
    by_way, by_speed = parts_by(way, settled, interval), parts_by(speed, settled, speed_band)
    if by_speed is not None and np.ptp(counting := speed.after(settled).value) < speed_band:
        by_speed = Parts(speed, np.array((counting.min(), np.nextafter(counting.max(), np.inf))))
    return {name: parts for name, parts in (("by_way", by_way), ("by_speed", by_speed)) if parts is not None}


def parts_by(signal, settled, width):
    """Return the `Parts` of a `motion.Slow` signal that are whole multiples of a width.

    They reach over what the signal is after the stamp `settled` [ns]. Without a signal, or of one with values so great
    that numbers cannot tell such parts apart, there are none: None.
    """
    counting = np.empty(0) if signal is None else signal.after(settled).value
    if not len(counting) or not np.abs(counting).max() < GREATEST * width:
        return None
    first, last = (int(np.floor(each / width)) for each in (counting.min(), counting.max()))
    wider = -(-(last - first + 1) // MOST)  # whole multiples, as `levels.build_bins` has them
    first, last = first // wider, last // wider
    return Parts(signal, np.arange(first, last + 2) * (width * wider))


def numbers_in_parts(parts_by_name, levels, recording, segments):
    """Return the `WayInterval`s "by_way" and the `SpeedBand`s "by_speed" in which anything was measured.

    `parts_by_name` are those of `build_parts`, with which the `Levels` by sensor were summed up.
    """
    return {
        name: tuple(_filled(kind, parts_by_name[name], levels, name, recording, segments))
        if name in parts_by_name
        else ()
        for name, kind in KINDS.items()
    }


def _filled(kind, parts, levels, name, recording, segments):
    rate = levels[SENSORS[0]].rate
    levels = {sensor: found.parts()[name] for sensor, found in levels.items()}
    means = []
    for slow in (speed_of(recording), engine_speed_of(recording)):
        counting = None if slow is None else slow.after(segments.settled)
        mean = np.full(parts.count, np.nan)
        means.append(mean if counting is None else bin_means(parts, counting.stamp, counting.value[:, None])[0][:, 0])
    seconds = levels[SENSORS[0]].count / rate
    for k in np.flatnonzero(seconds > 0.0):
        yield kind(
            low=float(parts.edges[k]),
            high=float(parts.edges[k + 1]),
            measured=float(seconds[k]),
            speed=float(means[0][k]),
            engine_speed=float(means[1][k]),
            rms={sensor: _by_axis(found.rms[k]) for sensor, found in levels.items()},
            rms_weighted={sensor: _by_axis(found.rms_weighted[k]) for sensor, found in levels.items()},
            absorbed_power={sensor: float(found.absorbed_power[k]) for sensor, found in levels.items()},
        )


def _by_axis(levels):
    return dict(zip(AXES, levels.tolist(), strict=True))
