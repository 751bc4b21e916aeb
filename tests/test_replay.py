"""`trackvib replay` under another law, and into live controllers; what both leave."""

import json
import signal
from collections import Counter

import numpy as np
import pytest
from mr_mount_controller.laws.passive import Passive
from mr_mount_controller.node_base.cdr import leading_stamp
from rich.console import Console
from rosbags.rosbag2 import Reader
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.commands.replay_law import run_replay_law
from trackvib_sim.commands.replay_verify import verify
from trackvib_sim.data import find_vehicle
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .bag_helpers import attachment

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="drives runs again under other laws and controllers")]


def files(folder):
    """Return the names of what lies in a folder, sorted."""
    return sorted(path.name for path in folder.iterdir())


def counts(bag):
    """Return how many messages a bag holds of each topic."""
    with Reader(bag) as reader:
        return Counter({connection.topic: connection.msgcount for connection in reader.connections})


@pytest.fixture(scope="module")
def rerun(recorded_run, tmp_path_factory):
    """The recorded drive under skyhook once more under the passive law: its folder."""
    folder = tmp_path_factory.mktemp("rerun") / "passive"
    run_replay_law(recorded_run / "bag", "passive", folder, Console(quiet=True))
    return folder


def test_a_rerun_is_the_run_under_that_law(rerun):
    """On the recorded road alone, to the last bit what the loop in process gives on the road itself."""
    vehicle, _ = read_vehicle(find_vehicle())
    rates = Rates(recommended_rate(vehicle))
    simulation = Simulation(vehicle, RunSettings(Operation(10.0, 1650.0, False, 0.25), rates, 1.0))
    record = run_closed_loop(simulation, Iso8608Road("E", 1, 8.0, 8.0), Passive(1e-3), 3200)
    drive = read_recording(rerun / "bag")
    np.testing.assert_array_equal(drive.chassis.stamp, record.stamp)
    np.testing.assert_array_equal(drive.chassis.specific_force, record.specific_force[:, 0])
    np.testing.assert_array_equal(drive.powertrain.specific_force, record.specific_force[:, 1])
    np.testing.assert_array_equal(drive.answers.current, record.current)


def test_a_rerun_leaves_a_whole_bag(rerun, recorded_run):
    """With all topics of the recorded one, its own law in the provenance, and fit to be verified itself."""
    old, new = read_recording(recorded_run / "bag"), read_recording(rerun / "bag")
    before, after = counts(recorded_run / "bag"), counts(rerun / "bag")
    assert before.keys() == after.keys()
    for topic in before.keys() - {"/clock", "/diagnostics"}:  # which tell again while a run stands
        assert before[topic] == after[topic], topic
    assert old.provenance["parameters of /simulator"] == new.provenance["parameters of /simulator"]
    assert new.provenance["parameters of /controller"]["law"] == "passive"
    assert new.provenance["replay"]["law"] == "passive"
    assert set(contents(rerun / "bag").attachments) == set(contents(recorded_run / "bag").attachments)
    assert "law: passive" in attachment(rerun / "bag", "parameters/controller.yaml")
    assert attachment(rerun / "bag", "vehicle.yaml") == find_vehicle().read_text(encoding="utf-8")
    assert verify(rerun / "bag", Console(quiet=True))[0]


def test_both_are_shown(start_cli, recorded_run, rerun, tmp_path):
    """The command prints recorded and new levels and their change, and leaves them with a picture."""
    replay = start_cli("replay", recorded_run / "bag", "--law", "passive", "--out", tmp_path / "out")
    assert replay.wait() == 0, replay.output
    assert files(tmp_path / "out") == ["bag", "replay.png", "summary.json"]
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    recorded = json.loads((recorded_run / "summary.json").read_text())
    for sensor, levels in summary["rms_mps2"]["recorded"].items():
        assert levels == pytest.approx(recorded["rms_mps2"][sensor], rel=1e-12)
    old, new = (summary["rms_mps2"][which]["powertrain"]["z"] for which in ("recorded", "replayed"))
    assert summary["change_percent"]["powertrain"]["z"] == pytest.approx(100.0 * (new / old - 1.0))
    bags = recorded_run / "bag", tmp_path / "out" / "bag"
    before, after = (read_recording(bag).powertrain.specific_force[:, 2] for bag in bags)
    assert np.std(after - before) > 0.1 * np.std(before)  # levels of so short a drive may come out alike
    for number in (f"{old:.3f}", f"{new:.3f}", f"{100.0 * (new / old - 1.0):+.1f} %"):
        assert number in replay.output
    assert "ran to the end of the recording" in replay.output
    assert (tmp_path / "out" / "replay.png").read_bytes().startswith(b"\x89PNG")
    again = start_cli("replay", recorded_run / "bag", "--law", "passive", "--out", tmp_path / "out")
    assert again.wait() == 1 and "already exists" in again.output


