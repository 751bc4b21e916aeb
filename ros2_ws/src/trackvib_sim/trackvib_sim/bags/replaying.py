"""Reads a recorded drive as it was, to the last bit and in the order of arrival, so that it can be driven again."""

import struct
from array import array
from collections import defaultdict
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.exceptions import EndOfFile, McapError
from mcap.records import Channel, Header, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, TypesysError, get_types_from_msg, get_typestore
from zstandard import ZstdError

from ..simulation.settings import NANO
from .writing import BagError

IMU = ("linear_acceleration", "angular_velocity")
MOUNTS = ("current", "stiffness", "damping", "deflection", "velocity", "force", "dissipated_power")  # left, right
_FIELDS = {"chassis/imu": IMU, "powertrain/imu": IMU, "mount_state": MOUNTS}
_ANSWERS = ("accepted", "late", "duplicate", "not_finite")  # to samples that were out; counts of the diagnostics
_FURTHER = ("coil_current", "road_profile", "vehicle_description", "diagnostics")


class Stream(NamedTuple):
    """Messages of one topic, as rows of numbers."""

    topic: str
    channels: tuple  # (n,) names of the columns
    stamp: np.ndarray  # (k,) ns
    values: np.ndarray  # (k, n)

    @property
    def specific_force(self):
        """(k, 3) of an Imu, m/s^2."""
        return self.values[:, :3]


class RecordedDrive(NamedTuple):
    """A drive as its bag tells it."""

    chassis: Stream
    powertrain: Stream
    mounts: Stream
    answered: np.ndarray  # (a,) stamps of the samples that were answered, ns, in the order of arrival
    current: np.ndarray  # (a, 2) these answers, A
    road: list  # of patches (start, spacing, left, right), m
    vehicle: str  # text of the vehicle file
    told: np.ndarray  # (d, 3) simulated time [ns], silent periods and answers up to then, as the simulator told them
    provenance: dict  # metadata records of the bag
    complete: bool  # False where the bag is cut short


def records(path):
    """Yield the MCAP records of a bag folder in the order in which they were written; nothing is held in memory.

    Raises
    ------
    BagError
        There is no such bag, or it cannot be read at all.
    EndOfFile
        After the last whole chunk, if the bag is cut short or damaged there.
    """
    path = Path(path)
    files = sorted(path.glob("*.mcap"), key=lambda file: (len(file.name), file.name))
    if not files:
        raise BagError(f"bag {str(path)!r} holds no .mcap file")
    try:
        for file in files:
            with file.open("rb") as stream:
                yield from StreamReader(stream, validate_crcs=True).records
    except (struct.error, ZstdError, CRCValidationError) as error:  # a record or a chunk stops in the middle
        raise EndOfFile(str(error)) from None
    except EndOfFile:
        raise
    except (OSError, McapError, ValueError) as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None


def read_recorded_drive(path):
    """Return the `RecordedDrive` in a bag folder; topics are found by the ends of their names.

    Raises
    ------
    BagError
        The bag cannot be read, lacks a topic, holds it twice, or holds more than one run.
    """
    gathered = _Gathered()
    complete = True
    try:
        for record in records(path):
            gathered.take(record)
    except EndOfFile:
        complete = False
    except (TypesysError, SerdeError) as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None
    try:
        return gathered.recording(complete)
    except ValueError as error:
        raise BagError(f"bag {str(path)!r} {error}") from None


