"""Reading of bags that are cut short, damaged, or another tool's: never wrong numbers, one clear error at most."""

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
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.writing import BagWriter

from .made_bags import TYPES, write_bag


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


@pytest.mark.slow(reason="reads a bag cut at many places")
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
            if column is not None:
                np.testing.assert_array_equal(found, column[: len(found)])


@pytest.mark.slow(reason="reads many damaged bags")
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
def test_a_damaged_chunk_is_named_with_the_way_out(bag, tmp_path):
    """Numbers with a hole that nobody sees are worse than none."""
    data = bytearray(next(bag.glob("*.mcap")).read_bytes())
    data[len(data) // 2] ^= 1
    (tmp_path / "bag_0.mcap").write_bytes(data)
    with pytest.raises(BagError, match="damaged at byte .*bag repair` keeps everything else"):
        read_recording(tmp_path)


@pytest.mark.property
@pytest.mark.parametrize(
    ("end", "good", "bad"),
    [
        ("chassis/imu", b"std_msgs/Header header", b"std_msgs/Heade2 header"),  # what it is made of is not there
        ("odometry", b"pose\n", b"posd\n"),
        ("vehicle_description", b"string data", b"string date"),
        ("vehicle_description", b"string data", b"stri~g data"),
        ("diagnostics", b"\nKeyValue[]", b"\nKeyValuf[]"),
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
    (tmp_path / "bag" / "metadata.yaml").unlink()  # which lists the first file alone
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
    with pytest.raises(BagError, match="which is not declared"):
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
