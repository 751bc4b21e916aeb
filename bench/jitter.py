"""How late the periods of a run in real time begin, on a quiet machine and beside as many busy loops as it has cores.

    ./trackvib exec -- python bench/jitter.py

Four processes at 1 kHz, as `trackvib run` starts them, with `pace: realtime`; what the simulator tells at the end.
Quiet is the machine when nobody else uses it. Priorities in real time need the right to them.
"""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import click
from machine import machine
from rich.console import Console
from rich.progress import track
from rich.table import Table

PRIORITY = ("--realtime-priority", "20")
WAYS = {"as it is": (), "priority": PRIORITY, "priority, core": (*PRIORITY, "--core", "0")}
SHARES = ("p50", "p99", "p99.9")


@contextlib.contextmanager
def busy_loops(number):
    """So many processes that do nothing but take the processor."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(number)]
    try:
        yield
    finally:
        for each in loops:
            each.kill()
            each.wait()


def lateness(seconds, *options):
    """Return what a run's summary says of its loop; None where its options are not allowed."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "pace.yaml"
        file.write_text("simulator:\n  ros__parameters:\n    pace: realtime\n")
        words = ["run", "--duration", str(seconds), "--params-file", str(file), "--out", "run", *options]
        command = [sys.executable, "-m", "trackvib_sim.cli", *words]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        if "not allowed" in done.stderr:
            return None
        if done.returncode:
            sys.exit(f"the run ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
        return json.loads((Path(folder) / "run" / "summary.json").read_text())["loop"]


@click.command(help=__doc__.splitlines()[0])
@click.option("--seconds", type=click.FloatRange(3.0), default=20.0, show_default=True, help="Of each run.")
def main(seconds):
    cores = len(os.sched_getaffinity(0))
    table = Table("lateness, us", *SHARES, "overruns", title=machine())
    runs = [(machine_is, way) for machine_is in ("quiet", f"beside {cores} busy loops") for way in WAYS]
    for machine_is, way in track(runs, "runs"):
        with busy_loops(0 if machine_is == "quiet" else cores):
            loop = lateness(seconds, *WAYS[way])
        told = (
            ("not allowed",)
            if loop is None
            else (*(f"{float(loop[f'late_us_{share}']):.0f}" for share in SHARES), loop["overruns"])
        )
        table.add_row(f"{machine_is}, {way}", *told)
    Console().print(table)


if __name__ == "__main__":
    main()