def test_a_rerun_ends_with_its_road(recorded_run, tmp_path, monkeypatch):
    """It says so, and compares what there is."""
    from trackvib_sim.commands import replay_law

    def prepare_less(recording):
        return whole(recording._replace(road=[patch for patch in recording.road if patch[0] < 34.0]))

    whole = replay_law.prepare_again
    monkeypatch.setattr(replay_law, "prepare_again", prepare_less)
    run_replay_law(recorded_run / "bag", "passive", tmp_path / "out", Console(quiet=True))
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())["replay"]
    assert summary["ended"].startswith("the recorded road ends here") and 3.0 <= summary["duration_s"] < 3.2


@pytest.mark.parametrize(
    ("law", "words"),
    [("skyhook", "identical to the recorded ones to the last bit"), ("passive", "largest difference 2 A, RMS")],
)
def test_into_a_stock_controller(start_cli, recorded_run, tmp_path, law, words):
    """The same law gives the same currents; another one is set beside them. All messages lie in one bag."""
    replay = start_cli("replay", recorded_run / "bag", "--controller", law, "--out", tmp_path / "out")
    assert replay.wait() == 0, replay.output
    assert "currents: 3200 of 3200 samples answered; " in replay.output and words in replay.output
    assert files(tmp_path / "out") == ["bag", "currents.png", "log", "summary.json"]
    old, new = read_recording(recorded_run / "bag"), read_recording(tmp_path / "out" / "bag")
    both = counts(recorded_run / "bag") + Counter({"/replayed/current": 3200})
    assert counts(tmp_path / "out" / "bag") == both
    np.testing.assert_array_equal(new.answers.current, old.answers.current)
    again = start_cli("replay", tmp_path / "out" / "bag", "--controller", law, "--out", tmp_path / "again")
    assert again.wait() == 1 and "is the result of a replay into a controller" in again.output
    assert not (tmp_path / "again").exists()
    assert contents(tmp_path / "out" / "bag").attachments == contents(recorded_run / "bag").attachments


def test_a_bag_that_begins_in_the_middle(edited, tmp_path):
    """Levels are compared over the same instants: the same law, started from the beginning, changes nothing."""

    def late(topic, data):
        return None if topic.endswith(("imu", "mount_state")) and leading_stamp(data) <= 150_000_000 else data

    run_replay_law(edited(late), "skyhook", tmp_path / "out", Console(quiet=True))
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert {change for axes in summary["change_percent"].values() for change in axes.values()} == {0.0}
    assert summary["mounts_J"]["work"] > 0.0


def test_into_a_controller_of_ones_own(start_cli, start_node, recorded_run, tmp_path):
    """Whoever answers is asked, whenever he comes."""
    replay = start_cli("replay", recorded_run / "bag", "--controller", "external", "--out", tmp_path / "out")
    replay.wait_for("waiting for a controller")
    start_node("controller", law="skyhook")
    assert replay.wait() == 0, replay.output
    assert "3200 of 3200 samples answered; identical" in replay.output


def test_interrupted(start_cli, recorded_run, tmp_path):
    """Ctrl-C while nobody answers: the bag is closed, with what was recorded."""
    replay = start_cli("replay", recorded_run / "bag", "--controller", "external", "--out", tmp_path / "out")
    replay.wait_for("waiting for a controller")
    replay.signal(signal.SIGINT)
    assert replay.wait() == 130, replay.output
    assert counts(tmp_path / "out" / "bag")["/chassis/imu"] == 3200


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ((), 2, "exactly one of --verify, --law and --controller is needed"),
        (("--verify", "--law", "passive"), 2, "exactly one of"),
        (("--verify", "--out", "somewhere"), 2, "cannot be combined with --out"),
        (("--law", "magic"), 2, "acceleration_driven, clipped_optimal, continuous_skyhook"),
        (("--controller", "magic"), 2, "acceleration_driven, clipped_optimal, continuous_skyhook"),
        (("--law", "passive", "--out", "/proc/none"), 1, "cannot be created"),
        (("--controller", "passive", "--out", "/proc/none"), 1, "cannot be created"),
    ],
)
def test_bad_options(start_cli, recorded_run, options, code, words):
    """Each is named with what is accepted."""
    replay = start_cli("replay", recorded_run / "bag", *options)
    assert replay.wait() == code, replay.output
    assert words in replay.output.replace("\n", " ") and "Traceback" not in replay.output


def test_a_bag_without_what_is_needed(start_cli, tmp_path):
    """Nothing is made then."""
    BagWriter(tmp_path / "empty").close()
    for option in ("--law", "--controller"):
        replay = start_cli("replay", tmp_path / "empty", option, "passive", "--out", tmp_path / "out")
        assert replay.wait() == 1
        assert f"error: bag '{tmp_path / 'empty'}': it holds no" in replay.output
    assert not (tmp_path / "out").exists()
