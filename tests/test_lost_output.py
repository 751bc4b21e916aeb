"""What becomes of a verb's results when terminal, disk or folder fail it, or when its recorder loses messages."""

import os
import shutil
import signal
import subprocess
import sys

import pytest
from mr_mount_controller.node_base.cdr import leading_stamp
from rclpy.serialization import deserialize_message
from trackvib_msgs.msg import RoadProfile
from trackvib_sim.analysis.completeness import missing
from trackvib_sim.bags.reading import read_recording

from .conftest import wait_until
from .processes import nodes_of

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="does whole runs")]

RUN = ("run", "--duration", "3.2", "--one-process", "--out")


def command(*arguments):
    return [sys.executable, "-m", "trackvib_sim.cli", *map(str, arguments)]


def one_error(text):
    """Assert that there is one error and no traceback in it; returns it."""
    assert text.count("error:") == 1 and "Traceback" not in text, text
    return text[text.index("error:") :]


@pytest.mark.parametrize("verb", ["run", "analyze", "law", "controller"])
def test_a_terminal_that_breaks_off_costs_no_results(recorded_run, env, tmp_path, verb):
    """Nobody reads on, as after `| head`: every file is there, nothing is said, the exit code is that of SIGPIPE."""
    arguments = {
        "run": RUN,
        "analyze": ("analyze", recorded_run / "bag", "--out"),
        "law": ("replay", recorded_run / "bag", "--law", "passive", "--out"),
        "controller": ("replay", recorded_run / "bag", "--controller", "passive", "--out"),
    }[verb]
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        command(*arguments, tmp_path / "out"), stdout=writer, stderr=subprocess.PIPE, text=True, env=env, cwd=tmp_path
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (128 + signal.SIGPIPE, "")
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert (
        files
        >= {
            "run": {"bag", "summary.json", "summary.txt", "run.png"},
            "analyze": {"report.html"},
            "law": {"bag", "summary.json", "replay.png"},
            "controller": {"bag", "summary.json", "currents.png"},
        }[verb]
    )


@pytest.mark.parametrize(
    "verb",
    [("--help",), ("run", "--help"), ("study", "--help"), ("vehicle", "--list"), ("bag", "info")],
)
def test_nobody_reads_a_short_verb(recorded_run, tmp_path, verb):
    """Help as well ends without a word."""
    bag = (recorded_run / "bag",) if verb[0] == "bag" else ()
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(command(*verb, *bag), stdout=writer, stderr=subprocess.PIPE, text=True, cwd=tmp_path)
    os.close(writer)
    assert (done.returncode, done.stderr) == (128 + signal.SIGPIPE, "")


@pytest.mark.parametrize("verb", [("modes",), ("vehicle",), ("bag", "info"), ("replay", "--verify")])
def test_a_full_terminal(recorded_run, tmp_path, verb):
    """One error with the reason, and an exit code, of the short verbs as well."""
    bag = (recorded_run / "bag",) if verb[0] in ("bag", "replay") else ()
    with open("/dev/full", "w") as full:
        done = subprocess.run(command(*verb, *bag), stdout=full, stderr=subprocess.PIPE, text=True, cwd=tmp_path)
    assert done.returncode == 1
    assert "No space left on device" in one_error(done.stderr)
    if not bag:
        assert [path.name for path in tmp_path.iterdir()] == [f"{verb[0]}.png"]


@pytest.mark.parametrize("verb", ["analyze", "law", "vehicle", "modes"])
def test_a_full_disk_leaves_whole_files_or_none(recorded_run, env, tmp_path, verb):
    """Files cannot grow beyond 20 kB: one error, an exit code, nothing half-written, and what was there is still so."""
    arguments = {
        "analyze": ("analyze", recorded_run / "bag", "--out", "results/out"),
        "law": ("replay", recorded_run / "bag", "--law", "passive", "--out", "results/out"),
        "vehicle": ("vehicle", "--out", "results/picture.png"),
        "modes": ("modes", "--out", "results/picture.png"),
    }[verb]
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "picture.png").write_text("an old one")
    done = subprocess.run(
        ["prlimit", "--fsize=20000", *command(*arguments)], capture_output=True, text=True, env=env, cwd=tmp_path
    )
    assert done.returncode == 1, done.stderr
    assert "File too large" in one_error(done.stderr)
    assert [path.name for path in (tmp_path / "results").iterdir()] == ["picture.png"]
    assert (tmp_path / "results" / "picture.png").read_text() == "an old one"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small disk, and files' sizes bind DDS, too")
