"""Measured loops of a mount, as a CSV file has them."""

import csv
from io import TextIOWrapper
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.plain_text import readable

from ..ordinary_file import open_ordinary

COLUMNS = ("time_s", "displacement_m", "force_N", "current_A")
LARGEST = 200_000_000  # bytes
MOST_LOOPS, FEWEST_ROWS = 500, 20


class LoopsFileError(ValueError):
    """The file cannot be used; the message names line, value and what is accepted."""


class MeasuredLoop(NamedTuple):
    """Rows of one current, in the order of time."""

    current: float  # A
    time: np.ndarray  # (n,) s
    displacement: np.ndarray  # (n,) m
    velocity: np.ndarray  # (n,) m/s, from the displacement
    force: np.ndarray  # (n,) N, against the displacement


def read_loops(path):
    """Return the `MeasuredLoop`s of a file: a new one begins where the current changes or time goes back.

    Raises
    ------
    LoopsFileError
        It cannot be read, is no ordinary file, or no CSV file with `COLUMNS` in its first line, or a row has other than
        finite numbers; a loop is short, stands still, or its time does not rise.
    """
    name = readable(str(path))
    try:
        with open_ordinary(path, LARGEST) as file, _text(file) as text:
            return _loops(list(_rows(csv.reader(text))))
    except LoopsFileError as error:
        raise LoopsFileError(f"{name}: {error}") from None
    except csv.Error as error:
        raise LoopsFileError(f"{name} is not a CSV file: {error}") from None
    except OSError as error:
        raise LoopsFileError(f"{name} cannot be read: {error.strerror or error}") from None


def _text(file):
    return TextIOWrapper(file, encoding="utf-8", errors="replace", newline="")


def _loops(rows):
    values = np.array(rows).reshape(-1, len(COLUMNS))
    begins = np.flatnonzero((np.diff(values[:, 3]) != 0.0) | (np.diff(values[:, 0]) < 0.0)) + 1
    if len(begins) >= MOST_LOOPS:
        raise LoopsFileError(f"has {len(begins) + 1} loops, accepted: {MOST_LOOPS}: the current changes too often")
    return [_loop(part) for part in np.split(values, begins)]


def _rows(lines):
    head = [name.strip() for name in next(lines, [])]
    for name in COLUMNS:
        if head.count(name) != 1:
            raise LoopsFileError(f"line 1: must name the column {name} once; the columns are {', '.join(COLUMNS)}")
    places = [head.index(name) for name in COLUMNS]
    for number, line in enumerate(lines, 2):
        if not line:
            continue
        try:
            row = [float(line[place]) for place in places]
        except (ValueError, IndexError):
            raise LoopsFileError(f"line {number}: must have a number in each of {', '.join(COLUMNS)}") from None
        if not np.isfinite(row).all():
            raise LoopsFileError(f"line {number}: has {row}, accepted: finite numbers")
        yield row


def _loop(rows):
    time, displacement, force, current = rows.T
    if len(rows) < FEWEST_ROWS:
        raise LoopsFileError(f"the loop at {current[:1]} A has {len(rows)} rows, accepted: {FEWEST_ROWS} or more")
    if not (np.diff(time) > 0.0).all():
        raise LoopsFileError(f"the loop at {current[0]:g} A: time_s must rise from row to row")
    if not np.ptp(displacement) > 0.0:
        raise LoopsFileError(f"the loop at {current[0]:g} A: displacement_m must move")
    return MeasuredLoop(current[0], time, displacement, np.gradient(displacement, time), force)
