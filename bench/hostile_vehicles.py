"""Vehicle files with wild numbers: each gives a working vehicle or one clear error.

    ./trackvib exec -- python bench/hostile_vehicles.py --count 5000 --seed 1

Of the shipped file, one to three numbers are scaled by 0, by something tiny, huge or negative, or by a factor near one.
Each file is read, its vehicle built, its tracks laid and its static equilibrium sought. Right is a vehicle in which
every number is finite, or a ValueError that says in one line of plain text an item what is accepted.
"""

import argparse
import copy
import math
import random
import sys
import warnings
from collections import Counter

import yaml
from machine import machine
from rich.console import Console
from rich.table import Table
from trackvib_sim.data import find_vehicle
from trackvib_sim.drawings.assembled_vehicle import assemble_vehicle
from trackvib_sim.vehicle.equilibrium import NoEquilibrium, static_equilibrium
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.tracks.layout import TrackDoesNotFit
from trackvib_sim.vehicle.vehicle_file import VehicleFileError, parse_vehicle

KNOWN = (VehicleFileError, TrackDoesNotFit, NoEquilibrium)
LONGEST = 600  # characters of a line of an error
MILD = (0.5, 0.9, 0.99, 1.01, 1.1, 2.0)
WILD = (0.0, 1e-300, 1e-12, 1e-3, 0.1, 10.0, 1e3, 1e12, 1e300, -1.0, -1e-12, -1e12)


def numbers(content):
    """Return the places of all numbers in a vehicle file: section, item and indices."""

    def inside(value, path):
        if isinstance(value, list):
            return [place for k, each in enumerate(value) for place in inside(each, (*path, k))]
        return [path] if isinstance(value, (int, float)) else []

    return [
        place
        for section, items in content.items()
        for item, quantity in items.items()
        for place in inside(quantity["value"], (section, item, "value"))
    ]


def wild(content, places, chance):
    """Return a copy with one to three numbers scaled, and what was done."""
    new, done = copy.deepcopy(content), []
    for *path, last in chance.sample(places, chance.randint(1, 3)):
        factor = chance.choice(chance.choice((MILD, WILD)))
        holder = new
        for step in path:
            holder = holder[step]
        holder[last] *= factor
        done.append(f"{path[0]}.{path[1]} x {factor:g}")
    return new, ", ".join(done)


def outcome(text):
    """Return the kind of outcome of a file's text, and what is wrong with it, "" if nothing."""
    try:
        vehicle = parse_vehicle(text, "wild.yaml")
        assembled = assemble_vehicle(vehicle)
        system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
        state = static_equilibrium(system, 1.0)
    except ValueError as error:
        if not isinstance(error, KNOWN) and "must be" not in str(error):
            return type(error).__name__, f"does not say what is accepted: {error}"
        lines = str(error).split("\n")
        long = [line for line in lines if len(line) > LONGEST or not line.isprintable()]
        return type(error).__name__, f"not a plain line: {long[0]!r}" if long else ""
    except Exception as error:  # the table is of exactly these
        return type(error).__name__, f"{type(error).__name__}: {str(error)[:200]!r}"
    finite = math.isfinite(assembled.mass) and all(map(math.isfinite, (*assembled.pins.flat, *state.tree.hinge.flat)))
    return "a vehicle", "" if finite else "a number that is not finite"


def main():
    """Print the table; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000, help="vehicle files")
    parser.add_argument("--seed", type=int, default=1)
    choices = parser.parse_args()
    content, chance = yaml.safe_load(find_vehicle().read_text(encoding="utf-8")), random.Random(choices.seed)
    places, tried, right, wrongs = numbers(content), Counter(), Counter(), []
    for _ in range(choices.count):
        new, done = wild(content, places, chance)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numpy's, of overflow on the way to an error
            kind, wrong = outcome(yaml.safe_dump(new, sort_keys=False))
        tried[kind] += 1
        right[kind] += not wrong
        if wrong:
            wrongs.append(f"{done}: {wrong}")
    table = Table("outcome", "files", "right", title=f"{machine()}; seed {choices.seed}")
    for kind, count in tried.most_common():
        table.add_row(kind, str(count), str(right[kind]))
    Console().print(table)
    for line in wrongs:
        print(line)
    return 1 if wrongs else 0


if __name__ == "__main__":
    sys.exit(main())
