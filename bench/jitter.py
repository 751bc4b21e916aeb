"""How late the periods of a run in real time begin, on a quiet machine and beside as many busy loops as it has cores.

    ./trackvib exec -- python bench/jitter.py

Simulator, road and controller at 1 kHz, each a process, with `pace: realtime`; the simulator tells the latenesses. The
machine is quiet when nobody else uses it. Priorities in real time need the right to them.
"""

import os
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import click
from machine import busy, machine
from rich.console import Console
from rich.progress import track
from rich.table import Table
from trackvib_sim.nodes.loop_arguments import CONTROLLER, NODES, SIMULATOR, closed_loop_parameters
from trackvib_sim.nodes.node_parameters import NodeParameters
from trackvib_sim.nodes.processes import FOUR_PROCESSES, LoopProcesses
from trackvib_sim.nodes.watch import Watch

PROCESSES = [name for name in FOUR_PROCESSES if name != "recorder"]
WAYS = {"as it is": {}, "priority": {"realtime_priority": 20}, "priority, core": {"realtime_priority": 20, "core": 0}}
SHARES = ("p50", "p99", "p99.9")
LOOK = 0.2  # s


def lateness(seconds, scheduling):
    """Return what the simulator told last of a run, by name; None where the scheduling is not allowed."""
    parameters = NodeParameters(NODES)
    parameters.read(closed_loop_parameters())
    parameters.give(SIMULATOR, duration=seconds, pace="realtime", wait_for_recorder=False, **scheduling)
    parameters.give(CONTROLLER, wait_for_recorder=False, **scheduling)
    with LoopProcesses(PROCESSES) as processes, tempfile.TemporaryDirectory() as logs:
        processes.start(parameters, logs)
        with Watch() as watch:
            while not processes.ended():
                told = watch.look(LOOK)
        codes = processes.stop()
        said = "\n".join(processes.last_words(name) for name in PROCESSES)
    if "not allowed" in said:
        return None
    if any(codes.values()):
        sys.exit(said)
    return told


@click.command(help=__doc__.splitlines()[0])
@click.option("--seconds", type=click.FloatRange(1.0), default=20.0, show_default=True, help="Of each run.")
def main(seconds):
    cores = len(os.sched_getaffinity(0))
    table = Table("lateness, us", *SHARES, "overruns", title=machine())
    runs = [(loops, way) for loops in (0, cores) for way in WAYS]
    for loops, way in track(runs, "runs"):
        # a process for each: ROS 2 must not be loaded where the next nodes are made
        with busy(loops), ProcessPoolExecutor(1, mp_context=get_context("fork")) as apart:
            told = apart.submit(lateness, seconds, WAYS[way]).result()
        numbers = ["not allowed"]
        if told is not None:
            numbers = [*(f"{float(told[f'late_us_{share}']):.0f}" for share in SHARES), told["overruns"]]
        table.add_row(f"{f'beside {loops} busy loops' if loops else 'quiet'}, {way}", *numbers)
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
