"""A period of the loop beside the bare exchange of two messages between two processes, the least that it could take.

    ./trackvib exec -- python bench/exchange.py

One process publishes an Imu, the other answers with a CoilCurrent as soon as it has it: rclpy, the executor and the
quality of service of the loop, and nothing else. The loop then runs as four processes and as one, in turns with it.
The least that a period could take is physics and exchange, in one process physics and law. Priority and core of a run
need the right to them; it goes without where they are not allowed.

Two rows more show the messages of a whole period exchanged in the same bare way: two Imu, mount state and current, with
a third process that takes them all as the recorder does; and the same in one process, with nobody else. All times are
means, as those of the loop are.
"""

import json
import multiprocessing
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from statistics import mean

import click
from machine import best_times, machine
from mr_mount_controller.laws import find_law
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.running import answer
from rich.console import Console
from rich.progress import track
from rich.table import Table

EXCHANGES, FIRST = 4000, 1000  # of which so many are not counted
ANSWER, MOUNTS = "current", "mounts"
ONE, ALL = ("chassis",), ("chassis", "powertrain", MOUNTS)  # what is sent before each answer
REST = 0.005  # s between two looks of a recorder
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


class Partner:
    """A node that publishes and hears messages by these names; ROS 2 is loaded here, after the fork.

    `on_message(partner)` is called with each that is heard.
    """

    def __init__(self, publishes, hears, on_message=lambda partner: None, executor=None):
        import rclpy
        from mr_mount_controller.node_base.qos import LOOP_QOS, LOOP_WRITER_QOS
        from rclpy.experimental import EventsExecutor

        if not rclpy.ok():
            rclpy.init()
        self.heard, self._on_message, self._messages = 0, on_message, _messages()
        self._node = rclpy.create_node("_".join(("bench", *publishes)))
        self._out = {name: self._publisher(name, LOOP_WRITER_QOS) for name in publishes}
        for name in hears:
            kind, _ = self._messages[name]
            self._node.create_subscription(kind, f"bench/{name}", self._take, LOOP_QOS, raw=True)
        self._hears, self.executor = hears, executor or EventsExecutor()
        self.executor.add_node(self._node)

    def _publisher(self, name, qos):
        kind, message = self._messages[name]
        publisher = self._node.create_publisher(kind, f"bench/{name}", qos)
        return publisher, partial(publisher.publish, message)

    def _take(self, _data):
        self.heard += 1
        self._on_message(self)

    def meet(self, listeners):
        """Wait until each topic has as many listeners as it shall have, by name, and what is heard a publisher."""
        while not (
            all(publisher.get_subscription_count() == listeners[name] for name, (publisher, _) in self._out.items())
            and all(self._node.count_publishers(f"bench/{name}") for name in self._hears)
        ):
            self.executor.spin_once(timeout_sec=0.05)

    def publish(self):
        """Publish one message of each kind."""
        for _, publish in self._out.values():
            publish()

    def exchanges(self):
        """Return the mean time [s] from publishing to the answer."""
        taken = []
        for number in range(1, EXCHANGES + 1):
            began = time.perf_counter()
            self.publish()
            while self.heard < number:
                self.executor.spin_once(timeout_sec=1.0)
            taken.append(time.perf_counter() - began)
        return mean(taken[FIRST:])


def _messages():
    """Return type and serialised message by name."""
    from geometry_msgs.msg import Vector3
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import Imu
    from trackvib_msgs.msg import CoilCurrent, MountState

    mounts = MountState(**{name: [1.0, 1.0] for name in ("current", "stiffness", "damping", "dissipated_power")})
    mounts.deflection, mounts.velocity, mounts.force = ([Vector3(), Vector3()] for _ in range(3))
    samples = {"chassis": Imu(), "powertrain": Imu(), MOUNTS: mounts, ANSWER: CoilCurrent(current=[1.0, 1.0])}
    return {name: (type(sample), serialize_message(sample)) for name, sample in samples.items()}


def _answered(sent):
    return [name for name in sent if name != MOUNTS]


def _answer_last(sent, partner):
    """Answer the last of the messages that belong together."""
    if partner.heard % len(_answered(sent)) == 0:
        partner.publish()


def _listeners(sent, recorders):
    return {name: recorders for name in sent} | {name: 1 + recorders for name in (*_answered(sent), ANSWER)}


