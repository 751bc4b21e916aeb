"""Reads a run out of a bag: columns of numbers, an hour of them in a few seconds and bounded memory.

Nothing is done message by message in Python but for the rare topics.
"""

from collections import Counter
from collections.abc import Callable
from os import SEEK_END
from pathlib import Path

import numpy as np
from mcap.records import Channel, Metadata, Schema
from mr_mount_controller.mounting import described
from mr_mount_controller.node_base import topics
from rosbags.serde import SerdeError

from ..numerics.units import NANO
from .accelerations import ACCELERATION_TYPES, Accelerations
from .columns import Topic
from .csv_recording import csv_recording, pair_of
from .definitions import Definition
from .errors import BagError
from .files import find_files
from .known_topics import COLUMNS, FURTHER, NEEDED, TYPES, end_of
from .limits import TooLarge
from .mcap_records import DAMAGE
from .mcap_walk import Walk
from .mounting_of_bag import mounting_of
from .opening import how_to_convert, opened
from .places import PLACE_TYPES, Places
from .provenance import law_change
from .raw_messages import NO_SCHEMA
from .recording import LoopCounts, Recording
from .sources import Sources, end_of_sensor, is_csv
from .transforms import TF_STATIC, transforms_in
from .unfolding import unfold_messages

HEADER_TIME, LOG_TIME = TIMES = ("header", "log")  # that may be the time base
_SENSOR, _PLACE = "sensor", "place"  # stand for topics that are told by their types
_ROS_1 = "ros1msg"  # encoding of the definitions of ROS 1, whose messages are serialised in another way
_ANSWERS = ("accepted", "late", "duplicate", "not_finite")  # to samples that were out, among the diagnostics
# a definition that is damaged or not the one we know gives the others where it is applied
_READ_ERRORS = (
    OSError, TooLarge, *DAMAGE, SerdeError, RuntimeError, LookupError, OverflowError, AssertionError, AttributeError,
    TypeError,
)  # fmt: skip


def read_recording(
    path: str | Path,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
    time: str = HEADER_TIME,
    sources: Sources = Sources(),  # noqa: B008, never changes
) -> Recording:
    """Return the `Recording` of a bag, a folder with MCAP files or one such file, as far as it is readable.

    Topics are found by the ends of their names. Of several with the same end, the one in the sensors' namespace counts.

    Parameters
    ----------
    path : path
    on_progress : callable
        Called from time to time with the number of bytes read and their total number.
    time : str
        Which times are the stamps: "header", those in the messages, or "log", those at which they were recorded.
    sources : Sources
        Which sensors there are and where they are found. A sensor of the two that is not there has no sample that is a
        number; a path that ends in .csv is a file of samples.

    Raises
    ------
    BagError
        The bag cannot be read, holds none of the sensors, or those of several vehicles.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> recording = tv.read_recording(bag)
    >>> recording.chassis.specific_force.shape[1], recording.complete
    (3, True)
    """
    path, reading = Path(path), _Reading(time == LOG_TIME, sources)
    if is_csv(str(path)):
        return csv_recording(path, sources, on_progress)
    found = find_files(path)
    files = found.files
    try:
        total, done = sum(file.stat().st_size for file in files), 0
        for file in files:
            size = file.stat().st_size
            reading.read(file, lambda part, before=done, size=size: on_progress(before + round(part * size), total))
            done += size
        recording = reading.recording(path)
    except BagError:
        raise
    except _READ_ERRORS as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {str(error) or type(error).__name__}") from None
    on_progress(total, total)
    by_log = ("stamps are the times at which messages were recorded",) if time == LOG_TIME else ()
    return recording._replace(notes=(*found.notes, *recording.notes, *by_log))


