"""Reading of bags as columns: bit for bit what rosbags' deserialisation gives, whatever the bag's state."""

import shutil
from collections import Counter

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.records import Metadata
from mcap.writer import CompressionType, Writer
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from std_msgs.msg import String
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.writing import BagError, BagWriter
from trackvib_sim.simulation.settings import NANO

from .made_bags import TYPES, write_bag

PERIODS = 2500  # three chunks


@pytest.fixture
def rewritten(tmp_path):
    """Write the first messages of a bag again: `rewritten(bag, definition=..., more=...)` returns the new file.

    `definition(topic, data)` returns the definition that a topic shall have; `more(writer)` adds to the file.
    """

    def make(bag, definition=lambda topic, data: data, more=lambda writer: None):
        file, channels = tmp_path / "rewritten.mcap", {}
        with file.open("wb") as stream:
            # no chunks, for their checksum would find what is damaged
            writer = Writer(stream, compression=CompressionType.NONE, use_chunking=False)
            writer.start(profile="ros2", library="other")
            for record in raw_records(bag):
                if isinstance(record, Metadata):
                    writer.add_metadata(record.name, record.metadata)
                elif isinstance(record, RawMessage) and record.topic not in channels:
                    schema = definition(record.topic, record.schema.data)
                    schema = writer.register_schema(record.type_name, record.schema.encoding, schema)
                    channels[record.topic] = writer.register_channel(record.topic, "cdr", schema)
                elif isinstance(record, RawMessage) and record.message is not None:
                    writer.add_message(channels[record.topic], record.message.log_time, record.message.data, 0)
            more(writer)
            writer.finish()
        return file

    return make


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    """A bag of all topics."""
    path = tmp_path_factory.mktemp("bags") / "bag"
    write_bag(path, PERIODS, vehicle="engine: none")
    return path


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
        np.testing.assert_array_equal(sensor.rate, vectors(messages[end], "angular_velocity"))
    mounts, states = recording.mounts, messages["mount_state"]
    np.testing.assert_array_equal(mounts.stamp, [nanoseconds(m.header.stamp) for m in states])
    for name in ("current", "stiffness", "damping", "dissipated_power"):
        np.testing.assert_array_equal(getattr(mounts, name), [getattr(m, name) for m in states])
    for name in ("deflection", "velocity", "force"):
        np.testing.assert_array_equal(getattr(mounts, name), vectors(states, name))
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
@given(share=st.floats(0.0, 1.0))
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_bag_cut_anywhere_is_read_as_far_as_it_goes(bag, tmp_path, share):
    """What is read is the beginning of the whole, message for message what `bag repair` keeps; or a clear error."""
    whole, data = read_recording(bag), next(bag.glob("*.mcap")).read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(data[: int(share * len(data))])
    try:
        recording = read_recording(cut)
    except BagError as error:
        assert share < 0.25 and str(cut) in str(error)  # a quarter holds a whole block of 128 KiB
        return
    kept = Counter(each.topic for each in raw_records(cut) if isinstance(each, RawMessage) and each.message is not None)
    assert recording.counts == kept
    assert whole.complete
    if kept != whole.counts:
        assert not recording.complete
    for part in ("chassis", "powertrain", "mounts", "answers"):
        for found, column in zip(getattr(recording, part), getattr(whole, part), strict=True):
            np.testing.assert_array_equal(found, column[: len(found)])


@pytest.mark.property
@given(place=st.floats(0.0, 1.0, exclude_max=True), bit=st.integers(0, 7))
@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_damaged_bag_never_gives_wrong_numbers(bag, tmp_path, place, bit):
    """A flipped bit makes a clear error, or costs whole chunks, or hits what is not needed."""
    whole, data = read_recording(bag), bytearray(next(bag.glob("*.mcap")).read_bytes())
    data[int(place * len(data))] ^= 1 << bit
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    try:
        recording = read_recording(damaged)
    except BagError as error:
        assert str(damaged) in str(error)
        return
    there = np.isin(whole.chassis.stamp, recording.chassis.stamp)
    np.testing.assert_array_equal(recording.chassis.specific_force, whole.chassis.specific_force[there])


@pytest.mark.property
def test_topics_that_are_not_there(tmp_path):
    """Optional ones are None; a sensor that is missing is an error that names it."""
    write_bag(tmp_path / "few", 20, topics=("chassis/imu", "powertrain/imu"))
    few = read_recording(tmp_path / "few")
    assert (few.mounts, few.answers, few.odometry, few.vehicle, few.diagnostics) == (None, None, None, None, {})
    write_bag(tmp_path / "bag", 20, topics=("chassis/imu", "mount_state"))
    with pytest.raises(BagError, match="holds no sensor_msgs/msg/Imu on powertrain/imu"):
        read_recording(tmp_path / "bag")


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
    with pytest.raises(BagError, match="nothing' is not there"):
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
    with pytest.raises(BagError, match="several vehicles.*/other/chassis/imu"):
        read_recording(tmp_path / "bag")


