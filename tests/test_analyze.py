"""`trackvib analyze` as a real process: bad input in one line that names it, and bags that do not tell everything."""

import csv
import json

import numpy as np
import pytest
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from trackvib_msgs.msg import DriveState
from trackvib_sim.bags.qos import qos_record
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.messages import ImuMessage, set_stamp

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="each case starts the command line")


@pytest.fixture
def bag(tmp_path):
    """A bag of 4 s of noise in both Imu, and of nothing else."""
    writer, random = BagWriter(tmp_path / "drive"), np.random.default_rng(1)
    sensors = {f"/{end}/imu": ImuMessage(f"{end}_imu_link") for end in ("chassis", "powertrain")}
    for topic in sensors:
        writer.add_topic(topic, "sensor_msgs/msg/Imu", [qos_record(LOOP_WRITER_QOS)], "RIHS01_0")
    for stamp in range(1_000_000, 4_001_000_000, 1_000_000):
        for topic, imu in sensors.items():
            writer.write(topic, stamp, imu.fill(stamp, random.normal(size=3), (0.0, 0.0, 0.0)))
    writer.close()
    return tmp_path / "drive"


@SLOW
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["missing", "--out", "new"], ["'missing' does not exist"]),
        (["empty", "--out", "new"], ["'empty' holds no .mcap file"]),
        (["text.mcap", "--out", "new"], ["'text.mcap' cannot be read"]),
        (["text.mcap", "empty/../text.mcap", "--out", "new"], ["'empty/../text.mcap' is given twice"]),
        (["empty", "--out", "empty"], ["'empty' already exists"]),
        (["empty", "--out", "text.mcap/new"], ["'text.mcap/new' cannot be created"]),
        (["empty", "--settle", "-1"], ["--settle", "-1"]),
        (["empty", "--interval", "0"], ["--interval", "0.0 is not in the range 1 to 1000000 m"]),
        (["empty", "--speed-band", "nan"], ["--speed-band", "nan"]),
        (["empty", "--settle", "1.9"], ["--settle", "1.9 is not in the range 2 to 1000000 s"]),
        ([], ["BAG..."]),
    ],
)
def test_bad_input_is_refused(start_cli, tmp_path, arguments, words):
    """Bags that are none, or the same one; folders that are there or cannot be, options out of range."""
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.mcap").write_text("no bag at all, but some text")
    before = sorted(tmp_path.iterdir())
    analyze = start_cli("analyze", *arguments)
    assert analyze.wait() != 0
    output = " ".join(analyze.output.split())
    assert all(word in output for word in words) and "Traceback" not in output, output
    assert not (tmp_path / "new").exists() and set(before) <= set(tmp_path.iterdir())


@SLOW
def test_a_bag_of_sensors_alone(start_cli, tmp_path, bag):
    """What is not in it is said once; there are no numbers that are none, no empty tables, and no worries."""
    analyze = start_cli("analyze", bag, "--out", "new")
    assert analyze.wait() == 0, analyze.output
    assert analyze.output.count("no odometry") == 1 and "nan" not in analyze.output
    assert "acceleration, m/s²" in analyze.output
    assert "known cause" not in analyze.output and "mounts: vertical travel" not in analyze.output
    (found,) = json.loads((tmp_path / "new" / "numbers.json").read_text())["bags"]
    assert found["loop"]["lost_chassis"] == 0 and found["loop"]["unanswered"] is None
    assert "nan" not in (tmp_path / "new" / "numbers.csv").read_text()


@pytest.mark.slow(reason="two reports")
def test_a_cut_bag_counts_and_is_named(start_cli, bag):
    """As far as it goes, and with the way to complete it."""
    (file,) = bag.glob("*.mcap")
    data = file.read_bytes()
    file.write_bytes(data[: int(0.9 * len(data))])
    analyze = start_cli("analyze", bag, "--out", "new")
    assert analyze.wait() == 0, analyze.output
    assert "was cut short" in analyze.output and "trackvib bag repair" in analyze.output


@SLOW
def test_help_speaks_of_the_report(start_cli):
    """And of the least settling time."""
    analyze = start_cli("analyze", "--help")
    assert analyze.wait() == 0
    assert "HTML report" in analyze.output and "2 to 1000000 s" in " ".join(analyze.output.split())