class _Reading:
    """What has been read of a bag."""

    def __init__(self, by_log, sources):
        self._by_log, self._sources = by_log, sources
        self._accelerations, self._places, self._transforms = Accelerations(sources, by_log), Places(by_log), {}
        self._columns, self._roads, self._texts, self._mountings = {}, {}, {}, {}  # by topic
        self._loop_counts, self._diagnostics, self._ros_1 = [], {}, set()
        self._law_changes = {}  # by topic
        self._provenance, self._counts, self._complete = {}, Counter(), True

    def read(self, file, on_progress):
        """Read one file; ids of schemas and channels are its own. `on_progress` is called with the part read."""
        schemas, channels, definitions = {}, {}, {}
        with opened(file) as stream:
            whole = stream.seek(0, SEEK_END)  # of a compressed file more than it has on disk
            stream.seek(0)
            walk = Walk(stream)
            for part in walk.parts():
                _require_undamaged(walk)
                for record in part.others:
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        channels[record.id] = record
                    elif isinstance(record, Metadata):
                        self._provenance[record.name] = dict(record.metadata)
                numbers = part.messages.head["channel"]
                for number in np.unique(numbers).tolist():
                    channel = channels.get(number)
                    schema = schemas.get(channel.schema_id) if channel else None
                    if channel is None or (schema is None and channel.schema_id != NO_SCHEMA):
                        raise ValueError(f"messages on channel {number}, which is not declared")
                    of_channel = numbers == number
                    start, size = part.messages.start[of_channel], part.messages.size[of_channel]
                    self._counts[channel.topic] += len(start)
                    if schema is not None:
                        self._accelerations.see(channel.topic, schema.name, len(start))
                    if schema is not None and schema.encoding == _ROS_1:
                        self._ros_1.add(channel.topic)
                    elif schema is not None and (end := self._end(channel.topic, schema.name)) is not None:
                        if schema.id not in definitions:
                            definitions[schema.id] = Definition(schema.name, schema.encoding, schema.data)
                        messages = unfold_messages(part.data, start, size)
                        logged = part.messages.head["log_time"][of_channel].astype(np.int64)
                        self._take(channel.topic, schema.name, end, definitions[schema.id], *messages, logged)
                on_progress(part.end / whole)
            _require_undamaged(walk)
            self._complete &= walk.complete

    def _end(self, topic, type_name):
        """Return as what messages of a type are taken; None where they are not."""
        if self._sources.sensor_on(topic) is not None:
            return _SENSOR if type_name in ACCELERATION_TYPES else None
        end = end_of(topic)
        if end in (*NEEDED, FURTHER):
            return _SENSOR if type_name == topics.IMU_TYPE else None
        if end is not None:
            return end if type_name == TYPES[end] else None
        return _PLACE if type_name in PLACE_TYPES else None

    def _take(self, topic, type_name, end, definition, data, start, size, logged):
        if end == _SENSOR:
            self._accelerations.take(topic, definition, data, start, size, logged)
            return
        if end == _PLACE:
            self._places.take(topic, type_name, definition.kind, data, start, size, logged)
            return
        if end in COLUMNS:
            if topic not in self._columns:
                self._columns[topic] = Topic(COLUMNS[end], self._by_log)
            self._columns[topic].add(definition.kind, data, start, size, logged)
            return
        for first, length in zip(start.tolist(), size.tolist(), strict=True):
            message = definition.message(data[first : first + length].data)
            if end in (topics.VEHICLE_DESCRIPTION, topics.DRIVE_DESCRIPTION):
                self._texts[topic] = message.data
            elif end == topics.MOUNT_DESCRIPTION:
                self._mountings[topic] = described(message)
            elif end == TF_STATIC:
                self._transforms |= transforms_in(message)
            elif end == topics.LAW_PARAMETERS:
                self._law_changes.setdefault(topic, []).append(law_change(message))
            elif end == topics.ROAD_PROFILE:
                # copies, for these arrays would keep the whole part in memory
                heights = message.left.copy(), message.right.copy()
                self._roads.setdefault(topic, []).append((message.start, message.spacing, *heights))
            else:
                self._take_diagnostics(message)

    def _take_diagnostics(self, message):
        values = {pair.key: pair.value for each in message.status if each.name == "simulator" for pair in each.values}
        self._diagnostics |= values
        if "silent_periods" in values:
            stamp = message.header.stamp
            answers = sum(int(values.get(outcome, 0)) for outcome in _ANSWERS)
            self._loop_counts.append((stamp.sec * NANO + stamp.nanosec, int(values["silent_periods"]), answers))

    def recording(self, path):
        """Return it all."""
        found = {end: [] for end in TYPES}
        for topic in self._columns | self._roads | self._texts | self._mountings | self._law_changes:
            found[end_of(topic)].append(topic)
        if not self._accelerations.taken and self._ros_1:
            raise BagError(
                f"bag {str(path)!r} holds messages of ROS 1 on {', '.join(sorted(self._ros_1))}; "
                f"{how_to_convert('FILE.bag')}, where FILE.bag is the bag of ROS 1 from which it was made"
            )
        try:
            space, sensors = self._accelerations.sensors()
        except ValueError as error:
            raise BagError(f"bag {str(path)!r}: {error}") from None
        chosen = {
            end: f"{space}{end}" if f"{space}{end}" in candidates else candidates[0]
            for end, candidates in found.items()
            if candidates
        }
        columns = {end: self._columns[chosen[end]].columns() for end in COLUMNS if end in chosen and end not in NEEDED}
        told = self._mountings.get(chosen.get(topics.MOUNT_DESCRIPTION))
        mounting = mounting_of(told, columns.get(topics.MOUNT_STATE), columns.get(topics.COIL_CURRENT))
        if topics.COIL_CURRENT in chosen:  # answers of another number of currents are none
            fits = lambda answers: answers.current.shape[1] == mounting.coils  # noqa: E731
            answers = self._columns[chosen[topics.COIL_CURRENT]].columns(fits)
            columns[topics.COIL_CURRENT] = answers if fits(answers) else None
        odometry, notes = columns.get(topics.ODOMETRY), []
        if odometry is None:
            odometry, notes = self._places.odometry()
        chosen |= {end_of_sensor(name): origin.source for name, (_, origin) in sensors.items()}
        if topics.ODOMETRY not in chosen and odometry is not None:
            chosen[topics.ODOMETRY] = ""
        # the first word of the next run may be among the last ones of this
        counts = np.array(sorted(self._loop_counts), np.int64).reshape(-1, 3)
        return Recording(
            path=path,
            topics=chosen,
            **pair_of({name: inertial for name, (inertial, _) in sensors.items()}),
            origins={name: origin for name, (_, origin) in sensors.items()},
            transforms=self._transforms,
            notes=tuple(notes),
            mounting=mounting,
            mounts=columns.get(topics.MOUNT_STATE),
            answers=columns.get(topics.COIL_CURRENT),
            odometry=odometry,
            drive=columns.get(topics.DRIVE_STATE),
            commands=columns.get(topics.DRIVE_COMMAND),
            law_changes=tuple(self._law_changes.get(chosen.get(topics.LAW_PARAMETERS), ())),
            road=self._roads.get(chosen.get(topics.ROAD_PROFILE), []),
            vehicle=self._texts.get(chosen.get(topics.VEHICLE_DESCRIPTION)),
            drive_file=self._texts.get(chosen.get(topics.DRIVE_DESCRIPTION)),
            loop_counts=LoopCounts(*counts.T),
            diagnostics=self._diagnostics,
            provenance=self._provenance,
            counts=self._counts,
            complete=self._complete,
        )


def _require_undamaged(walk):
    """Numbers with a hole that nobody sees are worse than none."""
    for damage in walk.damage:
        if damage.size:
            raise ValueError(f"it is damaged at {damage}; `trackvib bag repair` keeps everything else")
