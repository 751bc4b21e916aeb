"""Runs of other vehicles by real processes: with two coils of four, with four, with none, and backwards."""

import json
import re

import numpy as np
import pytest
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.data import find_vehicle

from .processes import trackvib

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="does whole runs of other vehicles")]

DURATION = 4  # s
SEAT = """
  seat:
    body: hull
    place: {value: [1.0, 0.3, 1.2], unit: m, source: assumed}
    orientation: {value: [0.0, 0.0, 90.0], unit: deg, source: assumed}
    divisor: {value: 10, unit: "-", source: assumed}
"""


@pytest.fixture(autouse=True)
def own_domain(domain, monkeypatch):
    """All runs of a test in one domain."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))


@pytest.fixture
def four_coils(tmp_path):
    """A file of the free powertrain with MR mounts at the rear as well, and a sensor that reads every 10 periods."""
    text = find_vehicle("tao2025_free").read_text(encoding="utf-8").replace("type: rear_rubber", "type: mr")
    file = tmp_path / "four.yaml"
    file.write_text(text.replace("\nswing_arms:", f"\nsensors:{SEAT}\nswing_arms:"), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("vehicle", "coils", "names"),
    [
        ("tao2025_free", 2, ["front_left", "front_right", "rear_left", "rear_right"]),
        ("m113", 0, []),
    ],
)
def test_shipped_vehicles_drive(tmp_path, vehicle, coils, names):
    """The bag holds the answers, the states of the mounts by their names, and is verified to the last bit."""
    trackvib("run", "--vehicle", vehicle, "--law", "skyhook", "--duration", DURATION, "--out", tmp_path / "run")
    recording = read_recording(tmp_path / "run" / "bag")
    assert list(recording.mounting.names) == names
    assert recording.answers.current.shape == (1000 * DURATION, coils)
    assert recording.mounts.deflection.shape == (1000 * DURATION, len(names), 3)
    assert "identical to the last bit" in trackvib("replay", tmp_path / "run" / "bag", "--verify")


def test_four_coils_and_a_slow_sensor(tmp_path, four_coils):
    """Each mount has its own current under a law that knows them, and the seat's sensor a tenth of the samples."""
    run = ("run", "--vehicle", four_coils, "--law", "skyhook", "--duration", DURATION, "--out", tmp_path / "run")
    printed = trackvib(*run)
    assert all(re.search(rf"^│ {sensor} +│", printed, re.MULTILINE) for sensor in ("chassis", "powertrain", "seat"))
    recording = read_recording(tmp_path / "run" / "bag")
    current = recording.answers.current
    assert current.shape == (1000 * DURATION, 4)
    # front and rear move against the hull each for itself
    assert (current[:, 0] != current[:, 2]).mean() > 0.05
    assert len(recording.sensors["seat"].stamp) == 100 * DURATION
    # its z axis is that of the hull, so it feels gravity
    assert recording.sensors["seat"].specific_force[:, 2].mean() == pytest.approx(9.81, abs=0.5)
    assert "identical to the last bit" in trackvib("replay", tmp_path / "run" / "bag", "--verify")
    trackvib("analyze", tmp_path / "run" / "bag", "--out", tmp_path / "analysis")
    assert "rear_right" in json.dumps(json.loads((tmp_path / "analysis" / "numbers.json").read_text()))
    assert re.search(r",\"seat\",\"z\",\"rms\",\d", (tmp_path / "analysis" / "numbers.csv").read_text())


def test_backwards(tmp_path):
    """The vehicle drives back along the road, which comes in time, and so it does again."""
    trackvib("run", "--speed", -8, "--road", "C", "--duration", DURATION, "--out", tmp_path / "run")
    odometry = read_recording(tmp_path / "run" / "bag").odometry
    assert odometry.speed.mean() == pytest.approx(-8.0, abs=0.2)
    assert odometry.position[-1, 0] == pytest.approx(-8.0 * DURATION, abs=1.0)
    assert np.diff(odometry.position[:, 0]).max() < 0.0
    assert "identical to the last bit" in trackvib("replay", tmp_path / "run" / "bag", "--verify")
