"""How strongly each number of the table depends on each parameter, by central differences."""

import csv
from io import StringIO
from typing import NamedTuple

import numpy as np

from ..paper.paper_table import COLUMNS

REACH = 0.05  # share of the range to either side
PER = 0.1  # share of the range that a sensitivity stands for


class Sensitivity(NamedTuple):
    """Of all numbers to all parameters at one set of values."""

    change: np.ndarray  # (parameters, rows, 6) of log(RMS) for `PER` of the parameter's range; nan where a run failed
    noise: float  # standard error of a change, from the scatter among the runs of a row; nan if there is one only

    @property
    def strength(self):
        """Root mean square (parameters,) of the changes over all numbers."""
        return np.sqrt(np.ma.masked_invalid(np.square(self.change)).mean(axis=(1, 2)).filled(np.nan))

    @property
    def order(self):
        """Numbers of the parameters, the strongest first."""
        return np.argsort(-self.strength)


def sensitivity(candidates, history, values, progress):
    """Return the `Sensitivity` at a set of values.

    Parameters
    ----------
    candidates : calibration_search.Candidates
    history : calibration_history.History
        Of these runs; "generation" is the number of the parameter, "index" is 0 below and 1 above.
    values : sequence of float
    progress : rich.progress.Progress
    """
    plan = candidates.plan
    wanted = _sides(plan, values)
    task = progress.add_task("sensitivity", total=len(wanted) * len(candidates.cases))
    found = candidates.evaluate(history, wanted, lambda done: progress.advance(task, done))
    low, high = found[::2], found[1::2]
    change, distance = [], []
    for k, (below, above) in enumerate(zip(low, high, strict=True)):
        distance.append(plan.shares(above.values)[k] - plan.shares(below.values)[k])
        change.append(PER / distance[k] * np.log(above.ratios / below.ratios))
    squares = np.ma.masked_invalid([candidate.scatter**2 for candidate in found])
    noise = np.sqrt(2.0 * squares.mean()) * PER / np.median(distance)
    return Sensitivity(np.array(change), float(np.ma.filled(noise, np.nan)))


def sensitivity_csv(plan, rows, sensitive):
    """Return a `Sensitivity` as the text of a CSV file, one line a parameter, one column a number of the table."""
    names = [f"{road_class}_{speed:g}_{column}" for road_class, speed in rows for column in COLUMNS]
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["item", *names])
    for item, changes in zip(plan.items, sensitive.change, strict=True):
        writer.writerow([item, *(f"{value:.4g}" if np.isfinite(value) else "" for value in changes.ravel())])
    return text.getvalue()


def _sides(plan, values):
    """Return (parameter, side) -> values with that parameter `REACH` below and above, at most at its bound."""
    shares, sides = plan.shares(values), {}
    for k, share in enumerate(shares):
        for side, shift in enumerate((-REACH, REACH)):
            moved = list(values)
            moved[k] = plan.parameters[k].value(min(max(share + shift, 0.0), 1.0))
            sides[k, side] = moved
    return sides
