"""Reads what the analysis needs out of a bag: columns of numbers, an hour of them in a few seconds and bounded memory.

Nothing is done message by message in Python but for the rare topics.
"""

from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.exceptions import McapError
from rosbags.serde import SerdeError
from zstandard import ZstdError

from .cdr_layout import type_store
from .columns import Columns, Topic
from .mcap_chunks import parts, take_apart
from .writing import BagError


class Inertial(NamedTuple):
    """One sensor over a run."""

    stamp: np.ndarray  # (k,) ns
    specific_force: np.ndarray  # (k, 3) m/s^2
    rate: np.ndarray  # (k, 3) rad/s


class Mounts(NamedTuple):
    """Both MR mounts over a run, left first; vectors in the hull's axes, as `trackvib_msgs/MountState` has them."""

    stamp: np.ndarray  # (k,) ns
    current: np.ndarray  # (k, 2) in the coil, A
    stiffness: np.ndarray  # (k, 2) N/m
    damping: np.ndarray  # (k, 2) N s/m
    deflection: np.ndarray  # (k, 2, 3) from the unloaded place, m
    velocity: np.ndarray  # (k, 2, 3) m/s
    force: np.ndarray  # (k, 2, 3) on the powertrain, N
    dissipated_power: np.ndarray  # (k, 2) W


class Answers(NamedTuple):
    """What the controller asked for."""

    sample_stamp: np.ndarray  # (m,) stamp of the sample that each current answers, ns
    current: np.ndarray  # (m, 2) demanded, A


class Odometry(NamedTuple):
    """Where the hull was."""

    stamp: np.ndarray  # (k,) ns
    position: np.ndarray  # (k, 3) m
    speed: np.ndarray  # (k,) forward, in the hull's axes, m/s


class Recording(NamedTuple):
    """A run as its bag tells it."""

    path: Path
    chassis: Inertial
    powertrain: Inertial
    mounts: Mounts | None
    answers: Answers | None
    odometry: Odometry | None
    diagnostics: dict  # last values of the simulator, as text
    provenance: dict  # metadata records of the bag: name -> dict of text
    counts: Counter  # messages a topic
    vehicle: str | None  # text of the vehicle file


_SENSOR = Columns("sensor_msgs/msg/Imu", Inertial, {
    "stamp": "header.stamp",
    "specific_force": ("linear_acceleration", (3,)),
    "rate": ("angular_velocity", (3,)),
})  # fmt: skip
_BOTH = {name: (name, (2,)) for name in ("current", "stiffness", "damping")}
_VECTORS = {name: (name, (2, 3)) for name in ("deflection", "velocity", "force")}
_COLUMNS = {
    "chassis/imu": _SENSOR,
    "powertrain/imu": _SENSOR,
    "mount_state": Columns("trackvib_msgs/msg/MountState", Mounts, {
        "stamp": "header.stamp", **_BOTH, **_VECTORS, "dissipated_power": ("dissipated_power", (2,)),
    }),
    "coil_current": Columns("trackvib_msgs/msg/CoilCurrent", Answers, {
        "sample_stamp": "sample_stamp", "current": ("current", (2,)),
    }),
    "odometry": Columns("nav_msgs/msg/Odometry", Odometry, {
        "stamp": "header.stamp", "position": ("pose.pose.position", (3,)), "speed": ("twist.twist.linear.x", ()),
    }),
}  # fmt: skip
_NEEDED = ("chassis/imu", "powertrain/imu")
_DIAGNOSTICS, _DESCRIPTION = "diagnostics", "vehicle_description"
_TYPES = {end: columns.type_name for end, columns in _COLUMNS.items()} | {
    _DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray",
    _DESCRIPTION: "std_msgs/msg/String",
}
# mcap raises plain ValueErrors as well, lz4 RuntimeErrors
_READ_ERRORS = (OSError, McapError, ZstdError, SerdeError, ValueError, RuntimeError)


