"""The one reader of numbers in CSV from outside: columns named with their units, checked line by line.

Lines that begin with # are comments; a semicolon or a tab may stand for the comma, and numbers then have a decimal
comma or point.
"""

import csv
from array import array
from io import TextIOWrapper
from itertools import islice

import numpy as np
from mr_mount_controller.node_base.plain_text import readable, shortened

from .ordinary_file import open_ordinary

METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "in": 0.0254, "ft": 0.3048}
_LARGEST = 2**30  # bytes
_LONGEST = 10_000  # characters of a line
_TOLD = 10_000  # lines, after which progress is told


class CsvError(ValueError):
    """A file that cannot be used; the message names it, the line or column and what is accepted."""


def read_columns(path, units, layouts, optional, most, called=None, on_progress=lambda done: None):
    """Return the columns (n,) of a CSV file by quantity, in the units whose factor is 1.

    Parameters
    ----------
    path : path
    units : dict
        Of each quantity its units: name -> factor. A column is called QUANTITY_UNIT.
    layouts : sequence of tuples
        Quantities of which one tuple must be there, the first that is counts.
    optional : tuple
        Quantities that may be there as well.
    most : int
        Lines of numbers that are accepted.
    called : mapping, optional
        Column as it would be called -> what the file calls it.
    on_progress : callable, optional
        Called from time to time with the number of bytes read.

    Raises
    ------
    CsvError
        The file cannot be used.
    OSError
        It cannot be read.
    """
    name = readable(str(path))
    try:
        with open_ordinary(path, _LARGEST) as file, TextIOWrapper(file, encoding="utf-8-sig", newline="") as text:
            tell = lambda: on_progress(file.tell())  # noqa: E731
            return _read(text, name, units, layouts, optional, most, called or {}, tell)
    except UnicodeDecodeError as error:
        raise CsvError(f"{name} is not UTF-8 text: it has a byte 0x{error.object[error.start]:02x}") from None
    except csv.Error as error:  # NUL, for older versions of Python
        raise CsvError(f"{name} is not a CSV file: {error}") from None


def _read(file, name, units, layouts, optional, most, called, tell):
    lines = _lines(file, name)
    number, head = next(lines, (0, ""))
    if not head:
        example = ",".join(f"{quantity}_{next(iter(units[quantity]))}" for quantity in layouts[0])
        raise CsvError(f"{name} is empty, its first line must name the columns, like {example}")
    delimiter = next((sign for sign in (";", "\t", ",") if sign in head), ",")
    columns = [column.strip().lower() for column in next(csv.reader([head], delimiter=delimiter))]
    own = {theirs.strip().lower(): ours.lower() for ours, theirs in called.items()}
    for theirs in own.keys() - set(columns):
        told = ", ".join(readable(shortened(column)) for column in islice(columns, 10))
        raise CsvError(f"{name} has no column {readable(shortened(theirs))}, it has {told}")
    columns = [own.get(column, column) for column in columns]
    found = _columns(columns, name, units, layouts, optional)
    places = [place for place, _ in found.values()]
    numbers = array("d")
    for number, line in lines:
        cells = next(csv.reader([line], delimiter=delimiter))
        try:
            if any(cell.strip() for cell in cells[len(columns) :]):  # as decimal commas between commas make them
                raise ValueError
            numbers.extend([_number(cells[place], delimiter) for place in places])
        except (ValueError, IndexError):
            shown = readable(shortened(line))
            raise CsvError(f"{name}, line {number}: {shown!r}, accepted: {len(columns)} numbers") from None
        if number % _TOLD == 0:
            tell()
        if len(numbers) > most * len(places):
            raise CsvError(f"{name}: more than {most} samples")
    rows = np.frombuffer(numbers).reshape(-1, len(places)).T
    with np.errstate(over="ignore"):  # what is infinite is refused by whoever knows the quantity
        return {quantity: row * factor for row, (quantity, (_, factor)) in zip(rows, found.items(), strict=True)}


def _number(cell, delimiter):
    """Return a cell's number; a decimal comma is one where columns are not told apart by commas."""
    return float(cell if delimiter == "," else cell.replace(",", "."))


def _lines(file, name):
    """Yield number and text of each line that says something."""
    number = 0
    while line := file.readline(_LONGEST + 1):
        number += 1
        if len(line) > _LONGEST:
            raise CsvError(f"{name}, line {number}: more than {_LONGEST} characters")
        if line.strip() and not line.lstrip().startswith("#"):
            yield number, line.rstrip("\r\n")


def _columns(columns, name, units, layouts, optional):
    """Return by quantity which column is read and the factor of its unit."""
    found = {}
    for place, column in enumerate(columns):
        quantity, _, unit = column.rpartition("_")
        if unit in units.get(quantity, ()):
            if quantity in found:
                raise CsvError(f"{name}: two columns are named {quantity}, must be one")
            found[quantity] = place, units[quantity][unit]
    for names in layouts:
        if all(each in found for each in names):
            return {each: found[each] for each in (*names, *(other for other in optional if other in found))}
    accepted = " or ".join(",".join(f"{each}_UNIT" for each in names) for names in layouts)
    known = list(dict.fromkeys(unit for names in layouts for each in names for unit in units[each]))
    told = ", ".join(readable(shortened(column)) for column in islice(columns, 10))
    raise CsvError(f"{name} has the columns {told}; accepted: {accepted}, UNIT being one of {', '.join(known)}")
