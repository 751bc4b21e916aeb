"""Accuracy over cost: what a finer or coarser physics step changes, and what it costs.

    ./trackvib exec -- python bench/step_accuracy.py [--picture docs/step_accuracy.png]

Each vehicle that comes with the package drives on class E at several physics rates, at two speeds with several roads
and phases between its tracks. A drive is chaotic, so the mean squares of all drives at a speed are taken together, and
the larger change of the whole RMS of chassis and powertrain (all axes) against the finest rate is set beside the
standard error of that change. Cost is in calls of Pinocchio's aba on the body tree, as in bench/vehicle.py.
"""

import argparse
import time
from dataclasses import replace

import numpy as np
import trackvib_sim as tv
from machine import machine
from peers import aba_tasks, aba_time
from rich.console import Console
from rich.progress import Progress
from rich.table import Table
from trackvib_sim.analysis.settling import settling_time
from trackvib_sim.analysis.vibration import band_limited
from trackvib_sim.data import DEFAULT_VEHICLE, find_vehicle, vehicle_names
from trackvib_sim.new_files import new_file
from trackvib_sim.road.iso8608 import FADE, LEVEL_UNTIL, Iso8608Road
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.step_size import longest_step, recommended_rate
from trackvib_sim.vehicle.vehicle_file import read_vehicle

RATES = (4000, 5000, 8000, 10_000, 20_000, 40_000)  # Hz; the last one is what the others are held against
SPEEDS = (5.0, 15.0)  # m/s
DRIVES = 8  # at each speed
MEASURED = 6.0  # s
CALLS = 2000


def drive(vehicle, rate, speed, number):
    """Return mean squares (2,) of the specific forces of a drive, and its processor time [s] per simulated second."""
    rates = replace(tv.Rates(), physics=rate)
    operation = tv.Operation(speed, 1650.0, False, (0.03 + number / DRIVES) % 1.0)
    simulation = tv.Simulation(vehicle, tv.RunSettings(operation, rates, passive_current=1.0))
    settled = round(rates.control * settling_time(speed, LEVEL_UNTIL + FADE))
    periods = settled + round(rates.control * MEASURED)
    began = time.process_time()
    record = tv.run_open_loop(simulation, Iso8608Road("E", 1 + number, LEVEL_UNTIL, FADE), periods)
    took = (time.process_time() - began) * rates.control / periods
    forces = band_limited(record.specific_force, float(rates.control))[settled:]
    return forces.var(axis=0).sum(axis=-1), took


def largest_change(coarse, fine):
    """Return the larger change of an RMS, and its standard error, given mean squares (drives, 2) at two rates."""
    ratio = np.sqrt(coarse.mean(axis=0) / fine.mean(axis=0))
    error = ratio * 0.5 * np.hypot(*(each.std(axis=0, ddof=1) / each.mean(axis=0) for each in (coarse, fine)))
    worst = np.abs(ratio - 1.0).argmax()
    return ratio[worst] - 1.0, error[worst] / np.sqrt(len(coarse))


def aba_clock(vehicle):
    """Return a function that times a call of aba on a vehicle's body tree [s]."""
    tasks = aba_tasks(build_body_table(vehicle), (0.0, 0.0, -9.81), CALLS)

    def seconds(task):
        began = time.process_time()
        task()
        return time.process_time() - began

    return lambda: aba_time({name: seconds(task) for name, task in tasks.items()}, CALLS)


def main():
    """Drive, compare, print and draw."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--picture", help="where to draw it")
    picture = arguments.parse_args().picture
    vehicles = {name: read_vehicle(find_vehicle(name))[0] for name in vehicle_names()}
    aba = aba_clock(vehicles[DEFAULT_VEHICLE])
    rows, calls = {}, []
    with Progress(console=Console(stderr=True)) as progress:
        bar = progress.add_task("drives", total=len(vehicles) * len(SPEEDS) * len(RATES) * DRIVES)
        for name, vehicle in vehicles.items():
            usable = [rate for rate in RATES if rate * longest_step(vehicle) > 1.0]
            found = {}
            for speed in SPEEDS:
                for rate in usable:
                    drives = []
                    for number in range(DRIVES):
                        drives.append(drive(vehicle, rate, speed, number))
                        calls.append(aba())
                        progress.advance(bar)
                    found[speed, rate] = np.array([squares for squares, _ in drives]), min(took for _, took in drives)
            rows[name] = [(rate, min(found[speed, rate][1] for speed in SPEEDS),
                           [largest_change(found[speed, rate][0], found[speed, RATES[-1]][0]) for speed in SPEEDS])
                          for rate in usable]  # fmt: skip
    unit = np.median(calls)
    _print(rows, unit, {name: recommended_rate(vehicle) for name, vehicle in vehicles.items()})
    if picture:
        _draw(rows, unit, vehicles, picture)


def _print(rows, unit, recommended):
    table = Table(title=f"Change of the RMS against {RATES[-1]} Hz, class E, {machine()}")
    for column in ("vehicle", "physics rate, Hz", "aba calls per simulated second", *(f"{v:g} m/s" for v in SPEEDS)):
        table.add_column(column, justify="left" if column == "vehicle" else "right")
    for name, of_vehicle in rows.items():
        for rate, took, changes in of_vehicle:
            told = [f"{change:+.1%} ± {error:.1%}" for change, error in changes]
            mark = " recommended" if rate == recommended[name] else ""
            table.add_row(name + mark, f"{rate}", f"{took / unit:.0f}", *told)
    Console(width=120).print(table)


def _draw(rows, unit, vehicles, path):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 4.5), layout="constrained")
    axes = figure.add_subplot(
        xscale="log",
        xlabel="cost, calls of aba per simulated second",
        ylabel="change of the RMS, %",
        title=f"Class E, {' and '.join(f'{v:g}' for v in SPEEDS)} m/s, against steps of {1e6 / RATES[-1]:g} µs",
    )
    for name, of_vehicle in rows.items():
        # the speed at which it changes more
        worst = [max(changes, key=lambda each: abs(each[0])) for _, _, changes in of_vehicle[:-1]]
        cost = [took / unit for _, took, _ in of_vehicle[:-1]]
        change, error = 100.0 * np.abs(np.array(worst)).T
        line = axes.errorbar(cost, change, error, marker="o", markersize=4, capsize=3, label=name)
        for (rate, _, _), x, y in zip(of_vehicle, cost, change, strict=False):
            if rate == recommended_rate(vehicles[name]):
                axes.plot(x, y, "o", markersize=12, fillstyle="none", color=line[0].get_color())
    axes.axhline(5.0, color="0.5", linestyle="--", linewidth=1)
    axes.text(axes.get_xlim()[0], 5.0, " stated accuracy", va="bottom", color="0.4")
    axes.set_ylim(0.0, 1.4 * axes.get_ylim()[1])  # room for the legend
    axes.legend(title="ringed: recommended rate", ncols=2, frameon=False)
    with new_file(path) as file:
        figure.savefig(file, format="png", dpi=120)


if __name__ == "__main__":
    main()
