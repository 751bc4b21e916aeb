"""Rows of the study: quantities of a case, ours beside the reference's."""

import csv
from io import StringIO
from typing import NamedTuple

import numpy as np

from ..case import GOOD
from ..statistics import deviation
from .case import CORRELATION, RESISTANCE, ROAD_SHARE, TENSIONERS, wheel_x
from .measures import HIGH, ROAD_BORNE, THIRD_OCTAVES, band_name, levels, line_name, octave_name, within
from .reference import RATE, ROUGH, references
from .road_share import road_share
from .variants import BASE, VARIANTS

# factors within which ours should agree with the reference, by quantity
GOALS = {band_name(*HIGH): 1.15, **{octave_name(centre): 1.4 for centre in THIRD_OCTAVES}}
GOALS |= {line_name(k): 1.5 for k in (1, 2, 3)}
ROAD_BORNE_GOAL, CORRELATION_GOAL, LOAD_GOAL = 1.25, 0.8, 0.03
# what variants are judged by
FACTORS = (band_name(*ROAD_BORNE), band_name(*HIGH), *(line_name(k) for k in (1, 2, 3)), CORRELATION)


class Row(NamedTuple):
    """One quantity of one case of a variant, over all track phases."""

    variant: str
    road: str
    speed: int  # m/s
    quantity: str
    ours: float  # quadratic mean of levels, mean of others; not a number where a run failed
    scatter: float  # standard deviation
    least: float
    greatest: float
    theirs: float | None  # where the reference has it

    @property
    def factor(self):
        """By how many times ours is more than theirs, or None."""
        return self.ours / self.theirs if self.theirs else None

    @property
    def agrees(self):
        """Whether the goal is reached; None where there is none."""
        if self.quantity == CORRELATION:
            return self.ours > CORRELATION_GOAL if self.road == ROUGH else None
        if self.quantity == band_name(*ROAD_BORNE):
            return _within(self.factor, ROAD_BORNE_GOAL) if self.road == ROUGH else None
        return _within(self.factor, GOALS[self.quantity]) if self.quantity in GOALS else None

    @property
    def covers(self):
        """Whether the reference lies among our runs."""
        return self.least <= self.theirs <= self.greatest


def _within(factor, goal):
    return bool(1.0 / goal <= factor <= goal)


def table_rows(found, vehicle):
    """Return the rows of a dict of cases and results (`case.M113Case`, `case.M113Result`) of a vehicle."""
    groups = {}
    for case, result in found.items():
        groups.setdefault((case.variant, case.road, case.speed), []).append(result)
    rows = []
    for (variant, road, speed), results in groups.items():
        reference = references()[road, speed]
        theirs = levels(reference.vertical, RATE, reference.speed / vehicle.tracks.pitch)
        quantities = [*theirs, *TENSIONERS, RESISTANCE]
        if road == ROUGH:
            road_borne = within(reference.vertical, RATE, ROAD_BORNE)
            theirs[ROAD_SHARE] = road_share(road_borne, reference.place, reference.speed, wheel_x(vehicle))
            quantities += [CORRELATION, ROAD_SHARE]
        for quantity in quantities:
            values = np.array([each.numbers.get(quantity, np.nan) for each in results])
            ours = np.sqrt(np.mean(values**2)) if quantity in theirs else values.mean()
            spread = float(deviation(values)), float(values.min()), float(values.max())
            rows.append(Row(variant, road, speed, quantity, float(ours), *spread, theirs.get(quantity)))
    return rows


def beside_variants(found):
    """Return the part of a dict of cases and results that has the phases at which variants were driven.

    Lines depend on the phase between the tracks: only runs of the same phases can be set beside each other.
    """
    phases = {case.track_phase for case in found if case.variant != BASE}
    return {case: result for case, result in found.items() if case.track_phase in phases}


def variant_factors(rows):
    """Return what each variant makes of the vehicle's own levels, by its name: a factor for each of `FACTORS`.

    Geometric means over the cases, the rough ones where the road plays the part; the correlation is as it is.
    """
    base = {(row.road, row.speed, row.quantity): row.ours for row in rows if row.variant == BASE}

    def factor(variant, quantity):
        of_the_road = quantity in (FACTORS[0], CORRELATION)
        mine = [row for row in rows if (row.variant, row.quantity) == (variant, quantity)]
        mine = [row for row in mine if row.road == ROUGH or not of_the_road]
        if quantity == CORRELATION:
            return float(np.mean([row.ours for row in mine]))
        return float(np.exp(np.mean([np.log(row.ours / base[row.road, row.speed, quantity]) for row in mine])))

    return {variant: [factor(variant, quantity) for quantity in FACTORS] for variant in VARIANTS}


def failures(found):
    """Return a line about each run that failed."""
    return [f"{case.variant}, {case.road}, {case.speed} m/s: {result.status}"
            for case, result in found.items() if result.status != GOOD]  # fmt: skip


def table_csv(rows):
    """Return rows as the text of a CSV file."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        ["variant", "road", "speed", "quantity", "ours", "ours_std", "least", "greatest", "theirs", "factor", "agrees"]
    )
    for row in rows:
        theirs, factor = ("" if each is None else f"{each:.4g}" for each in (row.theirs, row.factor))
        agrees = {None: "", True: "yes", False: "no"}[row.agrees]
        writer.writerow(
            [row.variant, row.road, row.speed, row.quantity, f"{row.ours:.4g}", f"{row.scatter:.2g}",
             f"{row.least:.4g}", f"{row.greatest:.4g}", theirs, factor, agrees]
        )  # fmt: skip
    return text.getvalue()
