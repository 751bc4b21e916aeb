"""What the benchmarks share: the name of the machine, a busy one, and timing things beside each other."""

import os
import platform
import subprocess
import sys
import time
from contextlib import contextmanager

from trackvib_sim.nodes.forked_node import end_with_parent


def machine():
    """Return processor, number of cores and Python, for the head of a table."""
    cpu = "unknown processor"
    with open("/proc/cpuinfo") as lines:
        for line in lines:
            if line.startswith("model name"):
                cpu = line.split(":", 1)[1].strip()
                break
    return f"{cpu}, {len(os.sched_getaffinity(0))} cores, Python {platform.python_version()}"


def best_times(tasks, rounds):
    """Return the shortest time [s] of each task, a mapping of names to functions, over `rounds` rounds.

    The tasks take turns, so that none has the machine's better hour; the shortest time is the least disturbed one.
    """
    best = dict.fromkeys(tasks, float("inf"))
    for _ in range(rounds):
        for name, task in tasks.items():
            began = time.perf_counter()
            task()
            best[name] = min(best[name], time.perf_counter() - began)
    return best


@contextmanager
def busy(processes):
    """Let so many processes compute."""
    command = [sys.executable, "-c", "while True: pass"]
    running = [subprocess.Popen(command, preexec_fn=end_with_parent) for _ in range(processes)]
    try:
        yield
    finally:
        for process in running:
            process.kill()
            process.wait()
