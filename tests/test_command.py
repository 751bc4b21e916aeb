"""`./trackvib` itself and the stand-in for `ros2 run`."""

import os
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[1]
TRACKVIB = ROOT / "trackvib"
STAND_IN = ROOT / "environment" / "bin" / "ros2"


@pytest.fixture
def run(start):
    """Run a command to its end: exit code and output."""

    def make(*command):
        process = start(command)
        return process.wait(), process.output

    return make


@pytest.mark.parametrize("code", [0, 7])
def test_exec_hands_the_exit_code_through(run, code):
    """`exec -- CMD` is the command itself, in the environment, without a word of its own."""
    script = f"import rclpy, trackvib_msgs.msg, sys; sys.exit({code})"
    assert run(TRACKVIB, "exec", "--", "python3", "-c", script) == (code, "")


def test_unknown_commands_are_refused(run):
    """A command that does not exist and a verb that does not exist give one line or click's own, and no 0."""
    code, output = run(TRACKVIB, "exec", "--", "no-such-command")
    assert code == 127 and "no-such-command" in output
    code, output = run(TRACKVIB, "fly")
    assert code != 0 and "fly" in output


def test_works_through_a_link_from_elsewhere(run, tmp_path):
    """The script finds its checkout by itself, and leaves the user's directory alone."""
    (tmp_path / "tv").symlink_to(TRACKVIB)
    assert run("./tv", "exec", "--", "pwd") == (0, f"{tmp_path}\n")


def test_stand_in_names_what_exists(run):
    """Unknown package, unknown executable and other verbs get one line that says what there is."""
    code, output = run(sys.executable, STAND_IN, "run", "nowhere", "x")
    assert code == 1 and "trackvib_sim" in output
    code, output = run(sys.executable, STAND_IN, "run", "trackvib_sim", "x")
    assert code == 1 and "simulator" in output and "recorder" in output
    code, output = run(sys.executable, STAND_IN, "topic", "list")
    assert code == 2 and "only 'run'" in output


def test_stand_in_runs_a_node(start):
    """It becomes the node: parameters arrive, and the node's exit code is its own."""
    node = start([sys.executable, STAND_IN, "run", "trackvib_sim", "simulator", "--ros-args", "-p", "speed:=99.0"])
    assert node.wait() == 2
    assert "stand-in" in node.output and "'speed'" in node.output


def test_stand_in_steps_aside(run, tmp_path, env):
    """Where another `ros2` is on the path, that one gets the call."""
    real = tmp_path / "bin" / "ros2"
    real.parent.mkdir()
    real.write_text('#!/bin/sh\necho "the real one: $@"\n')
    real.chmod(0o755)
    env["PATH"] = os.pathsep.join([str(STAND_IN.parent), env["PATH"], str(real.parent)])
    assert run(STAND_IN, "topic", "list") == (0, "the real one: topic list\n")
