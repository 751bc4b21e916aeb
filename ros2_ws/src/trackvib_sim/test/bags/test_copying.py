"""Bags copied into others: byte for byte, whatever is attached, and no more than is wanted."""

import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.rosbag2 import Reader
from trackvib_sim.bags.copying import copy_bag
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.bags.writing import BagError, BagWriter

from .conftest import TOPIC

pytestmark = pytest.mark.property

PICTURE = ("picture.png", "image/png", b"\x89PNG\xff\x00")


def foreign_bag(folder, type_name):
    """Write a bag of another tool's: one message, a topic without any, something attached that is no text."""
    folder.mkdir()
    with (folder / "bag_0.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="other")
        schema = writer.register_schema(type_name, "ros2msg", schema_text("std_msgs/msg/String").encode())
        channels = [writer.register_channel(topic, "cdr", schema) for topic in ("/spoken", "/silent")]
        writer.add_message(channels[0], 1, b"\x00\x01\x00\x00\x02\x00\x00\x00a\x00", 1)
        writer.add_attachment(5, 6, *PICTURE)
        writer.finish()
    return folder


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


def test_bags_of_other_tools(tmp_path):
    """Topics without messages are announced, and what is attached need not be text."""
    writer = BagWriter(tmp_path / "bag")
    assert copy_bag(foreign_bag(tmp_path / "other", "std_msgs/msg/String"), writer) == {"/spoken", "/silent"}
    writer.close()
    with Reader(tmp_path / "bag") as new:
        assert {each.topic: each.msgcount for each in new.connections} == {"/spoken": 1, "/silent": 0}
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as file:
        (found,) = make_reader(file).iter_attachments()
    assert (found.name, found.media_type, found.data, found.create_time, found.log_time) == (*PICTURE, 5, 6)


def test_what_is_not_wanted_is_left_out(tmp_path):
    """But its topic is announced all the same."""
    writer = BagWriter(tmp_path / "bag")
    source = foreign_bag(tmp_path / "other", "std_msgs/msg/String")
    copy_bag(source, writer, lambda topic: topic != "/spoken", lambda name: name != PICTURE[0])
    writer.close()
    with Reader(tmp_path / "bag") as new:
        assert {each.topic: each.msgcount for each in new.connections} == {"/spoken": 0, "/silent": 0}
    with (tmp_path / "bag" / "bag_0.mcap").open("rb") as file:
        assert list(make_reader(file).iter_attachments()) == []


def test_a_type_that_is_not_installed_is_named(tmp_path):
    """With its topic."""
    writer = BagWriter(tmp_path / "bag")
    with pytest.raises(BagError, match="the type odd_msgs/msg/Odd of /spoken is not installed here"):
        copy_bag(foreign_bag(tmp_path / "other", "odd_msgs/msg/Odd"), writer)
    writer.close()
