"""Bags copied into others: byte for byte, whatever is attached, and no more than is wanted."""

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.rosbag2 import Reader
from trackvib_sim.bags.copying import copy_bag
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.bags.writing import BagWriter

from .conftest import TOPIC

pytestmark = pytest.mark.property

PICTURE = ("picture.png", "image/png", b"\x89PNG\xff\x00")


DEFINITION = b"string data  # as told by others\n"


def foreign_bag(folder, type_name="std_msgs/msg/String", metadata=None):
    """Write a bag of another tool's: one message, a topic without any, a JSON log, an attachment that is no text."""
    folder.mkdir()
    with (folder / "bag_0.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="other")
        schema = writer.register_schema(type_name, "ros2msg", DEFINITION)
        channels = [writer.register_channel(topic, "cdr", schema, metadata or {}) for topic in ("/spoken", "/silent")]
        channels.append(writer.register_channel("/log", "json", 0))
        writer.add_message(channels[0], 1, b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00", 3, 4)
        writer.add_message(channels[2], 2, b"{}", 2)
        writer.add_attachment(5, 6, *PICTURE)
        writer.finish()
    return folder


def copied(source, folder, *choice):
    """Copy a bag; returns its topics."""
    writer = BagWriter(folder)
    topics = copy_bag(source, writer, *choice)
    writer.close()
    return topics


def records(folder):
    """Return schema, channel and message of all messages, without the numbers that a file gives them."""
    (file,) = folder.glob("*.mcap")
    with file.open("rb") as stream:
        return [
            (schema and (schema.name, schema.encoding, schema.data), channel.topic, channel.message_encoding,
             channel.metadata, message.log_time, message.publish_time, message.sequence, message.data)
            for schema, channel, message in make_reader(stream).iter_messages()
        ]  # fmt: skip


def test_everything_is_copied(tmp_path, write_bag):
    """Messages with their times, topics with their QoS and hash."""
    messages = write_bag(tmp_path / "old", 50)
    writer = BagWriter(tmp_path / "new")
    assert copy_bag(tmp_path / "old", writer) == {TOPIC}
    writer.close()
    with Reader(tmp_path / "old") as old, Reader(tmp_path / "new") as new:
        assert [bytes(data) for *_, data in new.messages()] == messages
        assert [time for _, time, _ in new.messages()] == [time for _, time, _ in old.messages()]
        assert [each.ext for each in new.connections] == [each.ext for each in old.connections]
        assert [each.digest for each in new.connections] == [each.digest for each in old.connections]


@pytest.mark.parametrize("type_name", ["std_msgs/msg/String", "odd_msgs/msg/Odd", "std_srvs/srv/Trigger_Event", "Odd"])
@pytest.mark.parametrize("metadata", [{}, {"offered_qos_profiles": ""}, {"offered_qos_profiles": "- [:"}])
def test_bags_of_other_tools(tmp_path, type_name, metadata):
    """Whatever their types are and whether installed, with what others say of QoS; topics without messages as well."""
    source = foreign_bag(tmp_path / "other", type_name, metadata)
    assert copied(source, tmp_path / "bag") == {"/spoken", "/silent", "/log"}
    found = records(tmp_path / "bag")
    assert found == records(source) and len(found) == 2
    assert found[0][0] == (type_name, "ros2msg", DEFINITION)
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as file:
        (attached,) = make_reader(file).iter_attachments()
    assert (attached.name, attached.media_type, attached.data) == PICTURE
    assert (attached.create_time, attached.log_time) == (5, 6)


@pytest.mark.parametrize("metadata", [{}, {"offered_qos_profiles": ""}])
def test_copies_can_be_opened_by_others(tmp_path, metadata):
    """By `metadata.yaml`, which lists ROS's topics alone, and file by file."""
    copied(foreign_bag(tmp_path / "other", metadata=metadata), tmp_path / "bag")
    with Reader(tmp_path / "bag") as new:
        assert {each.topic: each.msgcount for each in new.connections} == {"/spoken": 1, "/silent": 0}
    with Reader(tmp_path / "bag" / "bag_0.mcap") as new:
        assert {each.topic: each.msgcount for each in new.connections} == {"/spoken": 1, "/silent": 0, "/log": 1}


def test_several_types_on_one_topic(tmp_path):
    """Each message keeps its own definition."""
    source = tmp_path / "other"
    source.mkdir()
    with (source / "bag_0.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="other")
        for time, name in enumerate(("odd_msgs/msg/One", "odd_msgs/msg/Other")):
            channel = writer.register_channel("/odd", "cdr", writer.register_schema(name, "ros2msg", DEFINITION))
            writer.add_message(channel, time, b"", time)
        writer.finish()
    assert copied(source, tmp_path / "bag") == {"/odd"}
    assert records(tmp_path / "bag") == records(source)


def test_what_is_not_wanted_is_left_out(tmp_path):
    """But its topic is announced all the same, for messages of here: with the definition of here, if there is one."""
    source = foreign_bag(tmp_path / "other")
    copied(source, tmp_path / "bag", lambda topic: topic == "/silent", lambda name: name != PICTURE[0])
    with Reader(tmp_path / "bag") as new:
        assert {each.topic: each.msgcount for each in new.connections} == {"/spoken": 0, "/silent": 0}
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as file:
        reader = make_reader(file)
        assert list(reader.iter_attachments()) == []
        summary = reader.get_summary()
    (spoken, silent) = (each.schema_id for each in summary.channels.values() if each.topic != "/log")
    assert summary.schemas[spoken].data == schema_text("std_msgs/msg/String").encode()
    assert summary.schemas[silent].data == DEFINITION
    odd = foreign_bag(tmp_path / "odd", "odd_msgs/msg/Odd")
    assert copied(odd, tmp_path / "none", lambda topic: False) == {"/spoken", "/silent", "/log"}
