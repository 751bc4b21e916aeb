"""`trackvib compare`, and the options of sensors, as real processes on bags and files of others."""

import csv
import json

import numpy as np
import pytest
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from trackvib_sim.bags.qos import qos_record
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.nodes.messages import ImuMessage

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each case starts the command line")]
TIME = np.arange(1, 1601) / 200.0  # s
FORCE = np.column_stack((0.0 * TIME, 0.0 * TIME, 9.81 + 2.0 * np.sin(2.0 * np.pi * 20.0 * TIME)))


def write_bag(folder, topics):
    """Write a bag of 8 s of 20 Hz, 2 m/s^2, times gains by topic."""
    writer, imu = BagWriter(folder), ImuMessage("imu_link")
    for topic, gain in topics.items():
        writer.add_topic(topic, "sensor_msgs/msg/Imu", [qos_record(LOOP_WRITER_QOS)], "RIHS01_0")
        for stamp, force in zip(np.round(TIME * 1e9).astype(int).tolist(), FORCE, strict=True):
            wave = (*force[:2].tolist(), 9.81 + gain * (force[2] - 9.81))
            writer.write(topic, stamp, imu.fill(stamp, wave, (0.0, 0.0, 0.0)))
    writer.close()
    return folder


def test_a_csv_file_beside_a_bag(start_cli, tmp_path):
    """The ratio on the screen, in CSV, JSON and the report; the measured file's own units and names."""
    write_bag(tmp_path / "run", {"/chassis/imu": 1.5, "/powertrain/imu": 0.75})
    rows = (f"{t:.4f};{x:.6f};{y:.6f};{z:.6f}" for t, (x, y, z) in zip(TIME, FORCE / 9.80665, strict=True))
    (tmp_path / "drive.csv").write_text("\n".join(("t;ax;ay;az", *rows)) + "\n")
    columns = "time_s=t,x_g=ax,y_g=ay,z_g=az"
    compare = start_cli("compare", "drive.csv", "run", "--csv", columns, "--out", "new")
    assert compare.wait() == 0, compare.output
    assert "simulated over measured, not aligned" in compare.output and "1.50" in compare.output
    assert "measured: drive.csv: 6 s count, after 2 s of settling (the shortest)" in compare.output
    with (tmp_path / "new" / "comparison.csv").open(encoding="utf-8") as file:
        found = {(row["part"], row["axis"], row["quantity"]): row for row in csv.DictReader(file)}
    assert float(found["chassis", "z", "RMS"]["ratio"]) == pytest.approx(1.5, rel=1e-3)
    assert found["powertrain", "z", "RMS"]["ratio"] == ""
    assert json.loads((tmp_path / "new" / "comparison.json").read_text())["aligned_by"] == "none"
    assert "Simulated over measured" in (tmp_path / "new" / "report.html").read_text(encoding="utf-8")


def test_a_recording_is_not_compared_with_itself(start_cli, tmp_path):
    """One line, and no folder is left."""
    write_bag(tmp_path / "run", {"/chassis/imu": 1.0, "/powertrain/imu": 0.5})
    compare = start_cli("compare", "run", "run", "--out", "new")
    assert compare.wait() == 1
    assert "'run' is given twice" in compare.output and not (tmp_path / "new").exists()


def test_any_names_on_analyze(start_cli, tmp_path):
    """Refused with the topics that are there; with the options their numbers, turned as told."""
    write_bag(tmp_path / "drive", {"/imu/data": 1.0})
    analyze = start_cli("analyze", "drive", "--out", "new")
    assert analyze.wait() == 1
    output = " ".join(analyze.output.split())
    assert "there are /imu/data (Imu, 1600): choose by --chassis TOPIC" in output and not (tmp_path / "new").exists()
    analyze = start_cli("analyze", "drive", "--chassis", "/imu/data", "--rotate", "0,90,0", "--out", "new")
    assert analyze.wait() == 0, analyze.output
    assert "no powertrain in the recording" in analyze.output
    (found,) = json.loads((tmp_path / "new" / "numbers.json").read_text())["bags"]
    assert found["sensors"]["chassis"]["x"]["rms"] == pytest.approx(np.sqrt(2.0), rel=2e-3)
    assert found["sensors"]["powertrain"]["z"]["rms"] is None
    assert "roll, pitch, yaw 0, 90, 0 degrees (--rotate)" in found["origins"]["chassis"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--rotate", "1,2"], "'1,2', accepted: ROLL,PITCH,YAW"),
        (["--rotate", "nan,0,0"], "accepted: ROLL,PITCH,YAW"),
        (["--sensor", "seat"], "'seat', accepted: NAME=TOPIC"),
        (["--sensor", "chassis=/a", "--chassis", "/b"], "'chassis' is given twice"),
        (["--csv", "time_s"], "'time_s', accepted: COLUMN_UNIT=NAME"),
        (["--chassis", "/a", "--powertrain", "/a"], "'/a' is given for two sensors"),
    ],
)
def test_options_that_cannot_be_are_refused(start_cli, options, words):
    """In one line, before anything is read."""
    analyze = start_cli("analyze", "nowhere", *options)
    assert analyze.wait() == 2
    assert words in " ".join(analyze.output.split()) and "Traceback" not in analyze.output
