"""Reads what the analysis needs out of a bag."""

from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.exceptions import McapError
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.rosbag2 import ReaderError

from .writing import BagError


class Inertial(NamedTuple):
    """One sensor over a run."""

    stamp: np.ndarray  # (k,) ns
    specific_force: np.ndarray  # (k, 3) m/s^2
    rate: np.ndarray  # (k, 3) rad/s


class Drive(NamedTuple):
    """A run as its bag tells it."""

    chassis: Inertial
    powertrain: Inertial
    answered: np.ndarray  # (m,) stamp of the sample that each current answers, ns
    current: np.ndarray  # (m, 2) demanded, A
    diagnostics: dict  # last values of the simulator, as text
    provenance: dict  # metadata records of the bag
    counts: Counter  # messages a topic


def read_drive(path):
    """Return the `Drive` in a bag folder; topics are found by the ends of their names.

    Raises
    ------
    BagError
        The bag cannot be opened, or a topic is missing.
    """
    path = Path(path)
    try:
        return _read(path)
    except (OSError, McapError, AnyReaderError, ReaderError) as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None


def _read(path):
    # files by name rather than the folder: a bag that was cut short has no metadata.yaml
    files = sorted(path.glob("*.mcap"))
    if not files:
        raise BagError(f"bag {str(path)!r} holds no .mcap file")
    rows = {"chassis/imu": [], "powertrain/imu": [], "coil_current": [], "diagnostics": []}
    counts = Counter()
    with AnyReader(files) as reader:
        topics = {c.topic: next((end for end in rows if c.topic.endswith(end)), None) for c in reader.connections}
        for connection, _, data in reader.messages():
            counts[connection.topic] += 1
            end = topics[connection.topic]
            if end is not None:
                rows[end].append(reader.deserialize(data, connection.msgtype))
    missing = [end for end in ("chassis/imu", "powertrain/imu", "coil_current") if not rows[end]]
    if missing:
        raise BagError(f"bag {str(path)!r} holds no messages on {', '.join(missing)}")
    last = rows["diagnostics"][-1].status[0].values if rows["diagnostics"] else []
    return Drive(
        chassis=_inertial(rows["chassis/imu"]),
        powertrain=_inertial(rows["powertrain/imu"]),
        answered=np.array([_time(m.sample_stamp) for m in rows["coil_current"]]),
        current=np.array([m.current for m in rows["coil_current"]]),
        diagnostics={pair.key: pair.value for pair in last},
        provenance=_provenance(files[0]),
        counts=counts,
    )


def _provenance(file):
    with file.open("rb") as stream:
        return {record.name: dict(record.metadata) for record in make_reader(stream).iter_metadata()}


def _inertial(messages):
    return Inertial(
        np.array([_time(m.header.stamp) for m in messages]),
        np.array([(m.linear_acceleration.x, m.linear_acceleration.y, m.linear_acceleration.z) for m in messages]),
        np.array([(m.angular_velocity.x, m.angular_velocity.y, m.angular_velocity.z) for m in messages]),
    )


def _time(stamp):
    return stamp.sec * 1_000_000_000 + stamp.nanosec
