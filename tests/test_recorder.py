"""The recorder with real processes: killed at any moment, topics by pattern, provenance, progress."""

import signal
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from builtin_interfaces.msg import Time
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from rclpy.qos import QoSProfile
from rosbags.rosbag2 import Reader
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import MountState
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.repair import repair
from trackvib_sim.bags.timekeeping import END_OF_TIME
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.messages import ImuMessage, MountMessage
from trackvib_sim.nodes.topic_choice import subscribe
from trackvib_sim.vehicle.mounts import MountSample

from .bag_helpers import attachment, counted
from .processes import trackvib

STREAM = Path(__file__).parent / "imu_stream.py"
LOOP_TOPICS = ("/chassis/imu", "/powertrain/imu", "/coil_current", "/mount_state")
SECOND, MS = 1_000_000_000, 1_000_000  # ns

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="kills real recorders")


def wait_for_more(observer, topic):
    """Wait for so many further messages of a stream as take it half a second."""
    messages = observer.collect(Imu, topic, LOOP_WRITER_QOS)
    observer.wait_until(lambda: len(messages) > 250)


@SLOW
@pytest.mark.parametrize(("seconds", "compression"), [(0.0, "zstd"), (0.3, "none"), (1.6, "zstd"), (2.5, "none")])
def test_killed_recorder_loses_the_last_second_at_most(start, start_node, observer, tmp_path, seconds, compression):
    """What it had taken a second before the kill is in the repaired bag, and nothing is missing between."""
    told = []  # when it told up to which stamp it had everything

    def on_recorded(until):
        told.append((time.monotonic_ns(), until.sec * SECOND + until.nanosec))

    observer.node.create_subscription(Time, "recorder/recorded", on_recorded, LATCHED_QOS)
    start([sys.executable, STREAM, "stream"])
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="[stream]", compression=compression)
    recorder.wait_for("recording 1 topics")
    observer.wait_until(lambda: told and told[-1][1] > 0)
    began = time.monotonic_ns()
    observer.wait_until(lambda: time.monotonic_ns() > began + seconds * SECOND)
    killed = time.monotonic_ns()
    recorder.signal(signal.SIGKILL)
    recorder.wait()
    assert not (tmp_path / "bag" / "metadata.yaml").exists()
    assert "index restored" in trackvib("bag", "repair", tmp_path / "bag")
    stamps, counts = counted(tmp_path / "bag", "/stream")
    with Reader(tmp_path / "bag") as reader:
        assert reader.message_count == len(stamps)
    np.testing.assert_array_equal(np.diff(counts), 1.0)
    if seconds > 1.0:
        assert stamps[0] < began and stamps[-1] >= max(until for when, until in told if when < killed - SECOND)


def test_a_topic_that_has_just_gone_is_not_taken_up(observer):
    """Between the look for topics and the subscription whoever published may end."""
    assert subscribe(observer.node, "/gone", print) is None


@SLOW
def test_killed_recorder_of_the_loop(start_node, observer, tmp_path):
    """The bag of a loop whose recorder was killed has its provenance, and every topic from the first sample on."""
    start_node("road_excitation")
    start_node("controller", law="skyhook", wait_for_recorder=True)
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("simulator", wait_for_recorder=True)
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 1.5)
    recorder.signal(signal.SIGKILL)
    recorder.wait()
    assert repair(tmp_path / "bag").files[0].messages > 1000
    found = contents(tmp_path / "bag")
    assert "parameters of /simulator" in found.provenance
    with Reader(tmp_path / "bag") as reader:
        for topic in LOOP_TOPICS:
            connections = [each for each in reader.connections if each.topic == topic]
            stamps = [stamp for _, stamp, _ in reader.messages(connections)]
            assert stamps == [k * MS for k in range(1, len(stamps) + 1)] != [], topic


@SLOW
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_messages_that_never_cease_do_not_keep_it_alive(start, start_node, observer, tmp_path, number):
    """Asked to end, it does while they go on; the bag is whole."""
    stream = start([sys.executable, STREAM, "one", "two", "three"])
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="[one, two, three]")
    recorder.wait_for("recording 3 topics")
    wait_for_more(observer, "three")
    recorder.signal(number)
    assert recorder.wait() == 0, recorder.output
    assert stream.running
    assert not repair(tmp_path / "bag").files
    for topic in ("/one", "/two", "/three"):
        np.testing.assert_array_equal(np.diff(counted(tmp_path / "bag", topic)[1]), 1.0)


@SLOW
def test_topics_by_pattern_are_taken_up_when_they_appear(start, start_node, observer, tmp_path):
    """Those that are there at the start, and later ones from their first sight on; no others."""
    start([sys.executable, STREAM, "left/imu", "left/other"])
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="['']", pattern="/imu$", chunk_size=64)
    recorder.wait_for("recording 1 topics")
    start([sys.executable, STREAM, "right/imu"])
    recorder.wait_for("/right/imu has appeared")
    wait_for_more(observer, "right/imu")
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    found = contents(tmp_path / "bag")
    assert set(found.types) == {"/left/imu", "/right/imu"}
    assert found.counts["/left/imu"] > found.counts["/right/imu"] > 100
    for topic in found.types:
        np.testing.assert_array_equal(np.diff(counted(tmp_path / "bag", topic)[1]), 1.0)
    assert found.provenance.count("parameters of /imu_stream") == 1