def _ask(sent, recorders, ready, over, times):
    partner = Partner(sent, [ANSWER])
    partner.meet(_listeners(sent, recorders))
    ready.wait()
    times.send(partner.exchanges())
    over.set()


def _answer(sent, recorders, ready, over):
    partner = Partner([ANSWER], _answered(sent), partial(_answer_last, sent))
    partner.meet(_listeners(sent, recorders))
    ready.wait()
    while not over.is_set():
        partner.executor.spin_once(timeout_sec=0.2)


def _record(sent, ready, over):
    from mr_mount_controller.node_base.scheduling import stand_back
    from rclpy.task import Future

    partner = Partner([], [*sent, ANSWER])
    partner.meet({})
    stand_back()
    ready.wait()
    while not over.is_set():
        partner.executor.spin_until_future_complete(Future(), timeout_sec=0.0)
        time.sleep(REST)


def _alone(sent, times):
    partner = Partner(sent, [ANSWER])
    other = Partner([ANSWER], _answered(sent), partial(_answer_last, sent), partner.executor)
    for each in (partner, other):
        each.meet(_listeners(sent, 0))
    times.send(partner.exchanges())


def bare_exchange(sent, recorders):
    """Return the mean time [s] of an exchange between two processes that do nothing else, a third one recording."""
    context = multiprocessing.get_context("fork")
    ready, over, (here, there) = context.Barrier(2 + recorders), context.Event(), context.Pipe(False)
    return _received(
        here,
        context.Process(target=_answer, args=(sent, recorders, ready, over)),
        context.Process(target=_ask, args=(sent, recorders, ready, over, there)),
        *(context.Process(target=_record, args=(sent, ready, over)) for _ in range(recorders)),
    )


def exchange_alone(sent):
    """Return the mean time [s] of the same within one process."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(False)
    return _received(here, context.Process(target=_alone, args=(sent, there)))


def _received(pipe, *processes):
    for process in processes:
        process.start()
    taken = pipe.recv()
    for process in processes:
        process.join()
    return taken


def law():
    """Return the time [s] that the law of these runs takes for an answer."""
    law, sample = find_law("passive")(1e-3), Sample(0.0, *4 * [(0.0, 0.0, 0.0)])
    return best_times({"law": lambda: [answer(law, sample) for _ in range(1000)]}, 5)["law"] / 1000


def loop(*options):
    """Return what a run's summary says of its loop; None where its options are not allowed."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "trackvib_sim.cli", "run", "--duration", str(SECONDS), "--out", "run"]
        done = subprocess.run([*command, *options], cwd=folder, capture_output=True, text=True)
        if "not allowed" in done.stderr:
            return None
        if done.returncode:
            sys.exit(f"the run ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
        return json.loads((Path(folder) / "run" / "summary.json").read_text())["loop"]


@click.command(help=__doc__.splitlines()[0])
@click.option("--rounds", type=click.IntRange(1), default=3, show_default=True)
def main(rounds):
    exchanges = {
        "bare exchange": partial(bare_exchange, ONE, 0),
        "all messages of a period, bare, recorded": partial(bare_exchange, ALL, 1),
        "all messages of a period, bare, in one process": partial(exchange_alone, ALL),
    }
    bare, found = {name: [] for name in exchanges}, {name: [] for name in WAYS}
    for _ in track(range(rounds), "rounds"):
        for name, exchange in exchanges.items():
            bare[name].append(1e6 * exchange())
        for name, options in WAYS.items():
            found[name].append(loop(*options))
    table = Table("", "period, us", "physics", "publishing", "waiting", "holding", "over the least", title=machine())
    for name, taken in bare.items():
        table.add_row(name, f"{min(taken):.0f}")
    for name, runs in found.items():
        if None in runs:
            continue
        best = max(runs, key=lambda each: float(each["real_time_factor"]))
        period = 1e3 / float(best["real_time_factor"])
        parts = [float(best[f"{part}_us_per_period"]) for part in ("physics", "publishing", "answer", "holding")]
        least = parts[0] + (1e6 * law() if "one process" in name else min(bare["bare exchange"]))
        table.add_row(name, f"{period:.0f}", *(f"{part:.0f}" for part in parts), f"{period / least:.2f}")
    Console(width=110).print(table)


if __name__ == "__main__":
    main()
