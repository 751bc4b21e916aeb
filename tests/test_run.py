"""`trackvib run`: the whole main job, by real processes, judged by what it leaves."""

import json
from array import array
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.reader import read_ros2_messages
from mr_mount_controller.laws.skyhook import Skyhook
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.data import find_vehicle
from trackvib_sim.nodes.topic_choice import message_type
from trackvib_sim.numerics.units import NANO
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.mount_energy import MountEnergy
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .processes import trackvib

SAMPLES = 10_000
LOOP_TOPICS = ("/chassis/imu", "/powertrain/imu", "/coil_current", "/mount_state")

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="does whole runs of 10 s")]


@pytest.fixture(scope="module", autouse=True)
def own_domain(domain):
    """All runs of this file, one after the other, in one domain of their own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        yield


def run(folder, *options):
    """Do a run in a folder and return what it printed."""
    return trackvib("run", "--law", "skyhook", "--out", folder, *options)


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """One run of 10 s on class E at 10 m/s: its folder and what it printed."""
    folder = tmp_path_factory.mktemp("runs") / "first"
    return folder, run(folder)


@pytest.fixture(scope="module")
def drive(first):
    """The bag of that run."""
    return read_recording(first[0] / "bag")


def stream(folder, topic):
    """Return the serialised messages of a topic."""
    with next((folder / "bag").glob("*.mcap")).open("rb") as file:
        return [message.data for _, _, message in make_reader(file).iter_messages([topic])]


def test_not_one_message_is_lost(drive):
    """Stamps run from the first to the last period without gap, and every current answers its sample."""
    expected = np.arange(1, SAMPLES + 1) * (NANO // 1000)
    np.testing.assert_array_equal(drive.chassis.stamp, expected)
    np.testing.assert_array_equal(drive.powertrain.stamp, expected)
    np.testing.assert_array_equal(drive.answers.sample_stamp, expected)
    assert drive.counts["/mount_state"] == SAMPLES
    # 100 a second and the one before the start
    assert drive.counts["/odometry"] == SAMPLES // 10 + 1
    assert [drive.diagnostics[key] for key in ("late", "duplicate", "early", "not_finite")] == ["0"] * 4
    assert drive.diagnostics["state"] == "finished"


def test_the_law_acts(drive):
    """The skyhook switches between its two currents, and both reach the coils."""
    assert set(np.unique(drive.answers.current)) == {0.8, 3.0}


def test_same_seed_gives_identical_streams(first, tmp_path):
    """A second run with the same seed leaves the same bytes on every loop topic."""
    run(tmp_path / "again")
    for topic in LOOP_TOPICS:
        assert stream(first[0], topic) == stream(tmp_path / "again", topic), topic


def test_another_seed_gives_another_run(first, tmp_path):
    """Of another seed, the accelerations differ."""
    run(tmp_path / "other", "--seed", "2", "--duration", "3")
    assert stream(tmp_path / "other", "/chassis/imu") != stream(first[0], "/chassis/imu")[:3000]


def test_loop_in_one_process_is_identical(drive):
    """The same vehicle, road and law in one process give the same samples and currents to the last bit."""
    vehicle, _ = read_vehicle(find_vehicle())
    rates = Rates(recommended_rate(vehicle))
    simulation = Simulation(vehicle, RunSettings(Operation(10.0, 1650.0, False, 0.25), rates, 1.0))
    record = run_closed_loop(simulation, Iso8608Road("E", 1, 8.0, 8.0), Skyhook(1e-3), SAMPLES)
    np.testing.assert_array_equal(record.specific_force[:, 0], drive.chassis.specific_force)
    np.testing.assert_array_equal(record.specific_force[:, 1], drive.powertrain.specific_force)
    np.testing.assert_array_equal(record.angular_velocity[:, 0], drive.chassis.angular_velocity)
    np.testing.assert_array_equal(record.current, drive.answers.current)


def test_bag_opens_as_a_rosbag2(first):
    """`rosbags` reads the folder by its metadata.yaml, and its counts are those of the messages."""
    with Reader(first[0] / "bag") as reader:
        assert reader.message_count == sum(1 for _ in reader.messages())
        assert reader.duration >= 9_999_000_000
        assert {c.topic for c in reader.connections} >= {*LOOP_TOPICS, "/road_profile", "/clock", "/diagnostics"}


def test_bag_is_a_ros2_mcap(first):
    """Profile, schema encoding, message encoding and QoS are those that rosbag2 writes."""
    with next((first[0] / "bag").glob("*.mcap")).open("rb") as file:
        reader = make_reader(file)
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
    for channel in summary.channels.values():
        assert channel.message_encoding == "cdr"
        assert summary.schemas[channel.schema_id].encoding == "ros2msg"
        offered = yaml.safe_load(channel.metadata["offered_qos_profiles"])
        assert offered[0]["reliability"] == ("best_effort" if channel.topic == "/clock" else "reliable")


def test_every_reader_reads_the_same(first):
    """rosbags by folder and by file, mcap, and its ROS 2 decoder give the same messages, each of which decodes."""
    folder = first[0] / "bag"
    file = next(folder.glob("*.mcap"))
    with file.open("rb") as stream:
        expected = {(c.topic, m.log_time, m.data) for _, c, m in make_reader(stream).iter_messages()}
    with Reader(folder) as by_folder, AnyReader([file]) as by_file:
        for reader in (by_folder, by_file):
            assert {(c.topic, time, bytes(data)) for c, time, data in reader.messages()} == expected
        for topic in {topic for topic, _, _ in expected}:
            theirs = read_ros2_messages(file, topics=[topic])
            ours = by_file.messages([c for c in by_file.connections if c.topic == topic])
            for (connection, time, data), other in zip(islice(ours, 200), theirs, strict=False):
                assert other.log_time_ns == time
                ros = deserialize_message(bytes(data), message_type(connection.msgtype))
                assert alike(ros, by_file.deserialize(data, connection.msgtype), other.ros_msg), topic


def alike(ours, *others):
    """Return whether messages as different libraries decode them have the same values; the first one is of ROS 2."""
    if hasattr(ours, "get_fields_and_field_types"):
        names = ours.get_fields_and_field_types()
        return all(alike(*(getattr(each, name) for each in (ours, *others))) for name in names)
    if isinstance(ours, list | array | np.ndarray):
        return all(alike(*each) for each in zip(ours, *others, strict=True))
    value = ours[0] if isinstance(ours, bytes) else ours  # rclpy's word for a field of type `byte`
    return all(other == value for other in others)


def test_bag_knows_what_made_it(drive):
    """Seed, parameters of every node and versions lie in the bag."""
    assert drive.provenance["parameters of /road_excitation"]["seed"] == "1"
    assert drive.provenance["parameters of /simulator"]["speed"] == "10.0"
    assert drive.provenance["parameters of /controller"]["law"] == "skyhook"
    assert drive.provenance["versions"]["numpy"] == np.__version__
    assert drive.counts["/vehicle_description"] == 1


def test_summary_and_picture(first):
    """The summary is printed and saved, with its band; the picture is a PNG of some size."""
    folder, printed = first
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["band_hz"] == [0.5, 500.0]
    assert 2.5 < summary["rms_mps2"]["powertrain"]["z"] < 10.0  # [Tao2025] has 5.5 on such a road at this speed
    assert f"{summary['rms_mps2']['powertrain']['z']:.3f}" in printed
    assert float(summary["loop"]["real_time_factor"]) > 0.0
    assert 5e3 < summary["drive_N"] < 5e4
    assert f"drive: {summary['drive_N'] / 1e3:.1f} kN, {summary['drive_W'] / 1e3:.1f} kW" in printed
    mounts = MountEnergy(**summary["mounts_J"])
    assert mounts.dissipated > 0.0 and mounts.exchanged != 0.0 and mounts.error < 1e-3
    assert f"{mounts.work:.1f} J of work" in printed
    assert (folder / "summary.txt").read_text().strip() in printed.replace("\r", "")
    picture = (folder / "run.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 50_000


def test_analysis_of_the_bag_agrees_with_the_summary(first, tmp_path):
    """`trackvib analyze` gives the run's own numbers again, and leaves them as tables."""
    out = tmp_path / "out"
    printed = trackvib("analyze", first[0] / "bag", "--out", out)
    summary = json.loads((first[0] / "summary.json").read_text())
    (found,) = json.loads((out / "numbers.json").read_text())["bags"]
    rms = {sensor: {axis: n["rms"] for axis, n in axes.items()} for sensor, axes in found["sensors"].items()}
    assert rms == summary["rms_mps2"]
    assert (found["loop"], found["mount_energy"]) == (summary["loop"], summary["mounts_J"])
    assert (found["drive_force"], found["drive_power"]) == (summary["drive_N"], summary["drive_W"])
    assert found["settle"] == summary["settled_after_s"]
    lines = {line["name"]: line["frequency"] for line in found["lines"]}
    assert lines["link passing 1"] == pytest.approx(87.0, rel=0.01) and lines["engine order 2"] == 55.0
    assert {"numbers.csv", "spectra.parquet", "history.parquet", "report.html"} <= {p.name for p in out.iterdir()}
    assert f"{rms['powertrain']['z']:.3f}" in printed and "link passing 1" in printed


def test_a_folder_is_never_overwritten(first):
    """A second run into the same folder is refused and leaves it as it was."""
    before = sorted(Path(first[0]).rglob("*"))
    assert "already exists" in trackvib("run", "--out", first[0], code=1)
    assert sorted(Path(first[0]).rglob("*")) == before
