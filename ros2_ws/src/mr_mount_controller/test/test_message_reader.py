"""Property: the numbers read from a serialised message are those of the message, whoever serialised it."""

from struct import Struct

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.node_base.cdr import NANO, LayoutError
from mr_mount_controller.node_base.packed_message import MessageReader
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Imu
from std_msgs.msg import Header
from trackvib_msgs.msg import CoilCurrent

pytestmark = pytest.mark.property

TIMES = st.tuples(st.integers(0, 2**31 - 1), st.integers(0, 10**9 - 1))
NUMBERS = st.lists(st.floats(), min_size=6, max_size=6)
NAMES = st.text("abcdefgh_/", max_size=30)

IMU = MessageReader(Imu, "header.stamp", {"angular_velocity": 3, "linear_acceleration": 3})
ANSWER = MessageReader(CoilCurrent, "sample_stamp", {"current": 2})
CURRENTS = st.lists(st.floats(), max_size=16)


def assert_read(reader, data, time, numbers):
    stamp, found = reader.read(data)
    assert stamp == time[0] * NANO + time[1]
    np.testing.assert_array_equal(found, numbers)


def header(name, time):
    return Header(frame_id=name, stamp=Time(sec=time[0], nanosec=time[1]))


@given(NAMES, TIMES, NUMBERS)
def test_imu(name, time, numbers):
    """Whatever the length of the frame's name, which shifts everything behind it."""
    message = Imu(header=header(name, time))
    for vector, values in ((message.angular_velocity, numbers[:3]), (message.linear_acceleration, numbers[3:])):
        vector.x, vector.y, vector.z = values
    assert_read(IMU, serialize_message(message), time, numbers)


@given(NAMES, TIMES, TIMES, NUMBERS)
def test_coil_current(name, time, answered, numbers):
    """The stamp that is answered is read, not the header's."""
    stamp = Time(sec=answered[0], nanosec=answered[1])
    message = CoilCurrent(header=header(name, time), sample_stamp=stamp, current=numbers[:2])
    assert_read(ANSWER, serialize_message(message), answered, numbers[:2])


@given(TIMES, st.lists(CURRENTS, min_size=1, max_size=4), st.integers(0, 16))
def test_currents_of_another_number_are_refused(time, answers, coils):
    """One after the other, whatever came before; those of the number that is asked for are read."""
    reader = MessageReader(CoilCurrent, "sample_stamp", {"current": coils})
    for currents in (*answers, [0.5] * coils):
        message = CoilCurrent(sample_stamp=Time(sec=time[0], nanosec=time[1]), current=currents)
        if len(currents) == coils:
            assert_read(reader, serialize_message(message), time, currents)
            continue
        with pytest.raises(LayoutError, match=f"field current has {len(currents)} numbers, must be {coils}"):
            reader.read(serialize_message(message))


@pytest.mark.parametrize("count", [17, 1000])
def test_more_currents_than_a_message_may_carry_are_refused(count):
    """Though all of them are there."""
    data = bytes([0, 1, 0, 0]) + Struct("<iI I4s iI I4x").pack(0, 0, 1, bytes(4), 0, 0, count) + bytes(8 * count)
    with pytest.raises(LayoutError, match=f"field current has {count} elements, accepted: at most 16"):
        ANSWER.read(data)


@given(TIMES, NUMBERS)
def test_big_endian_sender(time, numbers):
    """A message of a machine with the other byte order, which says so in its second byte."""
    data = bytes(4) + Struct(">iI I2s2x iI I4x 2d").pack(7, 8, 2, b"f", *time, 2, *numbers[:2])
    assert_read(ANSWER, data, time, numbers[:2])
