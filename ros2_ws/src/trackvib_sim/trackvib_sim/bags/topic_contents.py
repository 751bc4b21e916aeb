"""What messages on the topics that we know contain, as far as a bag has been read, and the `Recording` made of it."""

from array import array

import numpy as np
from mr_mount_controller.mounting import described
from mr_mount_controller.node_base import topics

from ..numerics.units import NANO
from .accelerations import ACCELERATION_TYPES, Accelerations
from .columns import Topic
from .csv_recording import pair_of
from .errors import BagError
from .known_topics import COLUMNS, FURTHER, NEEDED, TYPES, end_of
from .mounting_of_bag import mounting_of
from .opening import how_to_convert
from .places import PLACE_TYPES, Places
from .provenance import law_change
from .recording import LoopCounts, Recording
from .road_patches import RoadPatches
from .sources import end_of_sensor
from .transforms import TF_STATIC, transforms_in

_SENSOR, _PLACE = "sensor", "place"  # stand for topics that are told by their types
_ROS_1 = "ros1msg"  # encoding of the definitions of ROS 1, whose messages are serialised in another way
_ANSWERS = ("accepted", "late", "duplicate", "not_finite")  # to samples that were out, among the diagnostics


class TopicContents:
    """Columns, texts and all else that has been taken, by topic."""

    def __init__(self, by_log, sources):
        self._by_log, self._sources = by_log, sources
        self._accelerations, self._places, self._transforms = Accelerations(sources, by_log), Places(by_log), {}
        self._columns, self._roads, self._texts, self._mountings = {}, {}, {}, {}  # by topic
        self._loop_counts = array("q")  # rows of `LoopCounts`, one behind the other
        self._diagnostics, self._ros_1 = {}, set()
        self._law_changes = {}  # by topic

    def end_of(self, topic, schema, count):
        """Return as what a number of messages are taken, the end of their topic or a word; None where they are not."""
        self._accelerations.see(topic, schema.name, count)
        if schema.encoding == _ROS_1:
            self._ros_1.add(topic)
            return None
        return self._end(topic, schema.name)

    def _end(self, topic, type_name):
        if self._sources.sensor_on(topic) is not None:
            return _SENSOR if type_name in ACCELERATION_TYPES else None
        end = end_of(topic)
        if end in (*NEEDED, FURTHER):
            return _SENSOR if type_name == topics.IMU_TYPE else None
        if end is not None:
            return end if type_name == TYPES[end] else None
        return _PLACE if type_name in PLACE_TYPES else None

    def take(self, topic, type_name, end, definition, data, start, size, logged):
        """Take messages, of which the arrays tell beginnings, sizes and times, as what `end_of` says."""
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
                patches = self._roads.setdefault(topic, RoadPatches())
                patches.add(message.start, message.spacing, message.left, message.right)
            else:
                self._take_diagnostics(message)

    def _take_diagnostics(self, message):
        values = {pair.key: pair.value for each in message.status if each.name == "simulator" for pair in each.values}
        self._diagnostics |= values
        if "silent_periods" in values:
            stamp = message.header.stamp
            answers = sum(int(values.get(outcome, 0)) for outcome in _ANSWERS)
            row = stamp.sec * NANO + stamp.nanosec, int(values["silent_periods"]), answers
            self._loop_counts.frombytes(np.array(row, np.int64).tobytes())

    def recording(self, path, **whole):
        """Return it all; `whole` are the items of the `Recording` that are of no topic.

        Raises
        ------
        BagError
            There are no samples of sensors, or those of several vehicles.
        """
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
        counts = np.array(self._loop_counts, np.int64).reshape(-1, 3)
        # the first word of the next run may be among the last ones of this
        counts = counts[np.lexsort(counts.T[::-1])]
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
            **whole,
        )
