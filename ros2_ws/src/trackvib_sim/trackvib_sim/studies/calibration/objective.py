"""How far a vehicle is from its targets, the paper's table and a running resistance: the number to be made small."""

import numpy as np

from ..case import GOOD, Case
from ..paper.paper_table import COLUMNS, PAPER_AXES, SENSORS
from ..resistance.case import ResistanceCase

FIRST_SEED = 1001  # of roads; `study table1`, which checks the result, has others
HIGHEST_SPEED = 25.0  # m/s, at which tracks must still mesh
FAILED = 2.0  # what every value of a row with a failed run counts as: log of its ratio


def cases(rows, seeds):
    """Return the cases of one candidate: `seeds` runs of each row (class, speed), one row after the other.

    Each run of a row has its own road and its own track phase; phases p and 1 - p are mirror images of each other, so
    that half of all phases are covered evenly.
    """
    return [
        Case(road_class, speed, FIRST_SEED + k, (k + 0.5) / (2.0 * seeds))
        for road_class, speed in rows
        for k in range(seeds)
    ]


def level_speeds(rows):
    """Return the speeds [m/s] of runs on level ground: those of the rows (class, speed), and the end of valid range."""
    return sorted({speed for _, speed in rows} | {HIGHEST_SPEED})


def level_cases(rows):
    """Return the cases on level ground of one candidate: one for each of the `level_speeds`."""
    return [ResistanceCase(speed) for speed in level_speeds(rows)]


def ratios(results, paper):
    """Return ours over the paper's and the scatter of ours.

    Parameters
    ----------
    results : sequence of drive.Result
        In the order of `cases`.
    paper : dict
        (class, speed) -> values (6,), as `paper_table.read_table` gives it; the rows of the cases.

    Returns
    -------
    ratios : ndarray (rows, 6)
        Root mean squares over the runs of a row over the paper's values; nan in rows with a failed run.
    scatter : float
        Typical standard error of log(ratio), from the scatter among the runs of a row; nan if there is none.
    """
    levels = np.array([_levels(result) for result in results]).reshape(len(paper), -1, len(COLUMNS))
    ours = np.sqrt(np.mean(np.square(levels), axis=1))
    seeds = levels.shape[1]
    spread = np.log(levels[np.isfinite(ours).all(axis=1)])
    scatter = np.sqrt(spread.var(axis=1, ddof=1).mean() / seeds) if seeds > 1 and spread.size else np.nan
    return ours / np.array(list(paper.values())), float(scatter)


def objective(ratios, resistance):
    """Return the objective of ratios (rows, 6) and of the running resistance over each end of its range (speeds, 2).

    It is rms(log(ratio)) of the table plus the root mean square of how far the resistance lies outside its range, as a
    logarithm: a part of the one counts as much as the same part of the other. Both are `FAILED` where a run failed.
    """
    logs = np.log(ratios)
    logs[~np.isfinite(logs).all(axis=1)] = FAILED
    outside = resistance_outside(resistance)
    outside[~np.isfinite(outside)] = FAILED
    return float(np.sqrt(np.mean(np.square(logs))) + np.sqrt(np.mean(np.square(outside))))


def resistance_outside(resistance):
    """Return by how much, as a logarithm, a resistance over each end of its range (..., 2) lies outside that range."""
    over_low, over_high = np.log(np.moveaxis(np.asarray(resistance), -1, 0))
    return np.maximum(0.0, np.maximum(-over_low, over_high))


def typical_excess(resistance):
    """Return the geometric mean over the speeds of a resistance (speeds, 2) over the high end of its range."""
    return float(np.exp(np.log(resistance[:, 1]).mean()))


def _levels(result):
    if result.status != GOOD:
        return np.full(len(COLUMNS), np.nan)
    return np.array([result.rms[sensor] for sensor in SENSORS])[:, PAPER_AXES].ravel()
