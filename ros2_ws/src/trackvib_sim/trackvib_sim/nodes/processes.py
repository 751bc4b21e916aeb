"""The processes of a closed loop: started together, watched, ended in order."""

from pathlib import Path

from mr_mount_controller.node_base.endings import ERROR, TRACEBACK

from ..simulation import closed_loop  # noqa: F401  the nodes have it from here
from .forked_node import ForkedNode

# Executables, in the order in which they start.
FOUR_PROCESSES = ("road_excitation", "controller", "recorder", "simulator")
ONE_PROCESS = ("recorder", "one_process")  # a recorder that is slow must not hold it
# In the order in which they end: nobody waits for an answer, and the recorder gets all there is. A simulator ends when
# all that it said has arrived; whatever else is on its way then, the recorder's own end waits for.
_ENDS = (("simulator", "one_process"), ("controller", "road_excitation", "recorder"))
PARAMETERS = "parameters.yaml"  # the file that all of them read
_GRACE = 60.0  # s for a process to end by itself; on a busy machine it has seconds of work to do


class LoopProcesses:
    """Runs nodes with one parameter file for all.

    Use it as a context manager around all that starts ROS 2 here: its processes are made at once (`ForkedNode`), and
    have ended when it is left.
    """

    def __init__(self, executables):
        """Make processes for `FOUR_PROCESSES`, `ONE_PROCESS` or other executables."""
        self._nodes = {name: ForkedNode(name) for name in executables}
        self._log_folder = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def start(self, parameters, log_folder):
        """Start the nodes with `NodeParameters`.

        `log_folder` takes these as a file, and what each process prints.
        """
        self._log_folder = Path(log_folder)
        file = (self._log_folder / PARAMETERS).absolute()
        parameters.write(file)
        words = ["--ros-args", "--params-file", str(file), "-r", f"__ns:={parameters.namespace}"]
        words += ["--log-level", f"{TRACEBACK}:=debug"]  # goes to the log, while `why` tells the error alone
        for name, node in self._nodes.items():
            node.begin(words, self._log(name))

    def ended(self):
        """Return the exit codes of the processes that have ended, by name."""
        return {name: node.exit_code for name, node in self._nodes.items() if node.exit_code is not None}

    def stop(self):
        """End what still runs; returns all exit codes."""
        for names in _ENDS:
            ending = [self._nodes[name] for name in names if name in self._nodes]
            for node in ending:
                node.interrupt()
            for node in ending:
                node.end(_GRACE)
        return self.ended()

    def last_words(self, name, lines=8):
        """Return the last lines that a process printed; none if their folder is gone."""
        log = self._log(name)
        text = log.read_text(errors="replace") if log.exists() else ""
        return "\n".join(text.strip().splitlines()[-lines:])

    def why(self, name):
        """Return what a process said at last, as the rest of a sentence: the error that ended it, or its last lines."""
        words = self.last_words(name)
        last = words.rpartition("\n")[2]
        if last.startswith(ERROR):
            return f": {last.removeprefix(ERROR).removeprefix(f'{name}: ')}"
        return f"; its last output:\n{words}" if words else ""

    def _log(self, name):
        return (self._log_folder / f"{name}.log").absolute()
