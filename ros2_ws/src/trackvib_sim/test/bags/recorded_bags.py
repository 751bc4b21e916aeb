"""Bags as other recorders write them: any topics and types, by the definitions that rosbags has, not by our writer."""

from pathlib import Path

import numpy as np
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)
EPOCH = 1_700_000_000 * 10**9  # ns
GRAVITY = 9.80665
NOTHING = np.zeros(9)


def motion(time, gain=1.0):
    """Return specific forces (k, 3): 10 Hz along x, 30 and 15 Hz along z upon gravity; 0.6 along y is 12 Hz."""
    wave = [np.sin(2.0 * np.pi * f * np.asarray(time)) for f in (10.0, 12.0, 30.0, 15.0)]
    return np.column_stack((0.8 * gain * wave[0], 0.6 * gain * wave[1], GRAVITY + gain * (1.5 * wave[2] + wave[3])))


RMS = np.sqrt(np.array((0.8**2, 0.6**2, 1.5**2 + 1.0)) / 2.0)


def times(rate, seconds):
    """Return the times [s] of samples."""
    return np.arange(1, round(rate * seconds) + 1) / rate


def header(stamp, frame="sensor"):
    """Return a Header of a stamp [ns]."""
    return _of("std_msgs/msg/Header", _of("builtin_interfaces/msg/Time", stamp // 10**9, stamp % 10**9), frame)


def imu(stamp, force, frame="sensor", orientation=None):
    """Return an Imu; without an orientation (x, y, z, w) it says that it has none."""
    covariance = NOTHING.copy()
    covariance[0] = -1.0 if orientation is None else 0.0
    quaternion = _of("geometry_msgs/msg/Quaternion", *map(float, orientation or (0.0, 0.0, 0.0, 1.0)))
    rate = _vector((0.0, 0.0, 0.0))
    fields = header(stamp, frame), quaternion, covariance, rate, NOTHING, _vector(force), NOTHING
    return _of("sensor_msgs/msg/Imu", *fields)


def accel(stamp, force, frame="sensor"):
    """Return an AccelStamped."""
    inner = _of("geometry_msgs/msg/Accel", _vector(force), _vector((0.0, 0.0, 0.0)))
    return _of("geometry_msgs/msg/AccelStamped", header(stamp, frame), inner)


def vector(stamp, force, frame="sensor"):
    """Return a Vector3Stamped."""
    return _of("geometry_msgs/msg/Vector3Stamped", header(stamp, frame), _vector(force))


def fix(stamp, latitude, longitude):
    """Return a NavSatFix."""
    status = _of("sensor_msgs/msg/NavSatStatus", 0, 1)
    return _of("sensor_msgs/msg/NavSatFix", header(stamp), status, latitude, longitude, 100.0, NOTHING, 0)


def transform(parent, child, quaternion):
    """Return a TransformStamped."""
    turn = _of("geometry_msgs/msg/Quaternion", *map(float, quaternion))
    inner = _of("geometry_msgs/msg/Transform", _vector((1.0, 0.0, 0.0)), turn)
    return _of("geometry_msgs/msg/TransformStamped", header(0, parent), child, inner)


def tf_static(*transforms):
    """Return a TFMessage."""
    return _of("tf2_msgs/msg/TFMessage", list(transforms))


def stream(time, kind=imu, gain=1.0, force=None, **options):
    """Return messages of a sensor by their times [ns]."""
    forces = motion(time, gain) if force is None else force
    stamps = EPOCH + np.round(np.asarray(time) * 1e9).astype(np.int64)
    return [(int(s), kind(int(s), f, **options)) for s, f in zip(stamps, forces, strict=True)]


def write_bag(path, topics):
    """Write an MCAP file with messages (time, message) by topic; returns its path."""
    path = Path(path)
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2", "another recorder")
        for topic, messages in topics.items():
            name = messages[0][1].__msgtype__
            text = STORE.generate_msgdef(name, ros_version=2)[0].encode()
            channel = writer.register_channel(topic, "cdr", writer.register_schema(name, "ros2msg", text))
            for time, message in messages:
                writer.add_message(channel, time, bytes(STORE.serialize_cdr(message, name)), time)
        writer.finish()
    return path


def _of(name, *fields):
    return STORE.types[name](*fields)


def _vector(values):
    return _of("geometry_msgs/msg/Vector3", *map(float, values))
