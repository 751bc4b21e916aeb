"""How long one waits for a verb, beside the import of the libraries that it stands on.

./trackvib exec -- python bench/startup.py
"""

import os
import resource
import subprocess
import sys
import tempfile
import time

import click
from machine import machine
from rich.console import Console
from rich.progress import track
from rich.table import Table

PEER = "import click, numba, numpy, scipy.signal, matplotlib.figure, rclpy"
VERBS = (["--help"], ["run", "--help"], ["vehicle"], ["modes"], ["run", "--duration", "3"])


def times(command, folder):
    """Return wall time and processor time [s] of a command with all of its children."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(f"{' '.join(command)} ended with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


@click.command(help=__doc__.splitlines()[0])
@click.option("--rounds", type=click.IntRange(1), default=5, show_default=True)
def main(rounds):
    start = [sys.executable, "-m", "trackvib_sim.cli"]
    commands = {"import of libraries": [sys.executable, "-c", PEER]}
    commands |= {f"trackvib {' '.join(verb)}": [*start, *verb] for verb in VERBS}
    found = {name: [] for name in commands}
    os.environ["COLUMNS"] = "100"
    for _ in track(range(rounds), "rounds"):
        for name, command in commands.items():
            with tempfile.TemporaryDirectory() as folder:
                found[name].append(times(command, folder))
    peer = min(wall for wall, _ in found["import of libraries"])
    table = Table("", "wall, s", "processor, s", "wall / import", title=f"{machine()}, best of {rounds}")
    for name, taken in found.items():
        wall = min(wall for wall, _ in taken)
        table.add_row(name, f"{wall:.2f}", f"{min(processor for _, processor in taken):.2f}", f"{wall / peer:.2f}")
    Console().print(table)


if __name__ == "__main__":
    main()
