"""Road profiles as CSV: a column of distances and one or two of heights, with their units in the names.

    distance_m,left_m,right_m          or          distance_m,height_mm

Units are m, cm, mm, km, in and ft. Lines that begin with # are comments; a semicolon or a tab may stand for the comma.
"""

import csv
from array import array
from io import TextIOWrapper
from itertools import islice
from pathlib import Path

import numpy as np
from mr_mount_controller.node_base.plain_text import readable, shortened

from ..ordinary_file import open_ordinary
from ..road.profile import MOST, ProfileError, checked

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "in": 0.0254, "ft": 0.3048}  # m
COLUMNS = (("distance", "left", "right"), ("distance", "height"))
_LARGEST = 2**30  # bytes
_LONGEST = 10_000  # characters of a line


def read_csv_profile(path):
    """Return the `profile.Profile` in a CSV file.

    Raises
    ------
    ProfileError
        The file cannot be used; the message names it, the line or column and what is accepted.
    OSError
        It cannot be read.
    """
    name = readable(str(path))
    try:
        with open_ordinary(path, _LARGEST) as file, TextIOWrapper(file, encoding="utf-8-sig", newline="") as text:
            return _read(text, name)
    except UnicodeDecodeError as error:
        raise ProfileError(f"{name} is no text in UTF-8: it has a byte 0x{error.object[error.start]:02x}") from None
    except csv.Error as error:  # NUL, for older versions of Python
        raise ProfileError(f"{name} is no CSV file: {error}") from None


def write_csv_profile(path, distance, heights):
    """Write a profile of a distance (n,) and heights (2, n) [m]; every number comes back to the last bit."""
    with Path(path).open("w", encoding="utf-8") as file:
        file.write("distance_m,left_m,right_m\n")
        for values in zip(distance, *heights, strict=True):
            file.write(",".join(repr(float(value)) for value in values) + "\n")


def _read(file, name):
    lines = _lines(file, name)
    number, head = next(lines, (0, ""))
    if not head:
        raise ProfileError(f"{name} is empty, its first line must name the columns, like distance_m,left_m,right_m")
    delimiter = next((sign for sign in (",", ";", "\t") if sign in head), ",")
    columns = [column.strip().lower() for column in next(csv.reader([head], delimiter=delimiter))]
    wanted, factors = _columns(columns, name)
    numbers = array("d")
    for number, line in lines:
        cells = next(csv.reader([line], delimiter=delimiter))
        try:
            numbers.extend([float(cells[k]) for k in wanted])
        except (ValueError, IndexError):
            shown = readable(shortened(line))
            raise ProfileError(f"{name}, line {number}: {shown!r}, accepted are {len(columns)} numbers") from None
        if len(numbers) > MOST * len(wanted):
            raise ProfileError(f"{name}: more than {MOST} samples")
    with np.errstate(over="ignore"):  # what is infinite is refused
        values = np.frombuffer(numbers).reshape(-1, len(wanted)).T * np.array(factors)[:, None]
    return checked(values[0], values[[1, -1]], name)


def _lines(file, name):
    """Yield number and text of each line that says something."""
    number = 0
    while line := file.readline(_LONGEST + 1):
        number += 1
        if len(line) > _LONGEST:
            raise ProfileError(f"{name}, line {number}: more than {_LONGEST} characters")
        if line.strip() and not line.lstrip().startswith("#"):
            yield number, line.rstrip("\r\n")


def _columns(columns, name):
    """Return which columns are read and what turns their units into metres."""
    found = {}
    for k, column in enumerate(columns):
        quantity, _, unit = column.rpartition("_")
        if unit in UNITS and quantity in {each for names in COLUMNS for each in names}:
            if quantity in found:
                raise ProfileError(f"{name}: two columns are called {quantity}, accepted is one")
            found[quantity] = k, UNITS[unit]
    for names in COLUMNS:
        if all(each in found for each in names):
            return zip(*(found[each] for each in names), strict=True)
    accepted = " or ".join(",".join(f"{each}_UNIT" for each in names) for names in COLUMNS)
    told = ", ".join(readable(shortened(column)) for column in islice(columns, 10))
    raise ProfileError(f"{name} has the columns {told}; accepted are {accepted}, UNIT being one of {', '.join(UNITS)}")
