"""The processes of a closed loop: started together, watched, ended in order."""

import ctypes
import json
import signal
import subprocess
import time
from pathlib import Path

from ament_index_python.packages import get_package_prefix, get_package_share_directory

# Packages of the executables, in the order in which they start.
FOUR_PROCESSES = {
    "road_excitation": "trackvib_sim",
    "controller": "mr_mount_controller",
    "recorder": "trackvib_sim",
    "simulator": "trackvib_sim",
}
ONE_PROCESS = {"recorder": "trackvib_sim", "one_process": "trackvib_sim"}  # a recorder that is slow must not hold it
_GRACE = 10.0  # s for a process to end by itself
_PR_SET_PDEATHSIG = 1  # Linux: signal to a child whose parent has died


def closed_loop_parameters():
    """Return the path of the node parameters that `closed_loop.launch.py` and `trackvib run` share."""
    return Path(get_package_share_directory("trackvib_sim")) / "config" / "closed_loop.yaml"


class LoopProcesses:
    """Starts the nodes with one parameter file and their own overrides.

    Each has its own session, so that Ctrl-C reaches only whoever started them, who then ends them in order; should
    that process die, the kernel ends them.
    """

    def __init__(self, executables, parameter_file, overrides, log_folder):
        """Start `FOUR_PROCESSES` or `ONE_PROCESS`.

        `overrides` maps names of nodes to parameters, `log_folder` takes what each process prints.
        """
        given = []
        for node, parameters in overrides.items():
            for parameter, value in parameters.items():
                given += ["-p", f"{node}:{parameter}:={json.dumps(value)}"]  # JSON is YAML, and quotes what needs it
        self._log_folder = Path(log_folder)
        self._processes = {}
        for name, package in executables.items():
            executable = Path(get_package_prefix(package)) / "lib" / package / name
            command = [str(executable), "--ros-args", "--params-file", str(parameter_file), *given]
            with (self._log_folder / f"{name}.log").open("wb") as log:
                self._processes[name] = subprocess.Popen(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                    preexec_fn=end_with_parent,
                )

    def ended(self):
        """Return the exit codes of the processes that have ended, by name."""
        return {name: code for name, process in self._processes.items() if (code := process.poll()) is not None}

    def stop(self):
        """End what still runs: the simulator first, the recorder last, so that it gets all there is."""
        order = ("simulator", "one_process", "controller", "road_excitation", "recorder")
        for name in sorted(self._processes, key=order.index):
            process = self._processes[name]
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                if not _wait(process, _GRACE):
                    process.kill()
                    process.wait()
        return self.ended()

    def last_words(self, name, lines=8):
        """Return the last lines that a process printed; none if their folder is gone."""
        log = self._log_folder / f"{name}.log"
        text = log.read_text(errors="replace") if log.exists() else ""
        return "\n".join(text.strip().splitlines()[-lines:])


def _wait(process, seconds):
    end = time.monotonic() + seconds
    while process.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    return process.poll() is not None


def end_with_parent():
    """In a new process: let the kernel end it should its parent die."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