class _Gathered:
    """What has been read so far."""

    def __init__(self):
        self._schemas, self._topics = {}, {}  # by number: name of the type, and (end of the topic, type)
        self._names = defaultdict(set)  # end -> topics
        self._store = get_typestore(Stores.EMPTY)
        self._stamps, self._values = defaultdict(lambda: array("q")), defaultdict(lambda: array("d"))
        self._road, self._vehicle, self._provenance = [], None, {}

    def take(self, record):
        """Keep what is needed of an MCAP record."""
        if isinstance(record, Header):  # each file of a bag has numbers of its own
            self._schemas, self._topics = {}, {}
        elif isinstance(record, Schema):
            self._schemas[record.id] = record
        elif isinstance(record, Channel):
            self._announce(record)
        elif isinstance(record, Metadata):
            self._provenance[record.name] = dict(record.metadata)
        elif isinstance(record, Message) and record.channel_id in self._topics:
            end, type_name = self._topics[record.channel_id]
            self._keep(end, self._store.deserialize_cdr(record.data, type_name))

    def _announce(self, channel):
        slashed = f"/{channel.topic}"
        end = next((each for each in (*_FIELDS, *_FURTHER) if slashed.endswith(f"/{each}")), None)
        if end is not None and channel.id not in self._topics:
            schema = self._schemas[channel.schema_id]
            self._names[end].add(channel.topic)
            self._topics[channel.id] = end, schema.name
            self._store.register(get_types_from_msg(schema.data.decode(), schema.name))

    def _keep(self, end, message):
        if end in _FIELDS:
            self._stamps[end].append(_time(message.header.stamp))
            self._values[end].extend(chain.from_iterable(_flat(getattr(message, field)) for field in _FIELDS[end]))
        elif end == "coil_current":
            self._stamps[end].append(_time(message.sample_stamp))
            self._values[end].extend(message.current)
        elif end == "road_profile":
            self._road.append((message.start, message.spacing, message.left, message.right))
        elif end == "vehicle_description":
            self._vehicle = message.data
        else:
            told = {pair.key: pair.value for each in message.status if each.name == "simulator" for pair in each.values}
            if "silent_periods" in told:
                self._stamps[end].append(_time(message.header.stamp))
                answers = sum(int(told[outcome]) for outcome in _ANSWERS)
                self._values[end].extend((int(told["silent_periods"]), answers))

    def recording(self, complete):
        """Return all as a `RecordedDrive`; raises ValueError with what is wrong."""
        several = [topics for topics in self._names.values() if len(topics) > 1]
        if several:
            raise ValueError(f"holds more than one run: {', '.join(sorted(several[0]))}")
        missing = [end for end in _FIELDS if not self._stamps[end]]
        missing += ["road_profile"] * (not self._road) + ["vehicle_description"] * (self._vehicle is None)
        if missing:
            raise ValueError(f"holds no messages on {', '.join(missing)}")
        return RecordedDrive(
            *(self._stream(end) for end in _FIELDS),
            np.array(self._stamps["coil_current"]),
            np.array(self._values["coil_current"]).reshape(-1, 2),
            self._road,
            self._vehicle,
            self._told(),
            self._provenance,
            complete,
        )

    def _told(self):
        # the first word of the next run may be among the last ones of this
        counts = np.array(self._values["diagnostics"]).reshape(-1, 2)
        told = np.column_stack((self._stamps["diagnostics"], counts)).astype(np.int64)
        return told[np.argsort(told[:, 0], kind="stable")]

    def _stream(self, end):
        (topic,) = self._names[end]
        stamps = np.array(self._stamps[end])
        back = np.flatnonzero(np.diff(stamps) <= 0)
        if back.size:
            raise ValueError(f"holds more than one run: after t = {stamps[back[0]] / NANO:.3f} s {topic} begins anew")
        channels = _IMU_CHANNELS if _FIELDS[end] is IMU else _MOUNT_CHANNELS
        return Stream(topic, channels, stamps, np.array(self._values[end]).reshape(-1, len(channels)))


def _names(fields, sides, axes):
    return tuple(".".join((field, *side, *axis)) for field in fields for side in sides for axis in axes)


_SIDES, _AXES, _WHOLE = (("left",), ("right",)), (("x",), ("y",), ("z",)), ((),)
_IMU_CHANNELS = _names(IMU, _WHOLE, _AXES)
_MOUNT_CHANNELS = (
    *_names(MOUNTS[:3], _SIDES, _WHOLE),
    *_names(MOUNTS[3:6], _SIDES, _AXES),
    *_names(MOUNTS[6:], _SIDES, _WHOLE),
)


def _flat(field):
    """Numbers of a vector, an array of floats, or an array of vectors."""
    vectors = [field] if hasattr(field, "x") else field
    return chain.from_iterable((each.x, each.y, each.z) if hasattr(each, "x") else (each,) for each in vectors)


def _time(stamp):
    return stamp.sec * NANO + stamp.nanosec
