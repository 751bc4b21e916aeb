"""Where the vehicle was by whatever tells it: odometry under any name, or the fixes of a satellite receiver."""

from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base import topics

from ..numerics.units import NANO
from .columns import Columns, Topic
from .recording import Odometry

NAV_SAT_FIX_TYPE = "sensor_msgs/msg/NavSatFix"
EARTH = 6_371_000.0  # m, mean radius: good to 0.3 %
_SMOOTHED = 1.0  # s, over which fixes are averaged before they become a speed


class _Fixes(NamedTuple):
    """Fixes of a satellite receiver."""

    stamp: np.ndarray  # (k,) ns
    latitude: np.ndarray  # (k,) deg
    longitude: np.ndarray  # (k,) deg
    altitude: np.ndarray  # (k,) m


ODOMETRY_COLUMNS = Columns(
    topics.ODOMETRY_TYPE,
    Odometry,
    {"stamp": "header.stamp", "position": ("pose.pose.position", (3,)), "speed": ("twist.twist.linear.x", ())},
)
_FIX_COLUMNS = Columns(
    NAV_SAT_FIX_TYPE,
    _Fixes,
    {"stamp": "header.stamp", **{name: (name, ()) for name in ("latitude", "longitude", "altitude")}},
)
PLACE_TYPES = {topics.ODOMETRY_TYPE: ODOMETRY_COLUMNS, NAV_SAT_FIX_TYPE: _FIX_COLUMNS}


class Places:
    """What has been read of topics that tell places, beside the odometry of our own bags."""

    def __init__(self, by_log):
        self._by_log, self._topics = by_log, {name: {} for name in PLACE_TYPES}

    def take(self, topic, type_name, *messages):
        """Take messages of a topic."""
        of_type = self._topics[type_name]
        of_type.setdefault(topic, Topic(PLACE_TYPES[type_name], self._by_log)).add(*messages)

    def odometry(self):
        """Return an `Odometry` and a note on it, of the one topic that tells most; None and no note without any."""
        for type_name, of_type in self._topics.items():
            for topic in sorted(of_type)[:1]:
                others = f", {len(of_type) - 1} others left out" if len(of_type) > 1 else ""
                note = f"speed and distance are those of {topic} ({type_name.rsplit('/', 1)[-1]}{others})"
                found = of_type[topic].columns()
                if type_name == NAV_SAT_FIX_TYPE:
                    found = odometry_of_fixes(found)
                if found is not None:
                    return found, [note]
        return None, []


def odometry_of_fixes(fixes):
    """Return an `Odometry` of fixes: position east, north, up of the first one, and the speed along the way.

    The speed has no sign, for a fix does not tell forward from backward. None of fewer than two sound fixes.
    """
    columns = np.array([fixes.latitude, fixes.longitude, fixes.altitude])
    stamp = np.array(fixes.stamp)
    sound = np.isfinite(columns[:2]).all(axis=0) & (np.abs(columns[0]) <= 90.0) & (np.abs(columns[1]) <= 360.0)
    sound &= np.append(True, stamp[1:] > np.maximum.accumulate(stamp)[:-1])
    stamp, (latitude, longitude, altitude) = stamp[sound], columns[:, sound]
    if len(stamp) < 2:
        return None
    north = np.radians(latitude - latitude[0]) * EARTH
    east = np.radians((longitude - longitude[0] + 180.0) % 360.0 - 180.0) * EARTH * np.cos(np.radians(latitude[0]))
    time = (stamp - stamp[0]) / NANO
    half = 0.5 * _SMOOTHED
    ends = [np.clip(time + side * half, time[0], time[-1]) for side in (-1.0, 1.0)]
    moved = [np.diff([np.interp(end, time, way) for end in ends], axis=0)[0] for way in (east, north)]
    speed = np.hypot(*moved) / np.maximum(ends[1] - ends[0], 1e-9)
    return Odometry(stamp, np.column_stack((east, north, altitude - altitude[0])), speed)
