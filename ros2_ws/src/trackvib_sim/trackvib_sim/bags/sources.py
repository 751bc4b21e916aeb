"""Which sensors a recording has, where their samples come from, and how they sit: what every verb is told alike."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite

from mr_mount_controller.node_base import topics

GRAVITIES = BY_MEAN, BY_ORIENTATION = ("mean", "orientation")


class SourceError(ValueError):
    """Sensors that cannot be told so; the message says what is accepted."""


@dataclass(frozen=True)
class Sources:
    """What a user tells of the sensors of a recording; by default Imu topics are found by their usual names.

    Raises
    ------
    SourceError
        Two sensors have one topic, an angle is no number, or a rotation is of no sensor that is named.
    """

    topics: Mapping = field(default_factory=dict)  # sensor -> topic, or CSV file
    rotations: Mapping = field(default_factory=dict)  # sensor, or "" for all others -> its roll, pitch, yaw, deg
    gravity: str = BY_MEAN  # how it is removed, one of `GRAVITIES`
    csv_columns: Mapping = field(default_factory=dict)  # column as `csv_recording` calls it -> as the file does

    def __post_init__(self):
        absolute = [topic if is_csv(topic) else f"/{topic.lstrip('/')}" for topic in self.topics.values()]
        for topic in absolute:
            if absolute.count(topic) > 1:
                raise SourceError(f"{topic!r} is given for two sensors, must be for one")
        for angles in self.rotations.values():
            if len(angles) != 3 or not all(map(isfinite, angles)):
                raise SourceError(f"a rotation is {angles}, accepted: roll, pitch and yaw in degrees")

    def sensor_on(self, topic):
        """Return which named sensor a topic is that of; None of none."""
        wanted = topic.lstrip("/")
        return next((name for name, each in self.topics.items() if each.lstrip("/") == wanted), None)

    def angles(self, sensor):
        """Return roll, pitch and yaw [deg] that the user told of a sensor; None if he told none."""
        return self.rotations.get(sensor, self.rotations.get(""))


@dataclass(frozen=True)
class Origin:
    """Where the samples of a sensor come from, and what was done to them."""

    source: str  # topic or file
    type_name: str  # of its messages, "CSV" of a file
    frame: str = ""  # that its messages name
    rotation: tuple = (0.0, 0.0, 0.0)  # roll, pitch, yaw of the sensor in the vehicle, deg
    rotation_by: str = ""  # who told it: "--rotate", "/tf_static", "" for nobody
    gravity: str = BY_MEAN  # how it was removed


def is_csv(source):
    """Whether a sensor's source is a CSV file; a topic has no dot in its name."""
    return source.lower().endswith(".csv")


def end_of_sensor(name):
    """Return the end of the topic that a sensor has in bags of our own."""
    return topics.imu_topic(name)
