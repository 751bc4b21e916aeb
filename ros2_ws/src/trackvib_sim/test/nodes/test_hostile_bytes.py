"""Property: whatever is done to the bytes of a message, readers refuse it or read what ROS reads, in bounded memory."""

import tracemalloc

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Vector3
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.mounting import undescribed
from mr_mount_controller.node_base.cdr import NANO, Checker, LayoutError, check, find_layout, leading_stamp
from mr_mount_controller.node_base.definitions import installed_definition
from mr_mount_controller.node_base.listener import whole_message
from mr_mount_controller.node_base.packed_message import MessageReader
from nav_msgs.msg import Odometry
from rclpy.serialization import deserialize_message, serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import CoilCurrent, MountState, RoadProfile
from trackvib_sim.bags.definitions import Definition
from trackvib_sim.bags.known_topics import COLUMNS
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.nodes.messages import mount_description

pytestmark = [pytest.mark.property, pytest.mark.cross_engine]


def mount_state():
    """Two coils, three mounts."""
    three = [1.0, 2.0, 3.0]
    vectors = dict.fromkeys(("deflection", "velocity", "force"), [Vector3(x=each) for each in three])
    return MountState(current=[0.5, 1.5], stiffness=three, damping=three, dissipated_power=three, **vectors)


HEIGHTS = [0.5, -0.25, 1e-3]
MESSAGES = [
    Imu(),
    CoilCurrent(current=[0.5, 1.5]),
    CoilCurrent(),
    mount_state(),
    mount_description(undescribed(2, 3)),
    Odometry(child_frame_id="base_link"),
    RoadProfile(spacing=0.05, left=HEIGHTS, right=HEIGHTS),
    String(data="vehicle: {}"),
    Clock(),
    DiagnosticArray(status=[DiagnosticStatus(name="simulator", values=[KeyValue(key="time", value="0.1")] * 3)]),
]
COLUMNS_OF = {columns.type_name: columns.wanted for columns in COLUMNS.values()}
LENGTHS = st.sampled_from([0, 1, 2, 255, 2**16, 2**31 - 1, 2**31, 2**32 - 1])


@st.composite
def mutated(draw):
    """Return a message of ours, and its bytes after some harm."""
    message = draw(st.sampled_from(MESSAGES))
    if hasattr(message, "header"):
        message.header.frame_id = draw(st.text("abc", max_size=9))
    data = bytearray(serialize_message(message))
    for harm in draw(st.lists(st.sampled_from(["flip", "length", "cut", "insert", "order"]), max_size=4)):
        place = draw(st.integers(0, max(len(data) - 1, 0)))
        if harm == "flip" and data:
            data[place] = draw(st.integers(0, 255))
        elif harm == "length":
            place -= place % 4
            data[place : place + 4] = draw(LENGTHS).to_bytes(4, draw(st.sampled_from(["little", "big"])))
        elif harm == "cut":
            del data[place:]
        elif harm == "insert":
            data[place:place] = draw(st.binary(max_size=9))
        elif harm == "order":
            data[:2] = draw(st.sampled_from([b"\0\0", b"\0\1", b"\0\7", b"\xff\xff"]))
    return message, bytes(data)


def numbers_of(message, name):
    """Return the numbers of a field of a ROS message, one after the other."""
    for part in name.split("."):
        message = getattr(message, part)
    if hasattr(message, "get_fields_and_field_types"):
        return [number for each in message.get_fields_and_field_types() for number in numbers_of(message, each)]
    if isinstance(message, (float, int)):
        return [message]
    return [number for each in message for number in ([each] if isinstance(each, float) else (each.x, each.y, each.z))]


@given(mutated())
def test_columns_are_what_ros_reads_or_the_message_is_refused(harmed):
    """By the installed definition and by that in a bag alike."""
    message, data = harmed
    type_name = f"{type(message).__module__.split('.')[0]}/msg/{type(message).__name__}"
    in_bag = Definition(type_name, "ros2msg", schema_text(type_name).encode()).kind
    wanted = COLUMNS_OF.get(type_name, {})
    layouts = []
    for kind in (in_bag, installed_definition(type(message))):
        tracemalloc.start()
        try:
            check(kind, data)
            layouts.append(find_layout(kind, data, wanted) if wanted else None)
        except LayoutError:
            layouts.append(None)
            with pytest.raises(LayoutError):
                whole_message(type(message))(data)
        finally:
            peak = tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
        assert peak < 100_000 + 1000 * len(data)
    assert layouts[0] == layouts[1]
    if layouts[0] is not None:
        found = np.frombuffer(data, layouts[0].numbers)[0]
        ros = deserialize_message(data, type(message))
        for name in wanted:
            np.testing.assert_array_equal(np.ravel(found[name]), numbers_of(ros, name))


@given(st.lists(mutated(), min_size=2, max_size=6))
def test_what_is_remembered_of_a_message_never_misleads(series):
    """A checker, which is quick with messages like the one before, says of each what it would say of it alone."""
    message = series[0][0]
    checker = Checker(installed_definition(type(message)))
    for _, data in series:
        try:
            check(installed_definition(type(message)), data)
        except LayoutError:
            with pytest.raises(LayoutError):
                checker.check(data)
        else:
            assert checker.check(data) == data
            whole_message(type(message))(data)  # ROS reads it, too


READERS = {
    Imu: ("header.stamp", MessageReader(Imu, "header.stamp", {"angular_velocity": 3, "linear_acceleration": 3})),
    CoilCurrent: ("sample_stamp", MessageReader(CoilCurrent, "sample_stamp", {"current": 2})),
}


@given(mutated().filter(lambda harmed: type(harmed[0]) in READERS))
def test_readers_of_the_loop(harmed):
    """A time is refused as well that is negative or has more than a second of nanoseconds."""
    message, data = harmed
    stamp, reader = READERS[type(message)]
    try:
        time, numbers = reader.read(data)
    except LayoutError:
        return
    ros = deserialize_message(data, type(message))
    seconds, nanoseconds = numbers_of(ros, stamp)
    assert time == seconds * NANO + nanoseconds >= 0
    expected = [number for name in ("angular_velocity", "linear_acceleration") for number in numbers_of(ros, name)] \
        if isinstance(ros, Imu) else list(ros.current)  # fmt: skip
    np.testing.assert_array_equal(numbers, expected)


@given(st.binary(max_size=40))
def test_leading_stamp(data):
    """Any bytes: a time in nanoseconds, or a refusal."""
    try:
        stamp = leading_stamp(data)
    except LayoutError:
        assert len(data) < 12 or data[:2] not in (b"\0\0", b"\0\1")
    else:
        order = "little" if data[1] else "big"
        assert stamp == int.from_bytes(data[4:8], order, signed=True) * NANO + int.from_bytes(data[8:12], order)


@pytest.mark.parametrize("size", [0, 1, 10**6])
def test_a_frame_may_have_any_name(size):
    """A long one is read as well as none."""
    message = CoilCurrent(current=[0.5, 1.5])
    message.header.frame_id, message.sample_stamp.sec = "f" * size, 3
    assert READERS[CoilCurrent][1].read(serialize_message(message)) == (3 * NANO, [0.5, 1.5])
