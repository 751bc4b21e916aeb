"""Rows of the controller study, and what the laws gain over constant currents."""

import csv
from io import StringIO
from typing import NamedTuple

import numpy as np

from ..statistics import deviation, half_interval
from .scenario import GOOD, PASSIVE, PASSIVE_CURRENT, QUANTITIES, SCENARIOS

JUDGED = ("powertrain", "powertrain_wk", "hull", "hull_wk", "force", "travel")  # the less the better
ALIKE = 2.5  # A; from here on all constant currents give nearly the same mount, damping within 15 %
SURE = "the 95 % interval over the seeds does not contain zero"  # what the star of a gain means


class Row(NamedTuple):
    """One law, or one constant current, in a scenario over all seeds."""

    scenario: str
    law: str
    current: float | None  # A, of the passive law, else None
    levels: dict  # quantity -> (seeds,), not a number where a run failed
    failures: list  # why runs failed

    @property
    def name(self):
        """What the row is called: the law, or the constant current."""
        return self.law if self.current is None else f"{self.current:g} A"

    def mean(self, quantity):
        """Return a quantity's mean over the seeds; not a number if any run failed."""
        return float(np.mean(self.levels[quantity]))


class Gain(NamedTuple):
    """By how many percent a quantity is less, over the seeds, each compared with itself."""

    mean: float
    half: float  # of its 95 % interval by Student's t; not a number where there is one run

    @property
    def sure(self):
        """Whether the interval excludes zero."""
        return abs(self.mean) > self.half

    def text(self):
        """Return it as a cell, with a star where it is sure."""
        text = f"{self.mean:+.1f}" + (f" ± {self.half:.1f}" if np.isfinite(self.half) else "")
        return f"{text} *" if self.sure else text


class Verdict(NamedTuple):
    """The best constant current and the best law in a scenario, by one quantity."""

    scenario: str
    quantity: str
    current: float  # A, the best constant one
    constant_gain: Gain  # over passive at 1 A
    law: str
    law_gain: Gain  # over passive at 1 A
    over_best: Gain  # of the law over the best constant current
    chance: float  # %, see `chance`


def table_rows(found):
    """Return the rows of a dict of cases and results (`scenario.ControlCase`, `scenario.ControlResult`)."""
    by_row, order = {}, list(SCENARIOS)
    # not in the order in which runs were done: the table must not depend on it
    for case in sorted(found, key=lambda c: (order.index(c.scenario), c.law != PASSIVE, c.law, c.current, c.seed)):
        key = (case.scenario, case.law, case.current if case.law == PASSIVE else None)
        by_row.setdefault(key, []).append(found[case])
    return [_row(key, results) for key, results in by_row.items()]


def _row(key, results):
    levels = {name: np.array([each.levels.get(name, np.nan) for each in results]) for name in QUANTITIES}
    return Row(*key, levels, [each.status for each in results if each.status != GOOD])


def gain(levels, reference):
    """Return the `Gain` of levels (seeds,) over others of the same seeds."""
    each = 100.0 * (1.0 - levels / reference)
    return Gain(float(each.mean()), half_interval(each))


def best_by_others(rows, quantity):
    """Return a quantity's levels (seeds,), each that of the row with the least mean over all other seeds.

    The best of many rows is better on the seeds that it was chosen by for nothing; so each seed judges what the others
    have chosen. A single run has to do both.
    """
    levels = np.array([row.levels[quantity] for row in rows])
    count = levels.shape[1]
    if count == 1:
        return levels.min(axis=0)
    others = levels.sum(axis=1, keepdims=True) - levels
    return levels[others.argmin(axis=0), np.arange(count)]


def chance(constants, quantity):
    """Return by how many percent a quantity's means scatter among constant currents that are nearly alike.

    Tracks amplify the smallest difference, so that the best of several rows is better by about this much for nothing.
    """
    means = [row.mean(quantity) for row in constants if row.current >= ALIKE]
    return 100.0 * float(deviation(means) / np.mean(means))


def verdict(rows):
    """Return the `Verdict`s by scenario and judged quantity, where a law and passive at 1 A have not failed."""
    found = []
    for scenario in dict.fromkeys(row.scenario for row in rows):
        mine = [row for row in rows if row.scenario == scenario and not row.failures]
        constants = {row.current: row for row in mine if row.current is not None}
        laws = [row for row in mine if row.current is None]
        if PASSIVE_CURRENT not in constants or not laws:
            continue
        for quantity in JUDGED:
            groups = list(constants.values()), laws
            constant, law = (min(them, key=lambda row: row.mean(quantity)) for them in groups)
            passive = constants[PASSIVE_CURRENT].levels[quantity]
            of_constant, of_law = (best_by_others(them, quantity) for them in groups)
            gains = gain(of_constant, passive), gain(of_law, passive), gain(of_law, of_constant)
            noise = chance(constants.values(), quantity)
            found.append(Verdict(scenario, quantity, constant.current, gains[0], law.law, *gains[1:], noise))
    return found


def table_csv(rows):
    """Return rows as the text of a CSV file: means over the seeds, and in further columns standard deviations."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns = [*QUANTITIES, *(f"{name}_std" for name in QUANTITIES)]
    writer.writerow(["scenario", "law", "constant_current", *columns, "status"])
    for row in rows:
        values = [part(row.levels[name]) for part in (np.mean, deviation) for name in QUANTITIES]
        cells = [f"{value:.6g}" if np.isfinite(value) else "" for value in values]
        current = "" if row.current is None else f"{row.current:g}"
        writer.writerow([row.scenario, row.law, current, *cells, "; ".join(row.failures) or GOOD])
    return text.getvalue()
