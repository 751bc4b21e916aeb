"""A node in a process forked from this one: libraries, which take longest, are loaded once for all nodes."""

import atexit
import ctypes
import importlib
import multiprocessing
import os
import signal
import sys
from contextlib import suppress

from mr_mount_controller.node_base.interrupts import ENDING, block_interrupts

# Executables by name, and the modules whose `main` each runs.
MODULES = {
    "controller": "mr_mount_controller.node",
    "one_process": "trackvib_sim.nodes.one_process",
    "player": "trackvib_sim.nodes.player",
    "recorder": "trackvib_sim.nodes.recorder",
    "road_excitation": "trackvib_sim.nodes.road_excitation",
    "simulator": "trackvib_sim.nodes.simulator",
}
_FORK = multiprocessing.get_context("fork")
_PR_SET_PDEATHSIG, _PR_SET_NAME = 1, 15  # Linux: signal to a child whose parent has died; name of the process


class ForkedNode:
    """A process that waits for its arguments and is a node from then on.

    It has its own session, so that Ctrl-C reaches only whoever started it; should that process die, the kernel ends it.

    Raises
    ------
    RuntimeError
        ROS 2 has been started here already: its threads do not come along.
    """

    def __init__(self, name):
        with suppress(ImportError):  # told by the process, which has a log
            importlib.import_module(MODULES[name])
            if sys.modules["rclpy"].ok():
                raise RuntimeError(f"node {name!r} must be forked before ROS 2 is started")
        here, there = _FORK.Pipe()
        self._arguments, self._begun = here, False
        self._process = fork(_wait_and_run, name, there)
        there.close()

    def begin(self, words, log):
        """Let it run with arguments; what it prints goes to a file."""
        self._begun = True
        self._arguments.send((words, log))

    @property
    def exit_code(self):
        """None while it runs; a signal that ended it as its negative number."""
        return self._process.exitcode

    def interrupt(self):
        """Ask it to end in order."""
        if not self._process.is_alive():
            return
        if self._begun:
            os.kill(self._process.pid, signal.SIGINT)
            return
        with suppress(OSError):  # it has just ended
            self._arguments.send(None)  # a signal may find the handlers of this process in it yet

    def end(self, grace):
        """Wait for its end; after so many seconds end it."""
        self._process.join(grace)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()


def _wait_and_run(name, arguments):
    begin_program(name)
    told = arguments.recv()
    if told is None:
        return
    words, log = told
    run_program(lambda: importlib.import_module(MODULES[name]).main(), [name, *words], log)


def fork(target, *arguments):
    """Start a process that has all that is loaded here, and ends with this one; `target` begins by `begin_program`.

    Until then signals wait: it still has the handlers of this process, which would have it speak of an end.
    """
    process = _FORK.Process(target=target, args=arguments, daemon=True)
    with block_interrupts():
        process.start()
    return process


def begin_program(name):
    """In a forked process: have a session of its own, the signals of a new process, and a name among processes."""
    os.setsid()
    end_with_parent()
    ctypes.CDLL(None).prctl(_PR_SET_NAME, name.encode())
    for number in ENDING:
        signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)


def run_program(main, words, log):
    """In a forked process: run a program to the end of the process; never returns.

    Parameters
    ----------
    main : callable
        Of the program; ends by its exit code, or by SystemExit.
    words : list of str
        Its name and arguments.
    log : path
        Takes what it prints.
    """
    for path, flags, numbers in ((os.devnull, os.O_RDONLY, (0,)), (log, os.O_WRONLY | os.O_CREAT, (1, 2))):
        file = os.open(path, flags, 0o666)
        for number in numbers:
            os.dup2(file, number)
        os.close(file)
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(write_through=True)
    sys.argv = words
    try:
        code = main()
    except SystemExit as end:
        code = end.code
    # What is left open is closed, and what C has printed goes out, as at the end of every program. But nothing is taken
    # apart, by Python or by libraries: that takes as long as all the rest of a node's end.
    atexit._run_exitfuncs()
    ctypes.CDLL(None).fflush(None)
    sys.exit(code)


def end_with_parent():
    """In a new process: let the kernel end it should its parent die."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
