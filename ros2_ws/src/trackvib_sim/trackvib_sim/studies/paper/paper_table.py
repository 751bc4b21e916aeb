"""Table 1 of [Tao2025] and ours in the same form: RMS accelerations by road class and speed, and how they compare.

Columns are in the paper's axes: X longitudinal, Y vertical, Z lateral, which are x, z, y of ROS.
"""

import csv
from io import StringIO
from typing import NamedTuple

import numpy as np

from ..case import GOOD
from ..statistics import deviation

SENSORS = ("chassis", "powertrain")
COLUMNS = tuple(f"{sensor}_{axis}" for sensor in SENSORS for axis in "xyz")
PAPER_AXES = [0, 2, 1]  # ROS axes of the paper's X, Y, Z
OUTSIDE = "outside the valid range"
_KEYS = ("road_class", "speed_mps")


class Row(NamedTuple):
    """One class and speed over all seeds; not a number where no seed gave a value."""

    road_class: str
    speed: float  # m/s
    rms: np.ndarray  # (6,) means over the seeds in the order of `COLUMNS`, m/s^2
    scatter: np.ndarray  # (6,) standard deviations over the seeds, m/s^2
    rigid: np.ndarray  # (3,) the hull at the powertrain's sensor, m/s^2
    status: str  # `GOOD`, or which part of the runs left the valid range and why


def table_rows(found):
    """Return the rows, by class and speed, of a dict of cases and their results (`drive.Case`, `drive.Result`)."""
    by_row = {}
    for case in sorted(found, key=lambda case: (case.road_class, case.speed, case.seed)):
        by_row.setdefault((case.road_class, case.speed), []).append(found[case])
    return [_row(*key, results) for key, results in by_row.items()]


def _row(road_class, speed, results):
    good = [result.rms for result in results if result.status == GOOD]
    reasons = dict.fromkeys(result.status.removeprefix("failed: ") for result in results if result.status != GOOD)
    status = GOOD
    if reasons:
        part = f"{len(results) - len(good)} of {len(results)} " if good else ""
        status = f"{part}{OUTSIDE}: {'; '.join(reasons)}"
    if not good:
        return Row(road_class, speed, np.full(6, np.nan), np.full(6, np.nan), np.full(3, np.nan), status)
    values = np.array([[rms[sensor] for sensor in (*SENSORS, "rigid")] for rms in good])[..., PAPER_AXES]
    sensors = values[:, :2].reshape(len(good), 6)
    return Row(road_class, speed, sensors.mean(axis=0), deviation(sensors), values[:, 2].mean(axis=0), status)


def read_table(path):
    """Return the RMS values (6,) of each (class, speed) in a CSV file like the paper's; lines with # are comments."""
    with open(path, newline="", encoding="utf-8") as file:
        lines = csv.DictReader(line for line in file if not line.startswith("#"))
        return {
            (line["road_class"], float(line["speed_mps"])): np.array([float(line[name] or "nan") for name in COLUMNS])
            for line in lines
        }


def table_csv(rows):
    """Return rows as the text of a CSV file that `read_table` reads, with status and scatter in further columns."""
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*_KEYS, *COLUMNS, "status", *(f"{name}_std" for name in COLUMNS)])
    for row in rows:
        rms, scatter = ([f"{x:.6g}" if np.isfinite(x) else "" for x in part] for part in (row.rms, row.scatter))
        writer.writerow([row.road_class, f"{row.speed:g}", *rms, row.status, *scatter])
    return text.getvalue()


def given(rows, paper):
    """Return our and the paper's values (n, 6) of the rows that both have."""
    pairs = [(row.rms, paper[key]) for row in rows if (key := (row.road_class, row.speed)) in paper]
    pairs = [pair for pair in pairs if np.isfinite(pair[0]).all()]
    return np.reshape(pairs, (-1, 2, 6)).swapaxes(0, 1)


def error_factor(ours, paper):
    """Return exp(rms(log(ours / paper))): the factor by which values are off, up or down."""
    return np.exp(np.sqrt(np.mean(np.square(np.log(ours / paper)))))


def column_bias(ours, paper):
    """Return the geometric mean of ours / paper of each column."""
    return np.exp(np.mean(np.log(ours / paper), axis=0))


def reduction(values, against=None):
    """Return by how many percent the powertrain's three values of (6,), or `against` (3,), lie below the chassis's."""
    return 100.0 * (1.0 - (values[3:] if against is None else against) / values[:3])
