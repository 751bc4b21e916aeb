"""Bags, controllers and parameter files of others, with real processes: used as far as they go, and what does not fit
is named once."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from mr_mount_controller.node_base.qos import LOOP_QOS
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent

sys.path.append(str(Path(__file__).parents[1] / "ros2_ws/src/trackvib_sim/test/bags"))  # its generator of foreign bags
from foreign_bags import TOPICS, imus, stamps, write_foreign  # noqa: E402

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="starts nodes beside those of others")]
DEEP = QoSProfile(depth=5000)


def odd_topics(writer):
    """Add what the player cannot play, and a topic with two types of which the second is left out."""
    for topic, name, encoding, text, messages in (
        ("/gnss", "some_vendor_msgs/msg/Heading", "ros2msg", b"float64 heading\n", "cdr"),
        ("/add/_service_event", "example_interfaces/srv/AddTwoInts_Event", "ros2msg", b"int64 a\n", "cdr"),
        ("/broken", "std_msgs/msg/String", "ros2msg", b"string = = [", "cdr"),
        ("/json", "std_msgs/msg/String", "ros2msg", b"string data", "json"),
        (TOPICS[0], "std_msgs/msg/String", "ros2msg", b"string data", "cdr"),
    ):
        schema = writer.register_schema(name, encoding, text)
        channel = writer.register_channel(topic, messages, schema, {"offered_qos_profiles": "- 7"})
        writer.add_message(channel, int(stamps(1)[0]), bytes(12), 0)


def test_the_player_plays_what_it_can(start_node, observer, tmp_path):
    """QoS of Humble that lacks keys; unknown types, services, broken definitions are named once and left out."""
    qos = "- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n"
    write_foreign(tmp_path / "bag" / "bag_0.mcap", {TOPICS[0]: stamps(200)}, qos=qos, more=odd_topics)
    heard = observer.collect(Imu, TOPICS[0], DEEP)
    player = start_node("player", bag=tmp_path / "bag", rate=2)
    observer.wait_until(lambda: len(heard) == 200 and not player.running)
    assert player.wait() == 0, player.output
    assert heard == imus(stamps(200).tolist())
    for words in (
        "/gnss is left out: message type some_vendor_msgs/msg/Heading is not installed",
        "/add/_service_event is left out: example_interfaces/srv/AddTwoInts_Event is not a message type",
        "/broken is left out: definition of std_msgs/msg/String cannot be read",
        "/json is left out: its messages are in 'json'",
        "/chassis/imu is left out: std_msgs/msg/String is a second type on this topic",
    ):
        assert player.output.count(words) == 1, player.output


@pytest.fixture
def answering(observer):
    """Answer as somebody else's controller: `answering(qos, stamp_of)`; returns the list of answers."""

    def make(qos, stamp_of=lambda imu: imu.header.stamp):
        answers = []
        out = observer.node.create_publisher(CoilCurrent, "coil_current", qos)

        def answer(imu):
            answers.append(CoilCurrent(sample_stamp=stamp_of(imu), current=[1.5, 1.5]))
            out.publish(answers[-1])

        observer.node.create_subscription(Imu, "powertrain/imu", answer, qos)
        return answers

    return make


def test_a_best_effort_controller_is_heard(start_node, observer, answering):
    """Its answers count like others, and the simulator says once what that means: now and then one is lost."""
    answers = answering(qos_profile_sensor_data)
    start_node("road_excitation")
    simulator = start_node("simulator", duration=0.2)
    observer.wait_until(lambda: not simulator.running)
    assert simulator.wait() == 0, simulator.output
    assert simulator.output.count("observer answers on coil_current with best effort") == 1
    assert 100 < int(re.search(r"answers: (\d+) accepted", simulator.output)[1]) <= len(answers) <= 200