def test_brackets_in_a_path_are_printed(start_cli, tmp_path, bag):
    """They are no commands to whatever prints."""
    (tmp_path / "runs[old]").mkdir()
    bag.rename(tmp_path / "runs[old]" / "drive")
    analyze = start_cli("analyze", "runs[old]/drive", "--out", "new[bold]")
    assert analyze.wait() == 0, analyze.output
    assert "recording 1: runs[old]/drive: " in analyze.output and "written to new[bold]: " in analyze.output


@SLOW
def test_a_folder_and_its_file_are_one_bag(start_cli, tmp_path, bag):
    """Refused before anything is read, and nothing is left."""
    (file,) = bag.glob("*.mcap")
    analyze = start_cli("analyze", bag, file, "--out", "new")
    assert analyze.wait() == 1
    assert f"{file.name}' is given twice" in analyze.output and not (tmp_path / "new").exists()


@pytest.fixture
def driven_bag(tmp_path):
    """A bag of 12 s from 5 to 11 m/s in one gear, of noise and, in the chassis, order 3 of the engine of 1 m/s²."""
    writer, random = BagWriter(tmp_path / "driven"), np.random.default_rng(1)
    sensors = {f"/{end}/imu": ImuMessage(f"{end}_imu_link") for end in ("chassis", "powertrain")}
    types = dict.fromkeys(sensors, "sensor_msgs/msg/Imu") | {
        "/odometry": "nav_msgs/msg/Odometry",
        "/drive_state": "trackvib_msgs/msg/DriveState",
        "/vehicle_description": "std_msgs/msg/String",
    }
    for topic, name in types.items():
        writer.add_topic(topic, name, [qos_record(LOOP_WRITER_QOS)], "RIHS01_0")
    vehicle = find_vehicle().read_text(encoding="utf-8")
    writer.write("/vehicle_description", 0, serialize_message(String(data=vehicle)))
    odometry, drive = Odometry(), DriveState(gear=2)
    for k in range(1, 12_001):
        time, stamp = k / 1e3, k * 1_000_000
        speed, way = 5.0 + 0.5 * time, 5.0 * time + 0.25 * time**2
        order = np.sin(2.0 * np.pi * 3.0 * 180.0 * way / 60.0)  # the engine turns at 180 r/min a m/s
        for topic, imu in sensors.items():
            force = 0.1 * random.normal(size=3) + (0.0, 0.0, order if topic.startswith("/chassis") else 0.0)
            writer.write(topic, stamp, imu.fill(stamp, force, (0.0, 0.0, 0.0)))
        if k % 10 == 0:
            for message in (odometry, drive):
                set_stamp(message, stamp)
            odometry.twist.twist.linear.x, drive.distance, drive.engine_speed = speed, way, 180.0 * speed
            writer.write("/odometry", stamp, serialize_message(odometry))
            writer.write("/drive_state", stamp, serialize_message(drive))
    writer.close()
    return tmp_path / "driven"


@pytest.mark.slow(reason="a bag and its report")
def test_a_drive_has_numbers_by_way_speed_and_order(start_cli, tmp_path, driven_bag):
    """From the messages to the files: intervals and bands as asked for, and the order's level within 3 %."""
    analyze = start_cli("analyze", driven_bag, "--interval", "20", "--speed-band", "1", "--out", "new")
    assert analyze.wait() == 0, analyze.output
    assert "by speed" in analyze.output and "nan" not in analyze.output

    def table(name):
        with (tmp_path / "new" / f"{name}.csv").open(encoding="utf-8") as file:
            return [{key: float(value) for key, value in row.items() if key != "bag"} for row in csv.DictReader(file)]

    assert [row["low"] for row in table("by_way")] == [0.0, 20.0, 40.0, 60.0, 80.0]
    # after 2 s of settling it drives at 6 m/s
    assert [(row["low"], row["high"]) for row in table("by_speed")][:3] == [(6.0, 7.0), (7.0, 8.0), (8.0, 9.0)]
    assert table("by_speed")[1]["engine_speed"] == pytest.approx(180.0 * 7.5, abs=5.0)
    third = [row for row in table("order_levels") if row["order"] == 3.0]
    assert len(third) > 5
    assert all(row["chassis_rms_z"] == pytest.approx(np.sqrt(0.5), rel=0.03) for row in third)
    assert all(row["powertrain_rms_z"] < 0.1 for row in third)
    (found,) = json.loads((tmp_path / "new" / "numbers.json").read_text())["bags"]
    assert found["engine_speed"] == pytest.approx(180.0 * 8.5, rel=0.1)
