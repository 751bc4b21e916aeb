"""The topics of a bag that are accelerations: which there are, their samples as columns, and the frames they name."""

from collections import Counter

from mr_mount_controller.node_base import topics

from .columns import Columns, Topic
from .csv_recording import read_csv
from .recording import Inertial
from .sources import BY_ORIENTATION, Origin, is_csv

_COVARIANCE = {"covariance": ("linear_acceleration_covariance", (9,))}
_IMU = {
    "stamp": "header.stamp",
    "specific_force": ("linear_acceleration", (3,)),
    "angular_velocity": ("angular_velocity", (3,)),
}
IMU_COLUMNS = Columns(topics.IMU_TYPE, Inertial, _IMU, first=_COVARIANCE, logged="logged")
_ORIENTED = Columns(
    topics.IMU_TYPE,
    Inertial,
    {**_IMU, "orientation": ("orientation", (4,))},
    first={**_COVARIANCE, "orientation_covariance": ("orientation_covariance", (9,))},
    logged="logged",
)


def _columns(type_name, force):
    return Columns(
        type_name, Inertial, {"stamp": "header.stamp", "specific_force": (force, (3,))}, first={}, logged="logged"
    )


ACCELERATION_TYPES = {
    topics.IMU_TYPE: IMU_COLUMNS,
    "geometry_msgs/msg/AccelStamped": _columns("geometry_msgs/msg/AccelStamped", "accel.linear"),
    "geometry_msgs/msg/Vector3Stamped": _columns("geometry_msgs/msg/Vector3Stamped", "vector"),
}
_PAIR = ("chassis", "powertrain")
_MOST_LISTED = 20
_MOST = 100  # topics that are taken


class Accelerations:
    """What has been read of the topics of accelerations that `sources.Sources` ask for."""

    def __init__(self, sources, by_log):
        self._sources, self._by_log = sources, by_log
        self._columns, self._frames, self._types, self._counts = {}, {}, {}, Counter()  # by topic

    def see(self, topic, type_name, count):
        """Remember that there are messages of a type on a topic."""
        self._types[topic] = type_name
        self._counts[topic] += count

    def take(self, topic, definition, data, start, size, logged):
        """Take messages of a topic that may be wanted."""
        if topic not in self._columns:
            if len(self._columns) >= _MOST:
                return
            columns = ACCELERATION_TYPES[self._types[topic]]
            if columns is IMU_COLUMNS and self._sources.gravity == BY_ORIENTATION:
                columns = _ORIENTED
            self._columns[topic] = Topic(columns, self._by_log)
            first = data[int(start[0]) : int(start[0]) + int(size[0])].tobytes() if len(start) else b""
            self._frames[topic] = definition.message(memoryview(first)).header.frame_id if first else ""
        self._columns[topic].add(definition.kind, data, start, size, logged)

    @property
    def taken(self):
        """Whether any messages were taken."""
        return bool(self._columns)

    def sensors(self):
        """Return the namespace of the sensors, and by name the `Inertial` and the `Origin` of each.

        Raises
        ------
        ValueError
            There is none, a named topic is not there, or there are those of several vehicles.
        """
        named = {name: self._named(name) for name, topic in self._sources.topics.items() if not is_csv(topic)}
        found, spaces = dict(named), set()
        usual = {name: topics.imu_topic(name) for name in _PAIR if name not in self._sources.topics}
        for name, end in usual.items():
            candidates = [topic for topic in self._columns if f"/{topic}".endswith(f"/{end}")]
            candidates = [topic for topic in candidates if topic not in named.values()]
            spaces |= {topic.removesuffix(end) for topic in candidates}
            if candidates:
                found[name] = candidates[0]
        if len(spaces) > 1:
            raise ValueError(f"it holds sensors of several vehicles, must be of one: {self.listed()}")
        space = min(spaces, default="/")
        for topic in sorted(self._columns):  # further ones beside the two
            name = topic.removeprefix(space).removesuffix(topics.imu_topic(""))
            if "/" not in name and topic == f"{space}{topics.imu_topic(name)}" and topic not in found.values():
                found.setdefault(name, topic)
        files = {name: file for name, file in self._sources.topics.items() if is_csv(file)}
        if not found and not files:
            usual = ", ".join(topics.imu_topic(name) for name in _PAIR)
            raise ValueError(f"it holds no {topics.IMU_TYPE} on {usual}; {self.listed()}")
        order = (*_PAIR, *sorted(found.keys() - set(_PAIR)))
        sensors = {name: self._sensor(found[name]) for name in order if name in found}
        for name, file in files.items():
            sensors |= read_csv(file, self._sources, name)
        return space, sensors

    def _sensor(self, topic):
        return self._columns[topic].columns(), Origin(topic, self._types[topic], self._frames[topic])

    def _named(self, name):
        """Return the topic that the user named for a sensor.

        Raises
        ------
        ValueError
            There is none of that name, or its messages are no accelerations.
        """
        wanted = self._sources.topics[name]
        topic = next((each for each in self._types if each.lstrip("/") == wanted.lstrip("/")), None)
        if topic is None:
            raise ValueError(f"it has no topic {wanted!r} for {name}; {self.listed()}")
        if topic not in self._columns:
            accepted = ", ".join(ACCELERATION_TYPES)
            raise ValueError(f"{wanted!r} is a {self._types[topic]}, accepted: {accepted}; {self.listed()}")
        return topic

    def listed(self):
        """Say which topics there are that could be a sensor."""
        found = sorted(topic for topic, name in self._types.items() if name in ACCELERATION_TYPES)
        if not found:
            return f"it has no topic of {', '.join(ACCELERATION_TYPES)}"
        more = f" and {len(found) - _MOST_LISTED} more" if len(found) > _MOST_LISTED else ""
        words = ", ".join(
            f"{topic} ({self._types[topic].rsplit('/', 1)[-1]}, {self._counts[topic]})"
            for topic in found[:_MOST_LISTED]
        )
        return f"there are {words}{more}: choose by --chassis TOPIC, --powertrain TOPIC, --sensor NAME=TOPIC"