@pytest.mark.property
def test_a_damaged_chunk_is_named_with_the_way_out(bag, tmp_path):
    """Numbers with a hole that nobody sees are worse than none."""
    data = bytearray(next(bag.glob("*.mcap")).read_bytes())
    data[len(data) // 2] ^= 1
    (tmp_path / "bag_0.mcap").write_bytes(data)
    with pytest.raises(BagError, match="damaged.*bag repair` keeps the others"):
        read_recording(tmp_path)


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
    with pytest.raises(BagError, match=r"more than one run: after t = 2\.500 s /chassis/imu begins anew"):
        read_recording(tmp_path).require()


@pytest.mark.property
@pytest.mark.parametrize(
    ("end", "good", "bad"),
    [
        ("chassis/imu", b"MSG: std_msgs/Header", b"MSG: std_msgs/Heade2"),  # what it is made of is not there
        ("odometry", b"pose\n", b"posd\n"),
        ("vehicle_description", b"string data", b"string date"),
        ("vehicle_description", b"string data", b"stri~g data"),
        ("diagnostics", b"MSG: diagnostic_msgs/KeyValue", b"MSG: diagnostic_msgs/KeyValuf"),
        ("diagnostics", b"builtin_interfaces/Time stamp", b"string                    stamp"),
    ],
)
def test_damaged_definitions_are_refused(bag, rewritten, end, good, bad):
    """Whatever they do to the reader, the bag is named."""

    def definition(topic, data):
        assert topic != f"/{end}" or good in data
        return data.replace(good, bad) if topic == f"/{end}" else data

    with pytest.raises(BagError, match=r"rewritten\.mcap' cannot be read: ."):
        read_recording(rewritten(bag, definition))


@pytest.mark.property
def test_a_damaged_metadata_record_is_refused(bag, rewritten):
    """A length in it that leaves less behind it than the next length takes."""
    file = rewritten(bag, more=lambda writer: writer.add_metadata("note", {"k1": "val"}))
    data = bytearray(file.read_bytes())
    data[data.index(b"\x02\0\0\0k1\x03\0\0\0val")] ^= 4
    file.write_bytes(data)
    with pytest.raises(BagError, match=r"rewritten\.mcap' cannot be read: ."):
        read_recording(file)


@pytest.mark.property
def test_numbers_beyond_all_measure_are_refused(tmp_path):
    """What the simulator told is text, and may be longer than a number."""
    write_bag(tmp_path / "bag", 20)
    told = DiagnosticStatus(name="simulator", values=[KeyValue(key="silent_periods", value="9" * 30)])
    bag = BagWriter(tmp_path / "bag" / "told")
    bag.add_topic("/diagnostics", TYPES["diagnostics"], [], "")
    bag.write("/diagnostics", 1, serialize_message(DiagnosticArray(status=[told])))
    bag.close()
    shutil.move(tmp_path / "bag" / "told" / "told_0.mcap", tmp_path / "bag" / "bag_1.mcap")
    with pytest.raises(BagError, match="bag' cannot be read: .*too large"):
        read_recording(tmp_path / "bag")


@pytest.mark.property
def test_channels_without_a_definition_are_counted(bag, rewritten):
    """A log of another tool beside the run, even under the name of a topic of ours; a lost definition is an error."""

    def log(writer, schema=0):
        for topic in ("/log", "/other/chassis/imu"):
            writer.add_message(writer.register_channel(topic, "json", schema), 1, b"{}", 1)

    recording = read_recording(rewritten(bag, more=log))
    np.testing.assert_array_equal(recording.chassis.stamp, read_recording(bag).chassis.stamp)
    assert (recording.counts["/log"], recording.counts["/other/chassis/imu"]) == (1, 1)
    with pytest.raises(BagError, match="which nothing announces"):
        read_recording(rewritten(bag, more=lambda writer: log(writer, 99)))


@pytest.mark.property
def test_a_folder_that_is_called_like_a_file_is_none(tmp_path):
    """It is not read, and alone it makes no bag."""
    write_bag(tmp_path / "bag", 20)
    (tmp_path / "bag" / "a.mcap").mkdir()
    assert len(read_recording(tmp_path / "bag").chassis.stamp) == 20
    with pytest.raises(BagError, match=r"a\.mcap' holds no \.mcap file"):
        read_recording(tmp_path / "bag" / "a.mcap")


@pytest.mark.property
def test_a_file_that_the_system_cannot_read_is_named(bag, monkeypatch):
    """Also where only the contents are looked up."""

    def refused(*arguments):
        raise PermissionError(13, "Permission denied")

    file = next(bag.glob("*.mcap"))
    monkeypatch.setattr(type(file), "open", refused)
    with pytest.raises(BagError, match=r"bag_0\.mcap' cannot be read: Permission denied"):
        contents(bag)
