"""Drive files and commands in the loop of real nodes: kept, recorded, replayed to the bit, refused where they must."""

import json

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped
from mr_mount_controller.node_base.qos import LATCHED_QOS, ROAD_QOS
from rich.console import Console
from trackvib_msgs.msg import DriveState, RoadProfile
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.commands.replay_verify import verify
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.drive.drive_file import parse_drive
from trackvib_sim.vehicle.drive.schedule import arrival_time

from .conftest import UNHURRIED

pytestmark = pytest.mark.system

DRIVE = """over: distance
points:
  - {at: 0, speed: 5}
  - {at: 8, speed: 5}
  - {at: 10, speed: 5, curvature: 0.04}
  - {at: 22, speed: 7}
"""


@pytest.fixture
def drive_file(tmp_path):
    """A drive with a bend."""
    path = tmp_path / "bend.yaml"
    path.write_text(DRIVE, encoding="utf-8")
    return path


@pytest.mark.slow(reason="a whole run, and again")
def test_a_drive_is_kept_recorded_and_replayed(start_cli, tmp_path, drive_file):
    """Over a rough road in gears, with a bend: the bag holds the drive, and it comes out again to the last bit."""
    chosen = ("--drive", drive_file, "--gears", "--road", "B", "--duration", "6.2")
    run = start_cli("run", *chosen, "--out", tmp_path / "run")
    assert run.wait() == 0, run.output
    recording = read_recording(tmp_path / "run" / "bag")
    drive = recording.drive
    assert recording.drive_file == DRIVE
    told = json.loads((tmp_path / "run" / "summary.json").read_text())["run"]
    assert told["drive"] == str(drive_file) and told["speed"] is None
    wanted = arrival_time(parse_drive(DRIVE, 0.0, "drive"), drive.distance[-1])
    assert len(drive.stamp) == 621 and wanted == pytest.approx(6.2, abs=0.1)
    assert drive.curvature.max() == pytest.approx(0.04, rel=0.01) and np.abs(drive.offset).max() < 1.0
    later = drive.stamp > 1_000_000_000
    speed = np.interp(drive.stamp, recording.odometry.stamp, recording.odometry.speed)
    assert np.abs(speed - drive.wanted_speed)[later].max() < 0.3
    assert (drive.gear > 0).all() and (drive.engine_speed > 450.0 - 1e-9).all()
    assert recording.odometry.position[-1, 1] > 2.0
    identical, verdict = verify(tmp_path / "run" / "bag", Console(quiet=True))
    assert identical, verdict
    drive_file.unlink()  # the bag is enough
    law = start_cli("replay", tmp_path / "run" / "bag", "--law", "skyhook", "--out", tmp_path / "again")
    assert law.wait() == 0, law.output
    again = read_recording(tmp_path / "again" / "bag").drive
    # over distance, which another law changes a little
    np.testing.assert_allclose(again.wanted_speed, drive.wanted_speed, atol=0.05)


