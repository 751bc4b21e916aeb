"""Whole vehicles in one process on one core: how much faster than real time, and in calls of Pinocchio's aba.

    ./trackvib exec -- python bench/vehicle.py [--parts]

Body tree, two tracks, mounts and engine of each vehicle that comes with the package, on a road of class E at 10 m/s, at
its recommended physics rate. Beside them, in turns, the articulated-body algorithm of Pinocchio evaluates the default
vehicle's body tree alone (its call from Python taken off, see bench/body_tree.py): the unit in which machines of
different speed can be compared. With --parts a second table has the parts of a step, as far as they can be timed alone.
"""

import argparse

import numpy as np
from machine import best_times, machine
from peers import aba_tasks, aba_time
from rich.console import Console
from rich.table import Table
from step_parts import part_tasks, parts_of_step
from trackvib_sim.data import DEFAULT_VEHICLE, find_vehicle, vehicle_names
from trackvib_sim.road.iso8608 import FADE, LEVEL_UNTIL, Iso8608Road
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation, new_work
from trackvib_sim.vehicle.vehicle_file import read_vehicle

SPEED = 10.0  # m/s
ENGINE_SPEED = 1650.0  # r/min
CHUNK = 250  # control periods of 1 ms at a time
CALLS, ROUNDS, STEPS = 2000, 40, 2000
GRAVITY = (0.0, 0.0, -9.81)


class Drive:
    """A vehicle that drives on, chunk after chunk."""

    def __init__(self, vehicle):
        settings = RunSettings(Operation(SPEED, ENGINE_SPEED, False), Rates(recommended_rate(vehicle)), 1.0)
        self.rates = settings.rates
        self._simulation = Simulation(vehicle, settings)
        length = 50.0 + SPEED * (ROUNDS + 2) * CHUNK / settings.rates.control
        road, spacing = Iso8608Road("E", 1, LEVEL_UNTIL, FADE), 0.05
        first = round(-20.0 / spacing)
        self._simulation.road.add(first * spacing, spacing, *road.heights(first, round(length / spacing) - first))
        sample = self._simulation.sample
        self._record = [np.empty((CHUNK, *part.shape)) for part in (sample.specific_force, sample.probed)]
        self._speed = np.empty(CHUNK)
        self._current = np.ones(self._simulation.mounting.coils)
        while self._simulation.distance < LEVEL_UNTIL + FADE:  # onto the full roughness
            self()

    def __call__(self):
        self._simulation.advance_many(self._current, *self._record, self._speed)

    def parts(self):
        """Return the tasks of `step_parts.part_tasks` where the vehicle is now."""
        s = self._simulation
        road = s.road.around(s.distance - s.system.drive.reach, s.distance + s.system.drive.reach)
        return part_tasks((s.system, s.state, road, new_work(s.system), s.points, s.sample), STEPS)


def main():
    """Drive, time, print."""
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--parts", action="store_true", help="print the parts of a step, too")
    with_parts = arguments.parse_args().parts
    vehicles = {name: read_vehicle(find_vehicle(name))[0] for name in vehicle_names()}
    drives = {name: Drive(vehicle) for name, vehicle in vehicles.items()}
    tasks = aba_tasks(build_body_table(vehicles[DEFAULT_VEHICLE]), GRAVITY, CALLS)
    parts = {(name, part): task for name, drive in drives.items() if with_parts for part, task in drive.parts().items()}
    times = best_times({**drives, **tasks, **parts}, ROUNDS)
    aba = aba_time({task: times[task] for task in tasks}, CALLS)
    simulated = CHUNK * 1e-3
    factor = simulated / times[DEFAULT_VEHICLE]
    calls = {name: times[name] / simulated / aba for name in vehicles}

    table = Table(title=f"Whole vehicles, class E, {SPEED:g} m/s, one core of {machine()}")
    for column in ("what", "time, us", "aba calls a simulated second"):
        table.add_column(column, justify="left" if column == "what" else "right")
    for name in vehicles:
        rates = drives[name].rates
        step = f"{1e6 * times[name] / (rates.steps * CHUNK):.2f}"
        table.add_row(f"{name}, one step of {1e6 / rates.physics:g} us", step, f"{calls[name]:.0f}")
    table.add_row("Pinocchio aba, body tree alone", f"{1e6 * aba:.2f}", "")
    out = Console()
    out.print(table)
    if with_parts:
        by_vehicle = {
            name: parts_of_step(
                {part: times[name, part] / STEPS for other, part in parts if other == name},
                times[name] / (drives[name].rates.steps * CHUNK),
            )
            for name in vehicles
        }
        out.print(_parts_table(by_vehicle, {name: drive.rates.physics for name, drive in drives.items()}, aba))
    print(f"real time factor = {factor:.1f}")
    print(f"aba calls per simulated second = {calls[DEFAULT_VEHICLE]:.0f}")


def _parts_table(by_vehicle, rate, aba):
    """Return the table of the parts of each vehicle's step [s], given rates [Hz] and the time of an aba call [s]."""
    table = Table(title="Parts of a step, us / aba calls a simulated second")
    table.add_column("part")
    for name in by_vehicle:
        table.add_column(name, justify="right")
    for part in by_vehicle[DEFAULT_VEHICLE]:
        spent = {name: parts[part] for name, parts in by_vehicle.items()}
        table.add_row(part, *(f"{1e6 * time:.2f} / {rate[name] * time / aba:.0f}" for name, time in spent.items()))
    return table


if __name__ == "__main__":
    main()
