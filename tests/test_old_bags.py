"""Bags from before there could be any number of mounts are read, analysed, verified, replayed and played as ever."""

import json

import numpy as np
import pytest
from mr_mount_controller.mounting import PAIR
from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from rclpy.serialization import deserialize_message
from trackvib_msgs.msg import CoilCurrent, MountState
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.bags.playing import OpenBag
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.nodes.messages import message_type
from trackvib_sim.nodes.older_messages import renewal

from .old_bags import aged

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="drives the vehicle again, or real processes")


@pytest.fixture
def old(recorded_run, tmp_path):
    """The recorded bag as it would have been recorded then."""
    return aged(recorded_run / "bag", tmp_path / "old")


def messages(bag, topic, kind):
    """The messages of a topic as the player publishes them, and what makes them of those in the bag."""
    with OpenBag(bag) as reader:
        connections = [connection for connection in reader.connections if connection.topic == topic]
        renew = renewal(connections[0].schema, kind)
        data = [bytes(data) for _, _, data in reader.messages(connections)]
        return [deserialize_message(renew(each) if renew else each, kind) for each in data], renew


@pytest.mark.slow(reason="records a whole run")
def test_columns_and_numbers(recorded_run, old):
    """The same columns, the names of then, and the same numbers of every kind."""
    new, before = read_recording(recorded_run / "bag"), read_recording(old)
    assert new.mounting == before.mounting == PAIR
    for end, columns in new.streams.items():
        for now, then in zip(columns, before.streams[end], strict=True):
            np.testing.assert_array_equal(now, then)
    found = [analyse(recording) for recording in (new, before)]
    for part in ("sensors", "lines", "mounts", "demand", "timing", "loop"):
        assert repr(getattr(found[0], part)) == repr(getattr(found[1], part))


@pytest.mark.slow(reason="records a whole run")
@pytest.mark.parametrize(("topic", "kind"), [("/mount_state", MountState), ("/coil_current", CoilCurrent)])
def test_arrays_of_two_become_sequences_of_two(recorded_run, old, topic, kind):
    """With every number, stamp and frame; those of today are left alone."""
    now, nothing = messages(recorded_run / "bag", topic, kind)
    then, renew = messages(old, topic, kind)
    assert nothing is None and renew is not None
    assert len(then) == 3200 and then == now


@pytest.mark.slow(reason="records a whole run")
def test_only_what_has_changed_is_turned(recorded_run, old):
    """And what is damaged is refused as ever."""
    with OpenBag(recorded_run / "bag") as reader:
        assert not any(renewal(each.schema, message_type(each.type_name)) for each in reader.connections)
    with OpenBag(old) as reader:
        turned = [each for each in reader.connections if renewal(each.schema, message_type(each.type_name))]
        assert {each.topic for each in turned} == {"/mount_state", "/coil_current"}
        connection, _, data = next(iter(reader.messages(turned)))
        renew = renewal(connection.schema, message_type(connection.type_name))
        for damaged in (bytes(data)[:-8], bytes(data) + bytes(8)):
            with pytest.raises(LayoutError, match="shorter than its definition|does not fit"):
                renew(damaged)


@SLOW
def test_verified(start_cli, old):
    """To the last bit."""
    verified = start_cli("replay", old, "--verify")
    assert verified.wait() == 0, verified.output
    assert "identical to the last bit: 3200 of /mount_state" in verified.output


@SLOW
def test_under_a_law(start_cli, old, tmp_path):
    """What is written anew has the definitions of now, also where a reader compares hashes."""
    driven = start_cli("replay", old, "--law", "skyhook", "--out", tmp_path / "out")
    assert driven.wait() == 0, driven.output
    with OpenBag(tmp_path / "out" / "bag") as reader:
        assert not any(renewal(each.schema, message_type(each.type_name)) for each in reader.connections)
    before, again = read_recording(old), read_recording(tmp_path / "out" / "bag")
    for recorded, replayed in zip(before.mounts, again.mounts, strict=True):
        np.testing.assert_array_equal(recorded, replayed)


@SLOW
def test_into_a_controller(start_cli, old, tmp_path):
    """It is told of the pair, and answers as it did; the bag that is left holds both definitions and can be played."""
    asked = start_cli("replay", old, "--controller", "skyhook", "--out", tmp_path / "out")
    assert asked.wait() == 0, asked.output
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["identical"]
    assert len(messages(tmp_path / "out" / "bag", "/coil_current", CoilCurrent)[0]) == 3200
    assert len(messages(tmp_path / "out" / "bag", "/replayed/current", CoilCurrent)[0]) == 3200


@SLOW
def test_played(start_node, observer, recorded_run, old):
    """Whoever listens gets what those of today would have told him."""
    states = observer.collect(MountState, "mount_state", LOOP_WRITER_QOS)
    player = start_node("player", bag=old, topics="[mount_state]", end=0.5)
    observer.wait_until(lambda: len(states) >= 490)
    assert player.wait() == 0, player.output
    recorded, _ = messages(recorded_run / "bag", "/mount_state", MountState)
    expected = {each.header.stamp.nanosec: each for each in recorded[:999]}  # of the first second
    for data in states:
        state = deserialize_message(data, MountState)
        assert state == expected[state.header.stamp.nanosec]
