"""`./trackvib` itself, and the stand-in for `ros2` as a program."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[1]
TRACKVIB = ROOT / "trackvib"
STAND_IN = ROOT / "environment" / "bin" / "ros2"
NOBODY = 65534
# May read everything, wherever the checkout and its Python lie, and write nothing.
READ = ["--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search"]
AS_NOBODY = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", *READ]
SLOW = pytest.mark.slow(reason="does whole verbs, some as another user")
SHORT_RUN = ["run", "--duration", "3", "--one-process"]
SHORT_STUDY = ["study", "table1", "--classes", "A", "--speeds", "5", "--seeds", "1"]


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
    code, output = run(sys.executable, STAND_IN, "bag", "info")
    assert code == 2 and "invalid choice: 'bag'" in output


@pytest.mark.slow(reason="a real node")
def test_stand_in_runs_a_node(start):
    """It becomes the node: parameters arrive, and the node's exit code is its own."""
    node = start([sys.executable, STAND_IN, "run", "trackvib_sim", "simulator", "--ros-args", "-p", "speed:=99.0"])
    assert node.wait() == 2
    assert node.output.startswith("error: ") and "'speed'" in node.output


def test_stand_in_steps_aside(run, tmp_path, env):
    """Where another `ros2` is on the path, that one gets the call."""
    real = tmp_path / "bin" / "ros2"
    real.parent.mkdir()
    real.write_text('#!/bin/sh\necho "the real one: $@"\n')
    real.chmod(0o755)
    env["PATH"] = os.pathsep.join([str(STAND_IN.parent), env["PATH"], str(real.parent)])
    assert run(STAND_IN, "topic", "list") == (0, "the real one: topic list\n")


@pytest.mark.parametrize(
    "verb",
    [["help"], *(pytest.param(verb, marks=SLOW) for verb in (["vehicle"], SHORT_RUN, SHORT_STUDY))],
    ids=lambda verb: verb[0],
)
def test_files_where_the_user_stands_are_not_run(run, tmp_path, verb):
    """A module there with the name of one that is needed is left alone, by the verb and by what it starts."""
    own = ("pickle", "random", "socket") if sys.version_info >= (3, 11) else ()  # of Python's own start of processes
    for name in ("json", "click", "numpy", "yaml", *own):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'was_run')!r}, 'a').write(__name__)\n")
    code, output = run(TRACKVIB, *verb)
    assert code == 0, output
    assert not (tmp_path / "was_run").exists()


@pytest.mark.parametrize("name", ["ä ö", "a (copy)", "a & b", "[y]", "#z", "a\nb", "a\x1b[2Jb"])
def test_a_path_that_the_build_cannot_take_is_refused(run, tmp_path, name):
    """At once, by one line of plain characters, before anything is made."""
    checkout = tmp_path / name
    shutil.copytree(ROOT / "environment", checkout / "environment")
    shutil.copy(TRACKVIB, checkout)
    code, output = run(checkout / "trackvib", "setup")
    assert code == 1 and "path must not contain" in output
    assert output.rstrip("\n").isprintable()
    assert not (checkout / ".trackvib").exists()


@pytest.fixture
def of_nobody():
    """A folder of a user who has nothing else, and to whom this checkout is read-only."""
    if os.geteuid() != 0 or not shutil.which("setpriv"):
        pytest.skip("needs root and setpriv, to become another user")
    if subprocess.run([*AS_NOBODY, "test", "!", "-w", ROOT / ".trackvib"]).returncode:
        pytest.skip("no right to become another user, or he may write to this checkout")
    folder = Path(tempfile.mkdtemp())
    os.chown(folder, NOBODY, NOBODY)
    yield folder
    shutil.rmtree(folder)


@SLOW
@pytest.mark.parametrize(
    ("place", "job"),
    [
        ("HOME", [*SHORT_RUN, "--out", "result"]),
        ("XDG_CACHE_HOME", ["exec", "--", "python", "-m", "trackvib_sim.compile_kernels"]),
        ("TMPDIR", ["exec", "--", "python", "-m", "trackvib_sim.compile_kernels"]),
    ],
    ids=["HOME", "XDG_CACHE_HOME", "TMPDIR"],
)
def test_another_user_gets_the_compiled_kernels(run, env, of_nobody, place, job):
    """They are copied to the one place where he can write; then a run, or what calls every kernel, compiles none."""
    kernels = Path(env["NUMBA_CACHE_DIR"])
    compiled = _contents(kernels)
    own = {"PATH": env["PATH"], "HOME": "/nonexistent", "ROS_DOMAIN_ID": env["ROS_DOMAIN_ID"], place: str(of_nobody)}
    env.clear()
    env.update(own)
    code, output = run(*AS_NOBODY, "env", "-C", of_nobody, TRACKVIB, *job)
    assert code == 0, output
    (copy,) = {index.parents[1] for index in of_nobody.rglob("*.nbi")}
    # tests beside this one may have compiled something before and after the copy was made
    assert compiled.items() <= _contents(copy).items() <= _contents(kernels).items()


def _contents(kernels):
    """What each file of compiled code under the folder holds."""
    return {str(file.relative_to(kernels)): file.read_bytes() for file in kernels.rglob("*.nbc")}


@pytest.mark.parametrize(("verb", "meant"), [("tset", "test"), ("dosc", "docs"), ("sehll", "shell"), ("vew", "view")])
def test_a_verb_that_is_nearly_right(run, verb, meant):
    """The error suggests what may have been meant, of the environment's verbs and of the laboratory's."""
    code, output = run(TRACKVIB, verb)
    assert code in (1, 2) and f"Did you mean '{meant}'?" in output


def test_nobody_reads_the_help(tmp_path):
    """Without a word, and with the exit code of SIGPIPE."""
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([TRACKVIB, "--help"], stdout=writer, stderr=subprocess.PIPE, text=True, cwd=tmp_path)
    os.close(writer)
    assert (done.returncode, done.stderr) == (-signal.SIGPIPE, "")