@pytest.mark.parametrize("verb", ["run", "controller"])
def test_a_full_disk_under_the_loop(recorded_run, env, tmp_path, verb):
    """The run's bag can be repaired, of the replay nothing is left; one error each, and an exit code."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", disk]).returncode:
        pytest.skip("mounting is not allowed here")
    try:
        arguments = RUN if verb == "run" else ("replay", recorded_run / "bag", "--controller", "passive", "--out")
        done = subprocess.run(command(*arguments, disk / "out"), capture_output=True, text=True, env=env, cwd=tmp_path)
        assert done.returncode == 1
        assert "No space left on device" in done.stderr and "Traceback" not in done.stderr
        assert (disk / "out").exists() == (verb == "run")
        if verb == "run":
            assert "trackvib bag repair" in done.stderr
            saved = shutil.copytree(disk / "out" / "bag", tmp_path / "saved")
            assert subprocess.run(command("bag", "repair", saved), capture_output=True).returncode == 0
            assert len(read_recording(saved).chassis.stamp) > 100
    finally:
        subprocess.run(["umount", "-l", disk], check=True)


def test_a_run_whose_folder_goes(start_cli, tmp_path):
    """One error, and an exit code."""
    run = start_cli(*RUN, tmp_path / "out")
    wait_until(lambda: list((tmp_path / "out").glob("bag/*.mcap")))
    shutil.rmtree(tmp_path / "out")
    assert run.wait() == 1
    one_error(run.output)


HALTING = """
import time
from pathlib import Path

from mr_mount_controller.laws import ControlLaw


class Halting(ControlLaw):
    def update(self, sample):
        if round(1000 * sample.time) == 3300:  # enough to be measured
            Path("halted").touch()
            while not Path("go_on").exists():
                time.sleep(0.01)
        return 0.0
"""


def test_a_run_that_lost_messages_says_so(start_cli, user_module, tmp_path):
    """A recorder that stands still for longer than it is waited for: what it missed is counted, the exit code tells."""
    user_module("halting", HALTING)
    run = start_cli("run", "--law", "halting:Halting", "--duration", "8", "--one-process", "--out", tmp_path / "out")
    wait_until((tmp_path / "halted").exists)
    recorder = nodes_of(tmp_path / "out")["recorder"]
    os.kill(recorder, signal.SIGSTOP)
    try:
        (tmp_path / "go_on").touch()
        log = tmp_path / "out" / "log" / "one_process.log"
        wait_until(lambda: "the recorder does not keep up" in log.read_text())
        wait_until(lambda: "8 s simulated" in log.read_text())  # its writers hold the last second of samples
    finally:
        os.kill(recorder, signal.SIGCONT)  # one that stands does not even end with its run
    assert run.wait() == 1
    said = one_error(run.output)
    assert f"the bag in '{tmp_path / 'out'}' is not complete: " in said and said.rstrip().endswith(" missing")
    assert (tmp_path / "out" / "summary.json").exists()


def test_what_a_bag_lacks(recorded_run, edited):
    """Each kind of message is counted, and the first that is missing named."""
    assert missing(read_recording(recorded_run / "bag")) == []
    stamps = {"/coil_current": 341, "/mount_state": 500, "/chassis/imu": 700}  # ms, of what is lost

    def lose(topic, data):
        return None if topic in stamps and leading_stamp(data) == stamps[topic] * 1_000_000 else data

    assert missing(read_recording(edited(lose))) == [
        "1 of 3200 chassis/imu (first at t = 0.700 s)",
        "1 of 3200 mount_state (first at t = 0.500 s)",
        "1 of 3200 coil_current (first at t = 0.341 s)",
    ]


def test_a_sensor_that_was_never_heard(recorded_run):
    """Which sensors there are is what the vehicle in the bag says, not what is in the bag."""
    recording = read_recording(recorded_run / "bag")
    sensor = "\nsensors: {cupola: {body: turret, place: {value: [0, 0, 0], unit: m, source: assumed}, divisor: "
    vehicle = f"{recording.vehicle}{sensor}{{value: 4, unit: '-', source: assumed}}}}}}\n"
    assert missing(recording._replace(vehicle=vehicle)) == ["800 of 800 cupola/imu (first at t = 0.004 s)"]
    assert missing(recording._replace(vehicle=None)) == ["vehicle_description"]


def _late(data):
    return leading_stamp(data) >= 2_000_000_000


def _far_away(data):
    return deserialize_message(data, RoadProfile).start > 20.0  # m


@pytest.mark.parametrize(
    ("lost", "which", "words"),
    [("/diagnostics", _late, "the simulator's final diagnostics"), ("/road_profile", _far_away, "road_profile from")],
)
def test_a_bag_that_lacks_what_comes_rarely(edited, lost, which, words):
    """Without its last word a simulator's counts tell nothing; without road no replay gets there."""
    bag = edited(lambda topic, data: None if topic == lost and which(data) else data)
    (lacking,) = missing(read_recording(bag))
    assert lacking.startswith(words)
