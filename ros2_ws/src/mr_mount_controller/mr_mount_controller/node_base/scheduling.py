"""How the operating system runs a node: in real time, on which core, after all others, and when it wakes it."""

import ctypes
import os
from contextlib import suppress

from .parameters import Parameter, ParameterError

SCHEDULING = (
    Parameter(
        "realtime_priority",
        0,
        "Priority of the process in real time (SCHED_FIFO), before all that has none; 0 for none.",
        "",
        0,
        99,
    ),
    Parameter("core", -1, "Core that the process keeps to; -1 for any.", "", -1, 1023),
)
_NICE = 10  # more than it had
_PR_SET_TIMERSLACK = 29  # Linux: how much later than asked for a thread may wake, ns
_HINT = "not allowed here: needs root, CAP_SYS_NICE or a limit `ulimit -r` as high (rtprio in limits.conf)"


def schedule(settings):
    """Take up what the parameters `SCHEDULING` say, for every thread that the process has: DDS has made its own.

    Raises
    ------
    ParameterError
        It is not allowed, or there is no such core.
    """
    priority, core = (settings[parameter.name] for parameter in SCHEDULING)

    def place(thread):
        if core >= 0:
            _keep_to(thread, core)
        if priority:
            _run_in_real_time(thread, priority)

    _each_thread(place)


def stand_back():
    """Let others go first, with every thread that the process has; what wakes one interrupts nobody."""

    def lower(thread):
        os.setpriority(os.PRIO_PROCESS, thread, os.getpriority(os.PRIO_PROCESS, thread) + _NICE)
        os.sched_setscheduler(thread, os.SCHED_BATCH, os.sched_param(0))

    _each_thread(lower)


def wake_on_time():
    """Let the calling thread wake as soon as a wait is over: by default Linux gathers wake-ups for 50 us."""
    ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1)


def _each_thread(treat):
    for thread in map(int, os.listdir("/proc/self/task")):
        with suppress(ProcessLookupError):  # it has ended meanwhile
            treat(thread)


def _keep_to(thread, core):
    try:
        os.sched_setaffinity(thread, {core})
    except OSError as error:
        if isinstance(error, ProcessLookupError):
            raise
        cores = ", ".join(map(str, sorted(os.sched_getaffinity(0))))
        raise ParameterError(f"parameter 'core' is {core}, accepted on this machine is -1 or one of {cores}") from None


def _run_in_real_time(thread, priority):
    try:
        os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError:
        raise ParameterError(f"parameter 'realtime_priority' is {priority}, {_HINT}") from None
