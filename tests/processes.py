"""Real processes of a test: commands, and programs of ours forked from a server that has everything loaded."""

import multiprocessing
import multiprocessing.forkserver
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest
from trackvib_sim.nodes.forked_node import end_with_parent

PROGRAM_SERVER = Path(__file__).parent / "program_server"
sys.path.append(str(PROGRAM_SERVER))  # under the name that the server knows it by

from program import become  # noqa: E402

# Only a bound for what hangs; nothing here measures speed.
PATIENCE = 200.0
_SERVER = multiprocessing.get_context("forkserver")
_SERVER.set_forkserver_preload(["program", "loaded"])


def _begin():
    """In a new process: a test run started in the background of a script has Ctrl-C ignored, and hands that on."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    end_with_parent()


class Process:
    """A running process with everything it prints."""

    def __init__(self, command, log, env, folder):
        self._log = log
        with log.open("wb") as file:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                env=env,
                cwd=folder,
                preexec_fn=_begin,
            )
        self.pid = self._process.pid

    @property
    def output(self):
        """All that it has printed so far."""
        return self._log.read_text(errors="replace")

    @property
    def running(self):
        return self._process.poll() is None

    def wait(self):
        """Wait for its end; returns the exit code."""
        try:
            return self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"did not end; it printed:\n{self.output}") from None

    def wait_for(self, text):
        """Wait until it has printed a text."""
        end = time.monotonic() + PATIENCE
        while text not in self.output:
            if not self.running or time.monotonic() > end:
                assert text in self.output, f"never printed {text!r} but:\n{self.output}"
            time.sleep(0.05)

    def signal(self, number):
        """Send a signal to the whole process group, as a terminal does."""
        os.killpg(self.pid, number)

    def clean_up(self):
        if self.running:
            self.signal(signal.SIGKILL)
            self._process.wait()


class Program(Process):
    """A node or the command line in a process of its own, forked where libraries and kernels are loaded already."""

    def __init__(self, name, arguments, log, env, folder):
        self._log = log
        log.touch()
        with pytest.MonkeyPatch.context() as patch:  # where the server, at its start, finds what it shall load
            patch.setenv("PYTHONPATH", os.pathsep.join([str(PROGRAM_SERVER), os.environ.get("PYTHONPATH", "")]))
            multiprocessing.forkserver.ensure_running()
        self._process = _SERVER.Process(target=become, args=(name, arguments, log, env, folder))
        self._process.start()
        self.pid = self._process.pid

    @property
    def running(self):
        return self._process.is_alive()

    def wait(self):
        self._process.join(PATIENCE)
        assert self._process.exitcode is not None, f"did not end; it printed:\n{self.output}"
        return self._process.exitcode

    def signal(self, number):
        while self.running and os.getpgid(self.pid) != self.pid:  # it is about to have a group of its own
            time.sleep(0.01)
        super().signal(number)

    def clean_up(self):
        if self.running:
            self.signal(signal.SIGKILL)
            self._process.join()


def trackvib(*arguments, code=0, cwd=None, env=None):
    """Run the command line to its end, which must be with an exit code; returns what it printed."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "printed.log"
        program = Program(
            "trackvib", [str(word) for word in arguments], log, env or dict(os.environ), cwd or Path.cwd()
        )
        try:
            assert program.wait() == code, program.output
            return program.output
        finally:
            program.clean_up()


def nodes_of(run):
    """Return the process ids of the nodes that print to a run's folder, by name."""
    return processes_printing_to(run / "log")


def processes_printing_to(folder):
    """Return the process ids of what prints to files of a folder, by name."""
    found = {}
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "fd" / "1").readlink().is_relative_to(folder):
                found[(process / "comm").read_text().strip()] = int(process.name)
        except OSError:  # it has ended, or is another user's
            continue
    return found


def assert_in_good_health(process):
    """A process that is asked to end ends well; it has said once of each topic that it refuses messages."""
    process.signal(signal.SIGINT)
    assert process.wait() == 0, process.output
    assert "Traceback" not in process.output
    refused = re.findall(r"message on (\S+) refused", process.output)
    assert len(refused) == len(set(refused)), process.output
