"""Rows of the resistance study: force, power and their sinks by speed, beside published formulas."""

import csv
from io import StringIO

from ...vehicle.body_tree import GRAVITY
from ...vehicle.energy import Part
from ..case import GOOD

SINKS = {
    "links": "pins and links",
    "ground": "ground under the links",
    "rims": "rims of wheels, rollers and idlers",
    "teeth": "sprocket teeth",
    "tensioners": "tensioners",
    "hinges": "bearings of wheels, arms and bodies",
    "suspension": "shock absorbers and bump stops",
    "mounts": "mounts",
}  # name of a `Part` in small letters -> what that is
assert list(SINKS) == [part.name.lower() for part in Part]

# Internal resistance of tracked running gear, N per tonne at V km/h: a fit to military vehicles, and one to modern
# light ones [Wong].
FORMULAS = {"222 + 3 V": lambda v: 222.0 + 3.0 * v, "133 + 2.5 V": lambda v: 133.0 + 2.5 * v}
KMH = 3.6  # km/h in a m/s
TONNE = 1e3  # kg


def published(mass, speed):
    """Return by formula the force [N] that they give a vehicle of a mass [kg] at a speed [m/s]."""
    return {name: mass / TONNE * formula(KMH * speed) for name, formula in FORMULAS.items()}


def published_range(mass, speed):
    """Return the lowest and the highest of the forces that `published` gives [N]."""
    forces = published(mass, speed).values()
    return min(forces), max(forces)


def force(result):
    """Return the driving force of a good result [N]."""
    return result.drive / result.speed


def table_csv(found, mass):
    """Return a dict of cases and results as the text of a CSV file: forces in N, power in W, heat by sink in W."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    formulas = [f"formula {name}, N" for name in FORMULAS]
    head = ["speed, m/s", "force, N", "part of weight", "power, W", *(f"{name}, W" for name in SINKS), "left over"]
    writer.writerow([*head, *formulas, "status"])
    for case, result in found.items():
        theirs = published(mass, case.speed).values()
        cells = [""] * (len(head) - 1)
        if result.status == GOOD:
            pull = force(result)
            cells = [pull, pull / (mass * GRAVITY), result.drive, *result.heat.values(), result.left_over]
        written = [f"{cell:.5g}" if cell != "" else "" for cell in (*cells, *theirs)]
        writer.writerow([f"{case.speed:g}", *written, result.status])
    return text.getvalue()
