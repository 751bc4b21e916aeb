"""Reading of bags as columns: bit for bit what rosbags' deserialisation gives."""

import shutil
from collections import Counter

import numpy as np
import pytest
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from std_msgs.msg import String
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.numerics.units import NANO

from .made_bags import PERIODS, TYPES, write_bag


def decoded(path):
    """Return the messages of a bag by the ends of their topics, in the bag's order, as rosbags decodes them."""
    found = {end: [] for end in TYPES}
    with AnyReader([path]) as reader:
        for connection, _, data in reader.messages():
            end = next(end for end in TYPES if connection.topic.endswith(end))
            found[end].append(reader.deserialize(data, connection.msgtype))
    return found


def nanoseconds(stamp):
    return stamp.sec * NANO + stamp.nanosec


def vectors(messages, field):
    """Return the field (k, ..., 3) of some messages, a vector or an array of vectors."""
    values = (np.atleast_1d(getattr(message, field)) for message in messages)
    return np.squeeze([[(each.x, each.y, each.z) for each in value] for value in values])


def same(recording, messages):
    """Compare all columns of a recording with decoded messages, bit for bit."""
    for end, sensor in (("chassis/imu", recording.chassis), ("powertrain/imu", recording.powertrain)):
        np.testing.assert_array_equal(sensor.stamp, [nanoseconds(m.header.stamp) for m in messages[end]])
        np.testing.assert_array_equal(sensor.specific_force, vectors(messages[end], "linear_acceleration"))
        np.testing.assert_array_equal(sensor.angular_velocity, vectors(messages[end], "angular_velocity"))
    mounts, states = recording.mounts, messages["mount_state"]
    np.testing.assert_array_equal(mounts.stamp, [nanoseconds(m.header.stamp) for m in states])
    for name in ("current", "stiffness", "damping", "dissipated_power"):
        np.testing.assert_array_equal(getattr(mounts, name), [getattr(m, name) for m in states])
    for name in ("deflection", "velocity", "force"):
        columns = getattr(mounts, name)
        np.testing.assert_array_equal(columns, np.reshape(vectors(states, name), columns.shape))
    answers, odometry = messages["coil_current"], messages["odometry"]
    np.testing.assert_array_equal(recording.answers.sample_stamp, [nanoseconds(m.sample_stamp) for m in answers])
    np.testing.assert_array_equal(recording.answers.current, [m.current for m in answers])
    np.testing.assert_array_equal(recording.odometry.stamp, [nanoseconds(m.header.stamp) for m in odometry])
    places = [(p.x, p.y, p.z) for p in (m.pose.pose.position for m in odometry)]
    np.testing.assert_array_equal(recording.odometry.position, places)
    np.testing.assert_array_equal(recording.odometry.speed, [m.twist.twist.linear.x for m in odometry])


@pytest.mark.property
@pytest.mark.parametrize("frames", [("chassis_imu_link",), ("a", "some_frame", "b_of_other_length")])
@pytest.mark.parametrize("space", ["/", "/left/of/two/"])
def test_columns_are_what_rosbags_decodes(tmp_path, space, frames):
    """Also in a namespace, and of a topic whose messages differ in length."""
    write_bag(tmp_path / "bag", 300, space, frames=frames)
    recording = read_recording(tmp_path / "bag")
    assert len(recording.chassis.stamp) == 300
    same(recording, decoded(tmp_path / "bag"))


