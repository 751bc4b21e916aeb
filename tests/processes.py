"""Real processes of a test: commands, and nodes forked from a server that has everything loaded."""

import multiprocessing
import multiprocessing.forkserver
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from trackvib_sim.nodes.processes import end_with_parent

NODE_SERVER = Path(__file__).parent / "node_server"
sys.path.append(str(NODE_SERVER))  # under the name that the server knows it by

from node_process import become  # noqa: E402

# Only a bound for what hangs; nothing here measures speed.
PATIENCE = 90.0
_SERVER = multiprocessing.get_context("forkserver")
_SERVER.set_forkserver_preload(["node_process", "loaded"])


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


class Node(Process):
    """A node in a process of its own, forked where its libraries and kernels are loaded: these take the longest."""

    def __init__(self, name, arguments, log, env, folder):
        self._log = log
        log.touch()
        with pytest.MonkeyPatch.context() as patch:  # where the server, at its start, finds what it shall load
            patch.setenv("PYTHONPATH", os.pathsep.join([str(NODE_SERVER), os.environ.get("PYTHONPATH", "")]))
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
        """Send a signal; a node has no processes of its own."""
        os.kill(self.pid, number)

    def clean_up(self):
        if self.running:
            self._process.kill()
            self._process.join()
