"""Whole messages that make no sense: each is refused, said once, and the node goes on."""

import math
import signal

import pytest
from builtin_interfaces.msg import Time
from mr_mount_controller.mounting import undescribed
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS, ROAD_QOS
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent, DriveState, MountDescription, RoadProfile
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.nodes.messages import ImuMessage, mount_description

from .conftest import UNHURRIED
from .processes import assert_in_good_health

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="real processes that are sent what nobody expects")]
MS = 1_000_000  # ns


def test_road_node(start_node, observer):
    """A place that is none is refused; a vehicle that stands somewhere else still gets its road."""
    patches = observer.collect(RoadProfile, "road_profile", ROAD_QOS)
    publisher = observer.node.create_publisher(DriveState, "drive_state", LATCHED_QOS)
    road = start_node("road_excitation")
    observer.wait_until(publisher.get_subscription_count)
    for position in (math.nan, math.inf, -math.inf, 1e300, -1e9):
        publisher.publish(DriveState(distance=position))
    road.wait_for("distance is nan m, accepted: -100000000 to 100000000 m")
    drive = DriveState(distance=1000.0)
    drive.header.stamp.sec = 1
    publisher.publish(drive)
    observer.wait_until(lambda: any(deserialize_message(data, RoadProfile).start == 1000.0 for data in patches))
    assert_in_good_health(road)


def test_controller_takes_no_number_that_no_sensor_measures(start_node, observer):
    """The pair that has one is as if it had not come; the next one is answered."""
    answers = observer.collect(CoilCurrent, "coil_current", LOOP_WRITER_QOS)
    outs = [observer.node.create_publisher(Imu, f"{part}/imu", LOOP_WRITER_QOS) for part in ("chassis", "powertrain")]
    controller = start_node("controller", law="skyhook", coils=2)
    for out in outs:
        observer.wait_until(out.get_subscription_count)
    imu = ImuMessage("imu")
    answered = lambda: [deserialize_message(data, CoilCurrent).sample_stamp.nanosec // MS for data in answers]  # noqa: E731

    def send(stamp, force):
        for out in outs:
            out.publish(imu.fill(stamp * MS, (0.0, 0.0, force), (0.0, 0.0, 0.0)))

    send(1, 9.81)
    # only then do both of its readers hear: one that was found later would get all its messages after the other's
    observer.wait_until(lambda: answered() == [1])
    for stamp, force in ((2, math.nan), (3, math.inf), (4, 1e300), (5, 9.81)):
        send(stamp, force)
    observer.wait_until(lambda: answered() == [1, 5])
    assert_in_good_health(controller)
    assert "6 messages were refused" in controller.output


def test_first_patch_of_another_road(start_node, observer):
    """It does not fix the spacing; the road node's patches are driven on, and what is refused is said once."""
    publisher = observer.node.create_publisher(RoadProfile, "road_profile", ROAD_QOS)
    simulator = start_node("simulator")
    observer.wait_until(publisher.get_subscription_count)
    publisher.publish(RoadProfile(spacing=0.5, left=[0.0, 0.0], right=[0.0, 0.0]))
    for k in range(1000):
        publisher.publish(RoadProfile(start=0.1 * k, spacing=math.nan, left=[0.0, 0.0], right=[0.0, 0.0]))
    observer.wait_until(lambda: int(observer.values.get("refused", 0)) > 10)
    start_node("road_excitation")
    start_node("controller")
    observer.wait_for(state="running")
    before = observer.values["refused"]
    publisher.publish(RoadProfile(spacing=0.5, left=[0.0, 0.0], right=[0.0, 0.0]))
    observer.wait_until(lambda: observer.values["refused"] != before)
    assert_in_good_health(simulator)


def test_one_message_is_no_second_clock(start_node, observer):
    """A time far ahead ends no run; whose clock goes on is another simulator, and the one behind gives way."""
    publisher = observer.node.create_publisher(Clock, "/clock", QoSProfile(depth=10))
    start_node("road_excitation")
    start_node("controller")
    simulator = start_node("simulator")
    observer.wait_for(state="running")
    observer.wait_until(publisher.get_subscription_count)
    ahead = Clock(clock=Time(sec=2**31 - 1, nanosec=999_999_999))
    publisher.publish(ahead)
    time = float(observer.values["time"])
    observer.wait_until(lambda: float(observer.values["time"]) > time + 3.0)
    assert simulator.running

    def has_given_way():
        publisher.publish(ahead)
        return not simulator.running

    observer.wait_until(has_given_way)
    assert "error: another simulator publishes /clock" in simulator.output


def test_controller_takes_no_description_that_makes_no_sense(start_node, observer):
    """It says why, and goes on with the one before: answers keep their number."""
    answers = observer.collect(CoilCurrent, "coil_current", LOOP_WRITER_QOS)
    outs = [observer.node.create_publisher(Imu, f"{part}/imu", LOOP_WRITER_QOS) for part in ("chassis", "powertrain")]
    told = observer.node.create_publisher(MountDescription, "mount_description", LATCHED_QOS)
    controller = start_node("controller", law="skyhook")
    for out in (*outs, told):
        observer.wait_until(out.get_subscription_count)

    def answered_after(stamp):
        for out in outs:
            out.publish(ImuMessage("imu").fill(stamp * MS, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0)))
        latest = lambda: deserialize_message(answers[-1], CoilCurrent)  # noqa: E731
        observer.wait_until(lambda: answers and latest().sample_stamp.nanosec == stamp * MS)
        return len(latest().current)

    controller.wait_for("waiting for accelerations and mount_description")
    told.publish(mount_description(undescribed(4)))
    controller.wait_for("coils: mount 1, mount 2, mount 3, mount 4")
    assert answered_after(1) == 4
    twice = mount_description(undescribed(3))
    twice.mounts[1].name = "mount 1"
    told.publish(twice)
    controller.wait_for("refused: mount names are mount 1, mount 1, mount 3, must be unique")
    assert answered_after(2) == 4
    told.publish(mount_description(undescribed(16, 20)))
    controller.wait_for("mount 16")
    assert answered_after(3) == 16
    assert_in_good_health(controller)


def test_an_answer_of_another_number_is_refused(start_node, observer, tmp_path):
    """The simulator counts it and falls silent; the bag holds it and is read all the same."""
    publisher = observer.node.create_publisher(CoilCurrent, "coil_current", LOOP_WRITER_QOS)
    start_node("controller")
    recorder = start_node("recorder", bag=tmp_path / "bag")
    simulator = start_node("simulator", wait_for_recorder=True, answer_timeout=UNHURRIED, duration=1.0)
    # our publisher and the recorder could pass for a controller: the run begins when the real one is there, too
    observer.wait_for(controllers="2")
    start_node("road_excitation")
    observer.wait_for(state="running")
    for currents in ([], [1.0], [1.0] * 3, [1.0] * 16):
        publisher.publish(CoilCurrent(current=currents))
    simulator.wait_for("message on /coil_current refused: field current has")
    assert simulator.wait() == 0, simulator.output
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    recording = read_recording(tmp_path / "bag")
    assert recording.answers.current.shape == (1000, 2)
    assert recording.counts["/coil_current"] == 1004