@pytest.mark.property
def test_all_else_in_a_bag(bag):
    """Counts, the simulator's last values, provenance and vehicle."""
    recording = read_recording(bag)
    same(recording, decoded(bag))
    counts = dict.fromkeys(("/chassis/imu", "/powertrain/imu", "/mount_state", "/coil_current"), PERIODS)
    rare = {"/odometry": PERIODS // 10, "/diagnostics": PERIODS // 100, "/vehicle_description": 1}
    assert recording.counts == Counter(counts | rare)
    assert recording.diagnostics == {"time": "2.5", **{f"key_{k}": "1" for k in range(100, PERIODS + 1, 100)}}
    assert recording.provenance["parameters of /simulator"]["engine_speed"] == "1650.0"
    assert recording.vehicle == "engine: none"


@pytest.mark.property
def test_one_file_and_several_files_are_bags_too(bag, tmp_path):
    """A file by itself; files of a bag that was split, the tenth after the second."""
    file = next(bag.glob("*.mcap"))
    assert len(read_recording(file).chassis.stamp) == PERIODS
    for number in (10, 2):
        shutil.copy(file, tmp_path / f"bag_{number}.mcap")
    (tmp_path / "bag_2.mcap").write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    stamp = read_recording(tmp_path).chassis.stamp
    back = np.flatnonzero(np.diff(stamp) < 0)
    assert len(back) == 1 and len(stamp) == back[0] + 1 + PERIODS


@pytest.mark.property
def test_topics_that_are_not_there(tmp_path):
    """Optional ones are None; a sensor that is missing has no numbers, and a run that needs it is refused."""
    write_bag(tmp_path / "few", 20, topics=("chassis/imu", "powertrain/imu"))
    few = read_recording(tmp_path / "few")
    assert (few.mounts, few.answers, few.odometry, few.vehicle, few.diagnostics) == (None, None, None, None, {})
    write_bag(tmp_path / "bag", 20, topics=("chassis/imu", "mount_state"))
    alone = read_recording(tmp_path / "bag")
    assert set(alone.origins) == {"chassis"} and np.isnan(alone.powertrain.specific_force).all()
    with pytest.raises(BagError, match="holds no messages on powertrain/imu"):
        alone.require()


@pytest.mark.property
def test_a_topic_of_another_type_is_another_topic(tmp_path):
    """What only has the name of a sensor is not taken for one."""
    bag = BagWriter(tmp_path / "bag")
    bag.add_topic("/chassis/imu", "std_msgs/msg/String", [], "")
    bag.write("/chassis/imu", 1, serialize_message(String(data="text")))
    bag.close()
    with pytest.raises(BagError, match="holds no sensor_msgs/msg/Imu on chassis/imu, powertrain/imu"):
        read_recording(tmp_path / "bag")


@pytest.mark.property
def test_nonsense_is_refused(tmp_path):
    """Nothing, an empty folder, an empty file and a file that is no bag are named."""
    with pytest.raises(BagError, match="nothing' does not exist"):
        read_recording(tmp_path / "nothing")
    with pytest.raises(BagError, match=r"holds no \.mcap file"):
        read_recording(tmp_path)
    for content in (b"", b"no bag at all, but some text"):
        (tmp_path / "text.mcap").write_bytes(content)
        with pytest.raises(BagError, match=r"text\.mcap' cannot be read"):
            read_recording(tmp_path / "text.mcap")


@pytest.mark.property
def test_sensors_of_two_vehicles_are_refused(tmp_path, bag):
    """Which of them would be meant is not guessed."""
    write_bag(tmp_path / "bag", 20, "/other/")
    shutil.copy(next(bag.glob("*.mcap")), tmp_path / "bag" / "bag_1.mcap")
    (tmp_path / "bag" / "metadata.yaml").unlink()  # which lists the first file alone
    with pytest.raises(BagError, match="several vehicles.*/other/chassis/imu"):
        read_recording(tmp_path / "bag")


@pytest.mark.property
def test_what_one_run_needs(bag, tmp_path):
    """A part that is missing is named by its topic; stamps that go back are another run."""
    recording = read_recording(bag)
    recording.require("mounts", "vehicle")
    with pytest.raises(BagError, match=r"bag' holds no messages on road_profile$"):
        recording.require("mounts", "road", "vehicle")
    file = next(bag.glob("*.mcap"))
    for number in range(2):
        shutil.copy(file, tmp_path / f"bag_{number}.mcap")
    with pytest.raises(BagError, match=r"more than one run: after t = 2\.500 s /chassis/imu starts again"):
        read_recording(tmp_path).require()
