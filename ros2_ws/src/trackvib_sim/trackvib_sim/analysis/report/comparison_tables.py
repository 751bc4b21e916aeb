"""Tables that set the numbers of several bags beside the first one's; see `tables`."""

from math import isclose, isfinite, nan

from ..numbers import AXES, SENSORS
from .tables import MOUNT, UNITS, WORDS, Table, change, number

_PLACES = [(sensor, axis) for sensor in reversed(SENSORS) for axis in AXES]


def accelerations(analyses, names):
    """Numbers of both sensors: a table a quantity, and one of the absorbed power."""
    power = [(sensor, [analysis.absorbed_power[sensor] for analysis in analyses]) for sensor in reversed(SENSORS)]
    found = [_accelerations(analyses, names, quantity) for quantity in WORDS]
    return [*found, _compared("absorbed power, vertical z, W", power, names)]


def _accelerations(analyses, names, quantity):
    title, difference = f"{WORDS[quantity]}, {UNITS[quantity]}".removesuffix(", -"), change
    rows = [
        (f"{sensor} {axis}", [getattr(analysis.sensors[sensor][axis], quantity) for analysis in analyses])
        for sensor, axis in _PLACES
    ]
    if quantity == "rms_weighted":
        for sensor in reversed(SENSORS):
            rows.append((f"{sensor}, all axes", [analysis.total_weighted[sensor] for analysis in analyses]))
    elif quantity == "mean":
        difference = _offset  # per cent of next to nothing tell nothing
    elif quantity == "vdv" and not all(isclose(each.measured, analyses[0].measured) for each in analyses):
        title += ", grows with time"
        names = [f"{name}, over {each.measured:.4g} s" for name, each in zip(names, analyses, strict=True)]
    return _compared(title, rows, names, difference)


def lines(analyses, names):
    """Levels about lines of the spectrum: a table a line that any of the bags has."""
    found = [{line.name: line for line in analysis.lines} for analysis in analyses]
    tables = []
    for name in dict.fromkeys(name for each in found for name in each):
        of_bags = [each.get(name) for each in found]
        rows = [("frequency, Hz", [line.frequency if line else nan for line in of_bags])]
        for sensor, axis in _PLACES:
            rows.append((f"{sensor} {axis}", [line.rms[sensor][axis] if line else nan for line in of_bags]))
        tables.append(_compared(name, rows, names))
    return tables


def mounts(analyses, names):
    """Numbers of the mounts: a table a mount."""
    tables = []
    for name in dict.fromkeys(name for analysis in analyses for name in analysis.mounts):
        found = [analysis.mounts.get(name) for analysis in analyses]
        rows = [
            (f"{words}, {unit}", [of(mount) if mount else nan for mount in found])
            for words, unit, of in MOUNT
            if unit != "J"  # grows with time; the mean power can be compared
        ]
        tables.append(_compared(f"{name} mount, vertical", rows, names))
    return tables


def _compared(title, rows, names, difference=change):
    """Return a table of rows (words, numbers), those left out of which there are no numbers."""
    cells = [
        (words, number(values[0]), *(_beside(value, difference(value, values[0])) for value in values[1:]))
        for words, values in rows
        if any(map(isfinite, values))
    ]
    return Table((title, *names), cells)


def _beside(value, difference):
    return number(value) if difference == "–" else f"{number(value)} ({difference})"


def _offset(value, first):
    return f"{value - first:+.3f}".replace("-", "−") if isfinite(value - first) else "–"