def read_recording(path, follow=lambda done, total: None):
    """Return the `Recording` in a bag: a folder with MCAP files, or one such file, as far as it is whole.

    Topics are found by the ends of their names. Of several that end alike the one beside the sensors counts.

    Parameters
    ----------
    path : path
    follow : callable
        Is told now and then how many bytes of how many have been read.

    Raises
    ------
    BagError
        The bag cannot be read, holds no Imu messages of one of the sensors, or those of several vehicles.
    """
    path, reading = Path(path), _Reading()
    try:
        # files by name rather than by metadata.yaml, which a bag that was cut short does not have
        files = [path] if path.is_file() else sorted(path.glob("*.mcap"), key=lambda each: (len(each.name), each.name))
        total, done = sum(file.stat().st_size for file in files), 0
        for file in files:
            reading.read(file, lambda end, before=done: follow(before + end, total))
            done += file.stat().st_size
    except _READ_ERRORS as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {str(error) or type(error).__name__}") from None
    if not files:
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'is not there'}")
    follow(total, total)
    return reading.recording(path)


class _Reading:
    """What has been read of a bag."""

    def __init__(self):
        self._topics = {}  # name -> Topic, of those that are columns
        self._provenance, self._counts = {}, Counter()
        self._diagnostics, self._vehicle = {}, None

    def read(self, file, follow):
        """Read one file; ids of schemas and channels are its own."""
        schemas, channels, stores = {}, {}, {}
        with file.open("rb") as stream:
            for part in parts(stream, self._provenance):
                messages = take_apart(part.data, schemas, channels)
                for channel_id in np.unique(messages.channel).tolist():
                    channel = channels.get(channel_id)
                    schema = schemas.get(channel.schema_id) if channel else None
                    if schema is None:
                        raise ValueError(f"messages on channel {channel_id}, which nothing announces")
                    of_channel = messages.channel == channel_id
                    start, size = messages.start[of_channel], messages.size[of_channel]
                    self._counts[channel.topic] += len(start)
                    end = next((end for end in _TYPES if channel.topic.endswith(f"/{end}")), None)
                    if end is not None and schema.name == _TYPES[end]:
                        if schema.id not in stores:
                            stores[schema.id] = type_store(schema.name, schema.encoding, schema.data)
                        self._take(channel.topic, end, stores[schema.id], part.data, start, size)
                follow(part.end)

    def _take(self, topic, end, store, data, start, size):
        if end in _COLUMNS:
            if topic not in self._topics:
                self._topics[topic] = Topic(_COLUMNS[end])
            self._topics[topic].add(store, data, start, size)
            return
        for first, length in zip(start.tolist(), size.tolist(), strict=True):
            message = store.deserialize_cdr(data[first : first + length].data, _TYPES[end])
            if end == _DESCRIPTION:
                self._vehicle = message.data
            else:
                self._diagnostics |= _of_simulator(message)

    def recording(self, path):
        """Return it all."""
        found = {end: [topic for topic in self._topics if topic.endswith(f"/{end}")] for end in _COLUMNS}
        missing = [end for end in _NEEDED if not found[end]]
        if missing:
            raise BagError(f"bag {str(path)!r} holds no {_SENSOR.type_name} on {', '.join(missing)}")
        space = found["chassis/imu"][0].removesuffix("chassis/imu")
        if any(found[end] != [f"{space}{end}"] for end in _NEEDED):
            several = ", ".join(topic for end in _NEEDED for topic in found[end])
            raise BagError(f"bag {str(path)!r} holds sensors of several vehicles, must be one: {several}")
        columns = []
        for end, topics in found.items():
            topics.sort(key=lambda topic, own=f"{space}{end}": topic != own)
            columns.append(self._topics[topics[0]].columns() if topics else None)
        return Recording(path, *columns, self._diagnostics, self._provenance, self._counts, self._vehicle)


def _of_simulator(message):
    """Return the values of the simulator's status, if the message holds it."""
    return {pair.key: pair.value for each in message.status if each.name == "simulator" for pair in each.values}
