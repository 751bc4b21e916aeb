"""A period of the loop beside the bare exchange of two messages between two processes, the least that it could take.

    ./trackvib exec -- python bench/exchange.py

One process publishes an Imu, the other answers with a CoilCurrent as soon as it has it: rclpy, the executor and the
quality of service of the loop, and nothing else. The loop then runs as four processes and as one, in turns with it.
The least that a period could take is physics and exchange, in one process physics and law. Priority and core of a run
need the right to them; it goes without where they are not allowed.
"""

import json
import multiprocessing
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median

import click
from machine import best_times, machine
from mr_mount_controller.laws import find_law
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.running import answer
from rich.console import Console
from rich.progress import track
from rich.table import Table

EXCHANGES = 3000
SECONDS = 4.0  # of each run
CORE = ("--core", "0")
FREE = ("--realtime-priority", "20", *CORE)  # of whatever else the machine does
WAYS = {
    "four processes": (),
    "four processes, core": CORE,
    "one process": ("--one-process",),
    "four processes, priority, core": FREE,
    "one process, priority, core": ("--one-process", *FREE),
}


def _partner(publishes, hears, answers, ready):
    """Return a node's executor, and a function that publishes; with `answers` it answers whatever it hears.

    ROS 2 is loaded here, after the fork.
    """
    import rclpy
    from mr_mount_controller.node_base.qos import LOOP_QOS, LOOP_WRITER_QOS
    from rclpy.experimental import EventsExecutor
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import Imu
    from trackvib_msgs.msg import CoilCurrent

    kinds, heard = {"imu": Imu, "current": CoilCurrent}, []
    rclpy.init()
    node = rclpy.create_node(f"exchange_{publishes}")
    publisher = node.create_publisher(kinds[publishes], f"bench/{publishes}", LOOP_WRITER_QOS)
    message = serialize_message(Imu() if publishes == "imu" else CoilCurrent(current=[1.0, 1.0]))

    def on_message(data):
        heard.append(None)
        if answers:
            publisher.publish(message)

    node.create_subscription(kinds[hears], f"bench/{hears}", on_message, LOOP_QOS, raw=True)
    executor = EventsExecutor()
    executor.add_node(node)
    while not (publisher.get_subscription_count() and node.count_publishers(f"bench/{hears}")):
        executor.spin_once(timeout_sec=0.05)
    ready.wait()
    return executor, lambda: publisher.publish(message), heard


def _answer(ready, over):
    executor, _, _ = _partner("current", "imu", True, ready)
    while not over.is_set():
        executor.spin_once(timeout_sec=0.2)


def _ask(ready, over, times):
    executor, publish, heard = _partner("imu", "current", False, ready)
    taken = []
    for number in range(1, EXCHANGES + 1):
        began = time.perf_counter()
        publish()
        while len(heard) < number:
            executor.spin_once(timeout_sec=1.0)
        taken.append(time.perf_counter() - began)
    over.set()
    times.send(median(taken))


def bare_exchange():
    """Return the median time [s] of an exchange between two processes that do nothing else."""
    context = multiprocessing.get_context("fork")
    ready, over, (here, there) = context.Barrier(2), context.Event(), context.Pipe(False)
    pair = [
        context.Process(target=_answer, args=(ready, over)),
        context.Process(target=_ask, args=(ready, over, there)),
    ]
    for process in pair:
        process.start()
    taken = here.recv()
    for process in pair:
        process.join()
    return taken


def law():
    """Return the time [s] that the law of these runs takes for an answer."""
    law, sample = find_law("passive")(1e-3), Sample(0.0, *4 * [(0.0, 0.0, 0.0)])
    return best_times({"law": lambda: [answer(law, sample) for _ in range(1000)]}, 5)["law"] / 1000


def loop(*options):
    """Return what a run's summary says of its loop; None where its options are not allowed."""
    with tempfile.TemporaryDirectory() as folder:
        command = [
            sys.executable,
            "-m",
            "trackvib_sim.cli",
            "run",
            "--duration",
            str(SECONDS),
            "--out",
            "run",
            *options,
        ]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if "not allowed" in done.stderr:
            return None
        if done.returncode:
            sys.exit(f"the run ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
        return json.loads((Path(folder) / "run" / "summary.json").read_text())["loop"]


@click.command(help=__doc__.splitlines()[0])
@click.option("--rounds", type=click.IntRange(1), default=3, show_default=True)
def main(rounds):
    bare, found = [], {name: [] for name in WAYS}
    for _ in track(range(rounds), "rounds"):
        bare.append(1e6 * bare_exchange())
        for name, options in WAYS.items():
            found[name].append(loop(*options))
    exchange = min(bare)
    table = Table("", "period, us", "physics", "publishing", "waiting", "holding", "over the least", title=machine())
    table.add_row("bare exchange", f"{exchange:.0f}", "", "", f"{exchange:.0f}", "", "")
    for name, runs in found.items():
        if None in runs:
            continue
        best = max(runs, key=lambda each: float(each["real_time_factor"]))
        period = 1e3 / float(best["real_time_factor"])
        parts = [float(best[f"{part}_us_per_period"]) for part in ("physics", "publishing", "answer", "holding")]
        least = parts[0] + (1e6 * law() if "one process" in name else exchange)
        table.add_row(name, f"{period:.0f}", *(f"{part:.0f}" for part in parts), f"{period / least:.2f}")
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