@SLOW
def test_bag_says_what_made_it(start_node, start, tmp_path):
    """Vehicle file and parameters lie in it as files; the parameters start the same nodes again."""
    start_node("road_excitation", seed=7, road="C")
    start_node("controller", law="skyhook", firm_current=2.5, wait_for_recorder=True)
    recorder = start_node("recorder", bag=tmp_path / "bag")
    assert start_node("simulator", duration=0.3, speed=7.5, wait_for_recorder=True).wait() == 0
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    bag = tmp_path / "bag"
    assert attachment(bag, "vehicle.yaml") == find_vehicle().read_text(encoding="utf-8")
    assert yaml.safe_load(attachment(bag, "versions.yaml"))["numpy"] == np.__version__
    road = yaml.safe_load(attachment(bag, "parameters/road_excitation.yaml"))
    assert road["/road_excitation"]["ros__parameters"]["seed"] == 7
    for name, values in (("controller", {"firm_current": 2.5, "law": "skyhook"}), ("simulator", {"speed": 7.5})):
        text = attachment(bag, f"parameters/{name}.yaml")
        assert values.items() <= yaml.safe_load(text)[f"/{name}"]["ros__parameters"].items()
        (tmp_path / f"{name}.yaml").write_text(text)
    again = start_node("controller", "--ros-args", "--params-file", tmp_path / "controller.yaml", "--")
    again.wait_for("law 'skyhook', waiting for accelerations")


@SLOW
def test_progress_is_that_of_the_slowest_topic(start_node, observer, tmp_path):
    """A recorder that has all accelerations but lacks mount states tells how far it has both."""
    node = observer.node
    still = MountSample(*(np.zeros(shape) for shape in (2, 2, 2, (2, 3), (2, 3), (2, 3), 2)))
    imus, mounts, told = ImuMessage("imu"), MountMessage(still), []
    imu_out = node.create_publisher(Imu, "chassis/imu", LOOP_WRITER_QOS)
    mount_out = node.create_publisher(MountState, "mount_state", LOOP_WRITER_QOS)
    node.create_subscription(Time, "recorder/recorded", lambda time: told.append(time.nanosec // MS), LATCHED_QOS)
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="[chassis/imu, mount_state]")
    recorder.wait_for("recording 2 topics")
    observer.wait_until(lambda: told == [0])
    for k in range(1, 101):
        imu_out.publish(imus.fill(k * MS, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0)))
        if k <= 40:
            mount_out.publish(mounts.fill(k * MS, still))
    observer.wait_until(lambda: told[-1] == 40)
    mount_out.publish(mounts.fill(70 * MS, still))
    observer.wait_until(lambda: told[-1] == 70)
    mount_out.publish(mounts.fill(100 * MS, still))
    observer.wait_until(lambda: told[-1] == 100)
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output


@SLOW
def test_no_sample_before_the_recorder_is_reached(start_node, observer):
    """A recorder whose subscription the simulator does not know yet, which says that it stands, misses nothing."""
    node, end = observer.node, Time(sec=END_OF_TIME // SECOND, nanosec=END_OF_TIME % SECOND)
    for topic in ("recorder/recorded", "recorder/recorded_answers"):
        node.create_publisher(Time, topic, LATCHED_QOS).publish(end)
    node.create_publisher(String, "recorder/topics", LATCHED_QOS).publish(String(data="/chassis/imu\n/coil_current"))
    start_node("road_excitation")
    start_node("controller").wait_for("waiting for accelerations")
    simulator = start_node("simulator", duration=0.05, wait_for_recorder=True)
    simulator.wait_for("waiting for a road")
    observer.wait_for(state="waiting")
    before = len(observer.told)
    observer.wait_until(lambda: len(observer.told) > before + 6)  # all others have come long since
    assert observer.values["state"] == "waiting" and float(observer.values["time"]) == 0.0
    heard = observer.collect(Imu, "chassis/imu", QoSProfile(depth=100))
    observer.wait_until(lambda: not simulator.running)
    assert simulator.wait() == 0, simulator.output
    assert len(heard) == 50


@pytest.mark.slow(reason="the same real recorder")
def test_latched_text_of_another_node_is_recorded(start_node, observer, tmp_path):
    """A topic published once before the recorder came is in the bag."""
    publisher = observer.node.create_publisher(String, "note", LATCHED_QOS)
    publisher.publish(String(data="told once"))
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="[note]")
    recorder.wait_for("recording 1 topics")
    observer.wait_until(lambda: publisher.get_subscription_count() == 1)
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    assert contents(tmp_path / "bag").counts == {"/note": 1}
