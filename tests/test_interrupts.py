"""`trackvib run` when it is cut short, and its bad input."""

import os
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
        (["--sped", "3"], ["--sped"]),
    ],
)
def test_bad_options_are_refused(start_cli, arguments, words):
    """The error names the option, its value and what is accepted; nothing is started."""
    run = start_cli("run", *arguments)
    assert run.wait() != 0
    output = run.output.replace("\n", " ")
    for word in words:
        assert word.lower() in output.lower(), run.output
    assert "Traceback" not in run.output
