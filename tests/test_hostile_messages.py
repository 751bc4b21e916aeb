"""One message never ends a node: what cannot be read is refused, said once, and the node goes on."""

import math
import re
from itertools import count
from struct import pack_into

import pytest
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TwistStamped, Vector3
from mr_mount_controller.mounting import PAIR
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS, ROAD_QOS
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import CoilCurrent, DriveState, RoadProfile
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.nodes.messages import ImuMessage, mount_description

from .processes import assert_in_good_health

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="real processes that are sent what nobody expects")]

MS = 1_000_000  # ns
MEMORY = 1_000_000  # kB that a node takes at most
LOOP = (  # topic, a message, quality of service
    ("chassis/imu", Imu(), LOOP_WRITER_QOS),
    ("powertrain/imu", Imu(), LOOP_WRITER_QOS),
    ("coil_current", CoilCurrent(), LOOP_WRITER_QOS),
    ("road_profile", RoadProfile(left=[0.0] * 3, right=[0.0] * 3), ROAD_QOS),
    ("odometry", Odometry(), LATCHED_QOS),
    ("drive_state", DriveState(), LATCHED_QOS),
    ("cmd_vel", TwistStamped(), LOOP_WRITER_QOS),
    ("vehicle_description", String(data="text"), LATCHED_QOS),
    ("mount_description", mount_description(PAIR), LATCHED_QOS),
    ("/clock", Clock(), QoSProfile(depth=10)),
    ("recorder/recorded", Time(), LATCHED_QOS),
    ("recorder/topics", String(data="/chassis/imu"), LATCHED_QOS),
)


def damaged(message):
    """Return bytes that are no message of that type: cut, of another encoding, with lengths that nothing bears out."""
    whole = bytearray(serialize_message(message))
    # an empty one would not even arrive: DDS holds it back, and with it all that its writer sends afterwards
    cases = [b"\0", b"abc", bytes(whole[:4]), bytes(whole[:10]), b"\0\7\0\0" + whole[4:], bytes(len(whole))[:9]]
    place = 4 if isinstance(message, String) else 12
    if not isinstance(message, (Clock, Time)):
        for claim in (len(whole), 2**24, 2**31, 2**32 - 1):
            pack_into("<I", whole, place, claim)
            cases.append(bytes(whole))
    return cases


def send_damaged(observer, topic, listeners):
    """Publish all damaged messages on a topic of the loop, until every process that listens has refused some."""
    message, qos = next((message, qos) for name, message, qos in LOOP if name == topic)
    publisher = observer.node.create_publisher(type(message), topic, qos)
    observer.wait_until(lambda: publisher.get_subscription_count() >= len(listeners))
    cases, sent = damaged(message), count(1)

    def all_refuse():
        # one at a time: a reader holds ten messages, and those of others must not push out what the loop waits for
        number = next(sent)
        publisher.publish(cases[number % len(cases)])
        words = f"message on {publisher.topic_name} refused: message"
        return number >= len(cases) and all(words in process.output for process in listeners)

    observer.wait_until(all_refuse)


def assert_slim(process):
    """A process that runs has never needed more memory than it should."""
    with open(f"/proc/{process.pid}/status") as file:
        assert int(re.search(r"VmHWM:\s+(\d+) kB", file.read())[1]) < MEMORY


def test_loop_of_all_nodes(start_node, observer, tmp_path):
    """Every answer still comes in time, every message is still recorded, and the simulator counts what it refused."""
    road, controller = start_node("road_excitation"), start_node("controller", law="skyhook")
    recorder = start_node("recorder", bag=tmp_path / "bag")
    simulator = start_node("simulator", wait_for_recorder=True, answer_timeout=20.0)
    simulator.wait_for("running")
    for sensor in ("chassis/imu", "powertrain/imu"):
        send_damaged(observer, sensor, [controller, recorder])
    for topic in ("coil_current", "road_profile", "/clock"):
        send_damaged(observer, topic, [simulator, recorder])
    send_damaged(observer, "recorder/recorded", [simulator])
    send_damaged(observer, "odometry", [recorder])
    send_damaged(observer, "drive_state", [road, recorder])
    send_damaged(observer, "cmd_vel", [simulator])
    send_damaged(observer, "vehicle_description", [recorder])
    send_damaged(observer, "mount_description", [controller, recorder])
    observer.wait_until(lambda: int(observer.values.get("refused", 0)) >= 4)
    time = float(observer.values["time"])
    observer.wait_until(lambda: float(observer.values["time"]) > time + 0.5)
    for process in (simulator, road, controller, recorder):
        assert_slim(process)
    for process in (simulator, road, controller, recorder):
        assert_in_good_health(process)
    # a clock that is cut can arrive filled up with zeros, as one at the start of a run
    assert list(tmp_path.glob("bag*")) == [tmp_path / "bag"]
    recording = read_recording(tmp_path / "bag")
    samples = recording.chassis.stamp
    assert samples.tolist() == [k * MS for k in range(1, len(samples) + 1)]
    assert samples[-1] == round(1000.0 * float(observer.wait_for(state="stopped"))) * MS
    assert len(recording.mounts.stamp) == len(samples) == len(recording.powertrain.stamp)
    assert recording.diagnostics["silent_periods"] == "0"
    assert abs(len(recording.answers.sample_stamp) - len(samples)) <= 1


@pytest.mark.parametrize("seconds", [-1, -(2**31), 2**31 - 1])
def test_recorder_keeps_an_absurd_stamp_as_it_came(start_node, observer, tmp_path, seconds):
    """Among good ones; its time in the bag is that of the message before, and nothing is lost."""
    publisher = observer.node.create_publisher(Imu, "chassis/imu", LOOP_WRITER_QOS)
    recorder = start_node("recorder", bag=tmp_path / "bag", topics="[chassis/imu]")
    recorder.wait_for("recording 1 topics")
    observer.wait_until(publisher.get_subscription_count)
    imu, absurd = ImuMessage("imu"), Imu()
    absurd.header.stamp.sec, absurd.header.frame_id = seconds, "absurd"
    absurd.linear_acceleration = Vector3(x=math.nan, y=math.inf, z=-math.inf)
    sent = [(k * MS, imu.fill(k * MS, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0))) for k in range(1, 601)]
    sent.insert(300, (300 * MS, bytes(serialize_message(absurd))))
    for _, data in sent:
        publisher.publish(data)
    publisher.publish(b"abc")
    recorder.wait_for("refused")
    assert_in_good_health(recorder)
    records = [record for record in raw_records(tmp_path / "bag") if isinstance(record, RawMessage) and record.message]
    assert [(record.message.log_time, record.message.data) for record in records] == sent
