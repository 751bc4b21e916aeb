"""The player node with real processes: what was recorded arrives again byte for byte, where and when it is wanted."""

import signal
import time

import pytest
from mcap.reader import make_reader
from mr_mount_controller.node_base.cdr import leading_stamp
from mr_mount_controller.node_base.qos import CLOCK_QOS, LATCHED_QOS
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import RoadProfile

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="plays bags to real subscribers")

DEEP = QoSProfile(depth=5000)
MS = 1_000_000  # ns


@pytest.fixture
def bag(recorded_run):
    return recorded_run / "bag"


def recorded(bag, topic):
    """Return the serialised messages of a topic."""
    with next(bag.glob("*.mcap")).open("rb") as file:
        return [message.data for _, _, message in make_reader(file).iter_messages([topic])]


def stamps(messages):
    """Return the stamps of serialised messages [ms]."""
    return [leading_stamp(data) // MS for data in messages]


@SLOW
def test_every_byte_arrives_again(start_node, observer, bag):
    """In order; and the clock runs along, up to the last stamp."""
    imu = observer.collect(Imu, "chassis/imu", DEEP)
    clock = observer.collect(Clock, "/clock", CLOCK_QOS)
    player = start_node("player", bag=bag, rate=2.0)
    observer.wait_until(lambda: not player.running)
    assert player.wait() == 0, player.output
    observer.wait_until(lambda: len(imu) == 3200)
    assert imu == recorded(bag, "/chassis/imu")
    times = stamps(clock)
    assert times == sorted(times) and times[-1] == 3200 and len(times) > 100


@pytest.mark.slow(reason="records a whole run")
def test_late_joiners_get_what_was_latched(start_node, observer, bag):
    """Whoever comes in the middle still gets the vehicle and all road up to then, as from the first nodes."""
    imu = observer.collect(Imu, "powertrain/imu", DEEP)
    start_node("player", bag=bag, start=1.0)
    observer.wait_until(lambda: len(imu) > 300)
    late = observer.collect(String, "vehicle_description", LATCHED_QOS)
    road = observer.collect(RoadProfile, "road_profile", LATCHED_QOS)
    observer.wait_until(lambda: late and stamps(road[:1]) == [0] and len(road) > 10)
    assert late == recorded(bag, "/vehicle_description")
    assert road == recorded(bag, "/road_profile")[: len(road)]


@SLOW
def test_names_can_be_remapped(start_node, observer, bag):
    """By ROS's own rules: one topic to another name, everything into a namespace."""
    other = observer.collect(Imu, "/twin/body/imu", DEEP)
    same = observer.collect(Imu, "/twin/powertrain/imu", DEEP)
    rules = ("--ros-args", "-r", "chassis/imu:=body/imu", "-r", "__ns:=/twin")
    player = start_node("player", *rules, bag=bag, rate=10.0, end=0.5)
    observer.wait_until(lambda: len(other) == len(same) == 500)
    assert player.wait() == 0, player.output
    assert other == recorded(bag, "/chassis/imu")[:500]


@SLOW
def test_stretch_pace_and_choice(start_node, observer, bag):
    """From start to end, not faster than the rate says, and only the chosen topics."""
    imu = observer.collect(Imu, "chassis/imu", DEEP)
    unwanted = observer.collect(Imu, "powertrain/imu", DEEP)
    player = start_node("player", bag=bag, start=1.5, end=1.9, rate=0.2, topics='["chassis/*"]')
    observer.wait_until(lambda: imu)
    began = time.monotonic()
    observer.wait_until(lambda: len(imu) == 401)
    assert time.monotonic() - began > 1.5  # 2 s, less what passed before the first one was seen
    assert player.wait() == 0, player.output
    assert stamps(imu) == list(range(1500, 1901))
    assert not unwanted


@SLOW
def test_loop_until_ctrl_c(start_node, observer, bag):
    """Stamps begin again and again; Ctrl-C ends it cleanly."""
    imu = observer.collect(Imu, "chassis/imu", DEEP)
    player = start_node("player", bag=bag, start=1.0, end=1.2, rate=5.0, loop=True)
    observer.wait_until(lambda: len(imu) > 450)
    player.signal(signal.SIGINT)
    assert player.wait() == 0, player.output
    assert stamps(imu[:402]) == 2 * list(range(1000, 1201))


@SLOW
def test_pause_step_resume_reset(start_node, observer, bag):
    """Services are those of the simulator; a step is one instant of the bag."""
    imu = observer.collect(Imu, "chassis/imu", DEEP)
    player = start_node("player", bag=bag)
    observer.wait_until(lambda: len(imu) > 100)
    assert not observer.call("step", "player").success
    assert observer.call("pause", "player").success
    answer = observer.call("pause", "player").message  # told once what was under way has gone out
    time.sleep(0.3)
    assert observer.call("pause", "player").message == answer
    stood = len(imu)
    assert answer == f"paused at t = {stood / 1000:.3f} s"
    assert observer.call("step", "player").success
    observer.wait_until(lambda: len(imu) == stood + 1)
    time.sleep(0.3)
    assert observer.call("pause", "player").message == f"paused at t = {(stood + 1) / 1000:.3f} s"
    assert observer.call("reset", "player").success
    assert observer.call("resume", "player").success
    observer.wait_until(lambda: len(imu) > stood + 100)
    assert stamps(imu[stood + 1 : stood + 11]) == list(range(1, 11))
    player.signal(signal.SIGTERM)
    assert player.wait() == 0, player.output


@SLOW
def test_a_killed_player_leaves_the_bag_as_it_was(start_node, observer, bag):
    """And the next one plays it."""
    before = {path: path.read_bytes() for path in bag.iterdir()}
    imu = observer.collect(Imu, "chassis/imu", DEEP)
    player = start_node("player", bag=bag)
    observer.wait_until(lambda: len(imu) > 100)
    player.signal(signal.SIGKILL)
    player.wait()
    assert {path: path.read_bytes() for path in bag.iterdir()} == before
    imu.clear()  # some of the killed player's may still come
    start_node("player", bag=bag)
    observer.wait_until(lambda: 1 in stamps(imu[:-2]))
    first = stamps(imu).index(1)
    assert stamps(imu[first : first + 3]) == [1, 2, 3]


@SLOW
@pytest.mark.parametrize(
    ("given", "code", "words"),
    [
        ({"bag": "/nowhere"}, 1, "bag '/nowhere' does not exist"),
        ({"start": 99.0}, 2, "parameter 'start' is 99.0 s, accepted: 0 to 3.2 s in this bag"),
        ({"start": 2.0, "end": 1.0}, 2, "parameter 'end' is 1.0 s"),
        ({"rate": 0.0}, 2, "parameter 'rate' is 0.0, accepted: a number from 0.01 to 100"),
        ({"topics": '["chassis/gps"]'}, 2, "no topic 'chassis/gps', it has /chassis/imu, /clock"),
        ({"rat": 1.0}, 2, "unknown parameter 'rat'"),
        ({"bag": "''"}, 2, "parameter 'bag' is empty"),
    ],
)
def test_bad_input(start_node, bag, given, code, words):
    """One clear error and an exit code."""
    player = start_node("player", **({"bag": bag} | given))
    assert player.wait() == code, player.output
    assert words in player.output and "Traceback" not in player.output


@SLOW
@pytest.mark.parametrize("content", [b"", b"nonsense", b"cut"])
def test_a_bag_that_cannot_be_read(start_node, bag, tmp_path, content):
    """Nonsense, and a bag without its end, which wants repair."""
    folder = tmp_path / "bad"
    folder.mkdir()
    (folder / "bad_0.mcap").write_bytes(content if content != b"cut" else recorded_file(bag)[:-100])
    player = start_node("player", bag=folder)
    assert player.wait() == 1, player.output
    assert f"bag '{folder}' cannot be read" in player.output and "Traceback" not in player.output


def recorded_file(bag):
    return next(bag.glob("*.mcap")).read_bytes()