def test_who_cannot_hear_is_named(start_node, observer):
    """A listener that wants what came before is told why nothing comes."""
    kept = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
    observer.collect(Imu, "chassis/imu", kept)
    observer.collect(Imu, "powertrain/imu", LOOP_QOS)
    simulator = start_node("simulator")
    words = "/observer receives nothing on /chassis/imu, its QoS is incompatible: ERROR: Volatile publisher"
    observer.wait_until(lambda: words in simulator.output and observer.values.get("state") == "waiting")
    assert simulator.output.count(words) == 1 and "receives nothing on /powertrain/imu" not in simulator.output


def offset_bag(folder):
    """Write half a second of two sensors at 499.98 Hz, the second stamped 0.4 ms later; returns its path."""
    stamp = stamps(250, 499.98)
    write_foreign(folder / "bag_0.mcap", dict(zip(TOPICS, (stamp, stamp + 400_000), strict=True)))
    return folder


@pytest.mark.parametrize("whole_ms", [False, True])
def test_any_rate_and_offset_into_the_stock_controller(start_cli, tmp_path, whole_ms):
    """Samples are paired within half a period; the rate need not divide a second, nor the stamps be even."""
    bag = tmp_path / "bag"
    if whole_ms:
        stamp = stamps(400, 833.0) // 1_000_000 * 1_000_000
        write_foreign(bag / "bag_0.mcap", dict.fromkeys(TOPICS, np.unique(stamp)))
    else:
        offset_bag(bag)
    samples = len(np.unique(stamp)) if whole_ms else 250
    replay = start_cli("replay", bag, "--controller", "skyhook", "--out", tmp_path / "out")
    assert replay.wait() == 0, replay.output
    assert f"{samples} of {samples} samples answered" in replay.output
    assert ("0.4 ms apart at most" in " ".join(replay.output.split())) is not whole_ms


def test_offset_stamps_into_somebody_elses_controller(start_cli, observer, answering, tmp_path):
    """Heard with best effort, by which now and then a message is lost."""
    answers = answering(qos_profile_sensor_data)
    replay = start_cli("replay", offset_bag(tmp_path / "bag"), "--controller", "external", "--out", tmp_path / "out")
    observer.wait_until(lambda: not replay.running)
    assert replay.wait() == 0, replay.output
    assert 125 < int(re.search(r"(\d+) of 250 samples answered", replay.output)[1]) <= len(answers) <= 250


def test_answers_to_no_sample_are_an_error(start_cli, observer, answering, tmp_path):
    """One that stamps its answers with the time of the day: nothing is left behind."""
    answering(LOOP_QOS, lambda imu: observer.node.get_clock().now().to_msg())
    replay = start_cli("replay", offset_bag(tmp_path / "bag"), "--controller", "external", "--out", tmp_path / "out")
    observer.wait_until(lambda: not replay.running)
    assert replay.wait() == 1
    words = " ".join(replay.output.split())
    assert "the controller answered none of 250 samples; answers: " in words and " early. sample_stamp" in words
    assert not (tmp_path / "out").exists() and "Traceback" not in words


def test_a_file_of_parameters_for_many_nodes(start_node, tmp_path):
    """What others need is named once; what is given to a node by its name must exist; one for others only is named."""
    shared, own = tmp_path / "shared.yaml", tmp_path / "own.yaml"
    shared.write_text("/**:\n  ros__parameters: {law: skyhook, speed: 12, gain: {upper: 1.0}, sample_rate: 500}\n")
    own.write_text("lab:\n  controller:\n    ros__parameters: {law: skyhook, speed: 12.0}\n")
    controller = start_node("controller", "--ros-args", "--params-file", shared, "--")
    controller.wait_for("law 'skyhook', waiting for accelerations")
    assert controller.output.count("parameters that this node does not have: gain.upper, speed") == 1
    elsewhere = start_node("controller", "--ros-args", "--params-file", own, "-r", "__ns:=/other", "--")
    elsewhere.wait_for("has sections for /lab/controller, but the nodes here are /other/controller")
    nested = start_node("controller", "--ros-args", "--params-file", own, "-r", "__ns:=/lab", "--")
    assert nested.wait() == 2 and "unknown parameter 'speed'" in nested.output
