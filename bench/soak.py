"""Lock-step exchanges between three processes, as many as asked for; not one may be lost or mismatched.

    ./trackvib exec -- python bench/soak.py             # a million
    ./trackvib exec -- python bench/soak.py 100000

Every sample must have exactly one answer that names it: what the simulator counts as accepted is compared with the
number of samples, and everything else that it and the controller count must be zero.
"""

import re
import sys
import tempfile

import click
from machine import machine
from rich.progress import Progress
from trackvib_sim.nodes.loop_arguments import CONTROLLER, NODES, ROAD, SIMULATOR, closed_loop_parameters
from trackvib_sim.nodes.node_parameters import NodeParameters
from trackvib_sim.nodes.processes import FOUR_PROCESSES, LoopProcesses
from trackvib_sim.nodes.watch import Watch
from trackvib_sim.simulation.lockstep import OUTCOMES

RATE = 1000  # Hz
LOOK = 0.2  # s
PROCESSES = [name for name in FOUR_PROCESSES if name != "recorder"]


def wait_for_end(processes, exchanges):
    """Show progress until a process ends; return the last that the simulator reported."""
    with Watch() as watch, Progress() as progress:
        task = progress.add_task("exchanges", total=exchanges)
        while not processes.ended():
            values = watch.look(LOOK)
            progress.update(task, completed=RATE * float(values.get("time", 0.0)))
    return values


@click.command(help=__doc__.splitlines()[0])
@click.argument("exchanges", type=click.IntRange(1), default=1_000_000)
@click.option("--road", default="C", show_default=True)
def main(exchanges, road):
    print(machine())
    parameters = NodeParameters(NODES)
    parameters.read(closed_loop_parameters())
    parameters.give(SIMULATOR, duration=exchanges / RATE, wait_for_recorder=False)
    parameters.give(CONTROLLER, law="skyhook", wait_for_recorder=False)
    parameters.give(ROAD, road=road)
    with LoopProcesses(PROCESSES) as processes, tempfile.TemporaryDirectory() as logs:
        processes.start(parameters, logs)
        reported = wait_for_end(processes, exchanges)
        codes = processes.stop()
        said = {name: processes.last_words(name) for name in PROCESSES}
    if any(codes.values()) or "answers:" not in said["simulator"]:
        sys.exit("\n".join(f"{name} ended with code {codes[name]}:\n{said[name]}" for name in PROCESSES))
    counts = dict.fromkeys(OUTCOMES, 0)
    counts |= {name: int(n) for n, name in re.findall(r"(\d+) (\w+)", said["simulator"].rpartition("answers: ")[2])}
    accepted = counts.pop("accepted")
    gaps = int((re.findall(r"(\d+) gaps", said["controller"]) or [0])[-1])
    print(f"{exchanges} samples, {accepted} answered, {gaps} gaps seen by the controller")
    print(
        ", ".join(f"{count} {name}" for name, count in counts.items()), f"; {reported['real_time_factor']} x real time"
    )
    if accepted != exchanges or gaps or any(counts.values()):
        sys.exit("the loop does not hold")


if __name__ == "__main__":
    main()
