"""Reads what the analysis needs out of a bag."""

from array import array
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.exceptions import McapError
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.rosbag2 import ReaderError

from ..simulation.settings import NANO
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
    counts, diagnostics = Counter(), {}
    columns = {"chassis/imu": array("d"), "powertrain/imu": array("d"), "coil_current": array("d")}
    stamps = {end: array("q") for end in columns}
    with AnyReader(files) as reader:
        ends = {c.topic: next((end for end in columns if c.topic.endswith(end)), None) for c in reader.connections}
        for connection, _, data in reader.messages():
            topic, end = connection.topic, ends[connection.topic]
            counts[topic] += 1
            if end is None and not topic.endswith("diagnostics"):
                continue
            message = reader.deserialize(data, connection.msgtype)
            if end is None:
                diagnostics |= _of_simulator(message)
            elif end == "coil_current":
                stamps[end].append(_time(message.sample_stamp))
                columns[end].extend(message.current)
            else:
                a, w = message.linear_acceleration, message.angular_velocity
                stamps[end].append(_time(message.header.stamp))
                columns[end].extend((a.x, a.y, a.z, w.x, w.y, w.z))
    missing = [end for end in columns if not columns[end]]
    if missing:
        raise BagError(f"bag {str(path)!r} holds no messages on {', '.join(missing)}")
    return Drive(
        chassis=_inertial(stamps["chassis/imu"], columns["chassis/imu"]),
        powertrain=_inertial(stamps["powertrain/imu"], columns["powertrain/imu"]),
        answered=np.array(stamps["coil_current"]),
        current=np.array(columns["coil_current"]).reshape(-1, 2),
        diagnostics=diagnostics,
        provenance=_provenance(files[0]),
        counts=counts,
    )


def _of_simulator(message):
    """Return the values of the simulator's status, if the message holds it."""
    return {pair.key: pair.value for each in message.status if each.name == "simulator" for pair in each.values}


def _provenance(file):
    with file.open("rb") as stream:
        return {record.name: dict(record.metadata) for record in make_reader(stream).iter_metadata()}


def _inertial(stamps, columns):
    values = np.array(columns).reshape(-1, 6)
    return Inertial(np.array(stamps), values[:, :3], values[:, 3:])


def _time(stamp):
    return stamp.sec * NANO + stamp.nanosec
