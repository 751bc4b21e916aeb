"""`trackvib run` when it is cut short, and its bad input."""

import os
import re
import signal

import pytest
import yaml
from trackvib_sim.bags.reading import read_recording

from .conftest import wait_until
from .processes import nodes_of

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="starts whole runs to end them")]


def wait_for_text(path, text):
    """Wait until a log holds a text."""
    wait_until(lambda: path.exists() and text in path.read_text(), 60.0, f"{text!r} in {path}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_interrupted_run_leaves_a_complete_bag(start_cli, tmp_path, number):
    """Ctrl-C, a request to end and a closed terminal all end the nodes in order and close the bag."""
    run = start_cli("run", "--duration", 600, "--out", tmp_path / "run")
    wait_for_text(tmp_path / "run" / "log" / "simulator.log", "running")
    wait_until(lambda: any(file.stat().st_size > 200_000 for file in (tmp_path / "run" / "bag").glob("*.mcap")))
    run.signal(number)
    assert run.wait() == 130, run.output
    assert yaml.safe_load((tmp_path / "run" / "bag" / "metadata.yaml").read_text())
    drive = read_recording(tmp_path / "run" / "bag")
    assert drive.diagnostics["state"] == "stopped"
    assert len(drive.chassis.stamp) - len(drive.answers.sample_stamp) in (0, 1)
    assert not nodes_of(tmp_path / "run")
    assert re.search(r"^interrupted; kept in .*/run: bag, log.*; bags are complete up to here$", run.output, re.M)
    again = start_cli("run", "--out", tmp_path / "run")
    assert again.wait() == 1 and "nothing is overwritten, choose another --out or remove it" in again.output


HELD = """
from pathlib import Path
from time import sleep

from mr_mount_controller.laws import ControlLaw


class Held(ControlLaw):
    def __init__(self, period, **values):
        super().__init__(period, **values)
        while Path("/proc/self/comm").read_text() == "controller\\n" and not Path("go_on").exists():
            sleep(0.05)
"""


def test_a_run_interrupted_before_its_first_sample_leaves_nothing(start_cli, user_module, tmp_path):
    """The simulator waits for a controller; neither the folder nor the one made for it stays."""
    user_module("held", HELD)
    run = start_cli("run", "--law", "held:Held", "--out", tmp_path / "new" / "run")
    wait_for_text(tmp_path / "new" / "run" / "log" / "simulator.log", "controller")
    run.signal(signal.SIGINT)
    (tmp_path / "go_on").touch()
    assert run.wait() == 130, run.output
    assert "interrupted; nothing is kept in " in run.output
    assert not (tmp_path / "new").exists()


def test_killed_run_leaves_no_process(start_cli, tmp_path):
    """When the command itself is killed without warning, its nodes end, and the recorder closes its bag."""
    run = start_cli("run", "--duration", 600, "--out", tmp_path / "run")
    wait_for_text(tmp_path / "run" / "log" / "simulator.log", "running")
    os.kill(run.pid, signal.SIGKILL)
    run.wait()
    wait_until(lambda: not nodes_of(tmp_path / "run"), 30.0, "the end of all nodes")
    assert (tmp_path / "run" / "bag" / "metadata.yaml").exists()


def test_a_node_that_dies_ends_the_run_with_its_name(start_cli, tmp_path):
    """If the recorder is killed, the run ends, says which node it was, and exits with an error."""
    run = start_cli("run", "--duration", 600, "--out", tmp_path / "run")
    wait_for_text(tmp_path / "run" / "log" / "simulator.log", "running")
    os.kill(nodes_of(tmp_path / "run")["recorder"], signal.SIGKILL)
    assert run.wait() == 1
    assert "'recorder'" in run.output
    assert not nodes_of(tmp_path / "run")


def test_a_second_run_in_the_same_domain_is_refused(start_cli, tmp_path):
    """It says so before it starts anything, and the first run goes on undisturbed."""
    first = start_cli("run", "--duration", 600, "--out", tmp_path / "first")
    wait_for_text(tmp_path / "first" / "log" / "simulator.log", "running")
    second = start_cli("run", "--out", tmp_path / "second")
    assert second.wait() == 1
    assert "a simulator is already running in ROS domain" in second.output and "ROS_DOMAIN_ID" in second.output
    assert not (tmp_path / "second").exists()
    assert first.running


@pytest.mark.parametrize("domain", ["abc", "500", "-1"])
def test_impossible_domain_is_refused(start_cli, env, domain):
    """A ROS domain that cannot be is named with what is accepted."""
    env["ROS_DOMAIN_ID"] = domain
    run = start_cli("run")
    assert run.wait() == 1
    assert f"ROS_DOMAIN_ID is '{domain}', accepted: a whole number from 0 to 232" in run.output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--road", "Z"], ["road", "'Z'", "A, B, C, D, E, F, G, H", ".csv"]),
        (["--speed", "200"], ["--speed", "200", "-25 to 25 m/s"]),
        (["--speed", "nan"], ["--speed", "nan"]),
        (["--duration", "0"], ["--duration", "3 to 3600 s"]),
        (["--duration", "3", "--speed", "5"], ["--duration", "3 s", "at least 4.7 s"]),
        (["--law", "magic"], ["--law", "magic", "passive, skyhook"]),
        (["--seed", "-1"], ["--seed", "-1", "0 to 1000000000"]),
        (["--out", "/proc/none/run"], ["/proc/none/run", "cannot be created"]),
        (["--law-parameters", "current=9"], ["'current' is 9", "0 to 5 A"]),
        (["--law", "skyhook", "--law-parameters", "soft_current=3.5"], ["soft_current", "firm_current"]),
        (["--sped", "3"], ["--sped"]),
    ],
)
def test_bad_options_are_refused(start_cli, tmp_path, arguments, words):
    """The error names the option, its value and what is accepted; nothing is started or left."""
    run = start_cli("run", *arguments)
    assert run.wait() != 0
    output = run.output.replace("\n", " ")
    for word in words:
        assert word.lower() in output.lower(), run.output
    assert "Traceback" not in run.output and not any(path.is_dir() for path in tmp_path.iterdir())


@pytest.mark.parametrize(
    ("node", "values", "words"),
    [
        ("road_excitation", "{fade: -1.0}", "'road_excitation' cannot run: parameter 'fade' is -1.0, accepted: "),
        ("simulator", "{engine_speed: 3900.0}", "'simulator' cannot run: parameter 'engine_speed' is 3900.0, accepted"),
        ("controller", "{law: magic}", "error: parameter 'law' is 'magic', must be one of"),
    ],
)
def test_a_refused_run_leaves_nothing(start_cli, tmp_path, node, values, words):
    """Values that only the nodes can judge are refused in one line as well, and the same command is not in its way."""
    (tmp_path / "bad.yaml").write_text(f"{node}: {{ros__parameters: {values}}}\n")
    run = start_cli("run", "--params-file", "bad.yaml", "--out", tmp_path / "new" / "run")
    assert run.wait() == 1
    (error,) = (line for line in run.output.splitlines() if line.startswith("error: "))
    assert words in error and "Traceback" not in run.output
    assert not (tmp_path / "new").exists()