@pytest.mark.slow(reason="a whole loop of nodes, and again")
def test_commands_are_taken_recorded_and_replayed(start_node, observer, tmp_path):
    """A speed and a turn on cmd_vel hold; what cannot be driven is refused and said once; the replay has the bits."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("controller", law="skyhook")
    simulator = start_node("simulator", speed=5.0, duration=5.0, wait_for_recorder=True, answer_timeout=UNHURRIED)
    commands = observer.node.create_publisher(TwistStamped, "cmd_vel", 10)
    observer.wait_until(commands.get_subscription_count)
    observer.wait_until(lambda: observer.values)
    start_node("road_excitation", road="B")

    def send(speed, yaw_rate):
        message = TwistStamped()
        message.twist.linear.x, message.twist.angular.z = speed, yaw_rate
        commands.publish(message)

    observer.wait_until(lambda: float(observer.values["time"]) > 0.5)
    send(6.5, 0.2)
    observer.wait_until(lambda: float(observer.values["time"]) > 1.0)
    for speed, yaw_rate in ((40.0, 0.0), (0.0, 0.5), (float("nan"), 0.0)):
        send(speed, yaw_rate)
    assert simulator.wait() == 0, simulator.output
    assert simulator.output.count("message on /cmd_vel refused") == 1
    recorder.signal(2)
    assert recorder.wait() == 0, recorder.output
    recording = read_recording(tmp_path / "bag")
    assert recording.commands.speed.tolist() == [6.5] and recording.commands.yaw_rate.tolist() == [0.2]
    taken = recording.commands.stamp[0]
    before, behind = recording.drive.stamp <= taken, recording.drive.stamp > taken + 1_000_000_000
    assert (recording.drive.wanted_speed[before] == 5.0).all() and (recording.drive.wanted_speed[behind] == 6.5).all()
    assert recording.drive.curvature[-1] == pytest.approx(0.2 / 6.5)
    identical, verdict = verify(tmp_path / "bag", Console(quiet=True))
    assert identical, verdict


@pytest.mark.slow(reason="waits for road node and simulator of its own")
def test_the_road_follows_the_distance_along_the_path(start_node, observer):
    """A vehicle that tells a distance gets the road around it, whatever its place in the plane."""
    starts = []
    observer.node.create_subscription(RoadProfile, "road_profile", lambda patch: starts.append(patch.start), ROAD_QOS)
    publisher = observer.node.create_publisher(DriveState, "drive_state", LATCHED_QOS)
    start_node("road_excitation")
    publisher.publish(DriveState(distance=400.0))
    observer.wait_until(lambda: starts and max(starts) >= 440.0)
    assert min(starts) >= 370.0


@pytest.mark.slow(reason="each case starts the command line")
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("points: [{at: 0, speed: 99}]", "speed is 99.0 m/s, accepted: -25 to 25 m/s"),
        ("points: [{at: 0, speed: 5, engine_speed: 9000}]", "engine_speed in the drive file is 9000"),
        ("points: [{at: 1, speed: 5}, {at: 0, speed: 5}]", "point 2: at is 0, must be above 1"),
        ("points: [{at: 0, speed: 1}]", "must be at least"),
    ],
)
def test_a_bad_drive_is_refused(start_cli, tmp_path, text, words):
    """In one line, and nothing is left."""
    path = tmp_path / "drive.yaml"
    path.write_text(text, encoding="utf-8")
    run = start_cli("run", "--drive", path, "--out", tmp_path / "run")
    assert run.wait() != 0
    assert words in run.output and "Traceback" not in run.output


@pytest.mark.slow(reason="a whole run")
def test_an_engine_runs_up_while_the_vehicle_stands(start_cli, tmp_path):
    """A drive of the engine's speed alone: nothing moves, and the recorded speed of the engine is the file's."""
    path = tmp_path / "run_up.csv"
    path.write_text("time_s,speed_mps,engine_speed_rpm\n1,0,600\n3,0,1600\n", encoding="utf-8")
    run = start_cli("run", "--drive", path, "--duration", "4", "--one-process", "--out", tmp_path / "run")
    assert run.wait() == 0, run.output
    drive = read_recording(tmp_path / "run" / "bag").drive
    expected = np.interp(drive.stamp / 1e9, [1.0, 3.0], [600.0, 1600.0])
    np.testing.assert_allclose(drive.engine_speed, expected, atol=1e-6)
    assert np.abs(drive.distance).max() < 0.01 and (drive.gear == 0).all()


@pytest.mark.slow(reason="a real node")
def test_gears_need_a_driveline(start_node):
    """A vehicle without one is named."""
    simulator = start_node("simulator", gears=True, vehicle_file=find_vehicle("m113"))
    assert simulator.wait() != 0
    assert "vehicle 'm113' has no section driveline" in simulator.output
