"""The numbers of bags as files: JSON, CSV and Parquet. Quantities are called as in `numbers`."""

import json
from dataclasses import asdict, fields, replace
from math import isfinite

import numpy as np
import pyarrow as pa
from pyarrow import csv, parquet

from . import numbers
from .numbers import AXES, SENSORS

COLUMNS = ("bag", "part", "axis", "quantity", "value", "unit")
# of the fields of each kind of record
UNITS = {
    kind.__name__: {field.name: field.metadata["unit"] for field in fields(kind) if "unit" in field.metadata}
    for kind in vars(numbers).values()
    if isinstance(kind, type)
}


def write_tables(analyses, folder):
    """Write the tables of some `Analysis`es to a folder; those of which no bag has anything are left out."""
    document = {"units": UNITS, "bags": [_plain(analysis) for analysis in analyses]}
    text = json.dumps(_without_nan(document), indent=2, allow_nan=False, ensure_ascii=False)
    (folder / "numbers.json").write_text(text + "\n", encoding="utf-8")
    found = [row for analysis in analyses for row in rows(analysis)]
    columns = [pa.array(column, from_pandas=True) for column in zip(*found, strict=True)]  # nan becomes an empty cell
    csv.write_csv(pa.table(dict(zip(COLUMNS, columns, strict=True))), folder / "numbers.csv")
    for name, columns_of in _FILES.items():
        text = name.endswith(".csv")
        tables = [_table(analysis.bag, columns, text) for analysis in analyses if (columns := columns_of(analysis))]
        if tables:
            # bags may differ in their mounts and sensors
            table = pa.concat_tables(tables, promote_options="default")
            (csv.write_csv if text else parquet.write_table)(table, folder / name)


def rows(analysis):
    """Iterate over the single numbers of an `Analysis` as (bag, part, axis, quantity, value, unit)."""
    bag = analysis.bag
    yield from _of(bag, "run", "", analysis)
    for sensor, axes in analysis.sensors.items():
        for axis, of_axis in axes.items():
            yield from _of(bag, sensor, axis, of_axis)
        for name in ("total_weighted", "absorbed_power"):
            yield bag, sensor, "", name, getattr(analysis, name)[sensor], UNITS["Analysis"][name]
    for sensor, motion in analysis.motion_sickness.items():
        yield from _of(bag, sensor, "z", motion, "motion_sickness_")
    for line in analysis.lines:
        yield bag, "run", "", f"frequency of {line.name}", line.frequency, UNITS["Line"]["frequency"]
        for sensor, axes in line.rms.items():
            for axis, level in axes.items():
                yield bag, sensor, axis, f"rms of {line.name}", level, UNITS["Line"]["rms"]
    for name, mount in analysis.mounts.items():
        for axis, of_axis in mount.axes.items():
            yield from _of(bag, f"{name} mount", axis, of_axis)
        yield from _of(bag, f"{name} mount", "", mount)
        yield from _of(bag, f"{name} mount", "", mount.current, "current_")
    for name, current in analysis.demand.items():
        yield from _of(bag, f"{name} demand", "", current, "current_")
    for part, energy in (analysis.mount_energy or {}).items():
        yield bag, "mounts", "", f"{part}_by_simulator", energy, UNITS["Analysis"]["mount_energy"]
    for name, count in analysis.loop.items():
        if isinstance(count, int):
            yield bag, "loop", "", name, float(count), "-"
    for end, timing in analysis.timing.items():
        yield from _of(bag, end, "", timing)


def _of(bag, part, axis, numbers, prefix=""):
    """The fields of a dataclass that are single numbers with a unit."""
    for field in fields(numbers):
        value = getattr(numbers, field.name)
        if "unit" in field.metadata and isinstance(value, (int, float)):
            yield bag, part, axis, f"{prefix}{field.name}", float(value), field.metadata["unit"]


def spectra_columns(analysis):
    """Return columns and units by name of the spectra."""
    spectra, units = analysis.spectra, UNITS["Spectra"]
    columns = {"frequency": (spectra.frequency, units["frequency"])}
    for sensor in SENSORS:
        columns |= _by(AXES, f"{sensor}_psd", spectra.psd[sensor], units["psd"])
    for name in ("coherence", "transmissibility"):
        columns |= _by(AXES, name, getattr(spectra, name), units[name])
    return columns


def history_columns(analysis):
    """Return columns and units by name of the levels along the bag."""
    history, units = analysis.history, UNITS["History"]
    columns = {name: (getattr(history, name), units[name]) for name in ("time", "speed")}
    for sensor in SENSORS:
        for name in ("rms", "rms_weighted"):
            columns |= _by(AXES, f"{sensor}_{name}", getattr(history, name)[sensor], units[name])
        columns[f"{sensor}_absorbed_power"] = history.absorbed_power[sensor], units["absorbed_power"]
    for name in ("current", "power_dissipated", "travel"):
        columns |= _by(history.mounts, name, getattr(history, name), units[name])
    return columns


def records_columns(records):
    """Return columns and units by name of records of one kind, a row a record; of a dict a column an entry."""
    rows = [{name: cell for field in fields(record) for name, cell in _cells(record, field)} for record in records]
    return {name: (np.array([row[name][0] for row in rows]), unit) for name, (_, unit) in (rows or [{}])[0].items()}


def _cells(record, field):
    """Iterate over name and (number, unit) of a field: of itself, by sensor, or by sensor and axis."""
    value, unit = getattr(record, field.name), field.metadata["unit"]
    if not isinstance(value, dict):
        yield field.name, (value, unit)
        return
    for sensor, of_sensor in value.items():
        name = f"{sensor}_{field.name}"
        if isinstance(of_sensor, dict):
            yield from ((f"{name}_{axis}", (number, unit)) for axis, number in of_sensor.items())
        else:
            yield name, (of_sensor, unit)


def order_columns(analysis):
    """Return columns and units by name of the spectra over revolutions, a row an engine speed and order."""
    spectra, units = analysis.order_spectra, UNITS["OrderSpectra"]
    if spectra is None:
        return {}
    shape = len(spectra.engine_speed), len(spectra.order)
    columns = {
        "engine_speed": (np.repeat(spectra.engine_speed, shape[1]), units["engine_speed"]),
        "order": (np.tile(spectra.order, shape[0]), units["order"]),
    }
    for sensor, psd in spectra.psd.items():
        columns |= _by(AXES, f"{sensor}_psd", psd.reshape(-1, len(AXES)), units["psd"])
    return columns


def campbell_columns(diagram):
    """Return columns and units by name of a `Campbell`, a row a speed and frequency."""
    shape, units = (len(diagram.value), len(diagram.frequency)), UNITS["Campbell"]
    return {
        diagram.over.replace(" ", "_"): (np.repeat(diagram.value, shape[1]), diagram.unit),
        "frequency": (np.tile(diagram.frequency, shape[0]), units["frequency"]),
    } | {f"{sensor}_psd_z": (psd.ravel(), units["psd"]) for sensor, psd in diagram.psd.items()}


def _campbell_over(over):
    return lambda analysis: next((campbell_columns(each) for each in analysis.campbell if each.over == over), {})


def _by(parts, name, values, unit):
    return {f"{name}_{part}": (values[:, k], unit) for k, part in enumerate(parts[: values.shape[1]])}


def _table(bag, columns, empty):
    """The columns of one bag; with `empty` nan becomes an empty cell."""
    count = len(next(iter(columns.values()))[0])
    arrays = {"bag": pa.array([bag] * count)}
    arrays |= {name: pa.array(np.ascontiguousarray(values), from_pandas=empty) for name, (values, _) in columns.items()}
    units = {name: {"unit": unit} for name, (_, unit) in columns.items()}
    schema = pa.schema([pa.field(name, array.type, metadata=units.get(name)) for name, array in arrays.items()])
    return pa.table(list(arrays.values()), schema)


def _plain(analysis):
    document = asdict(replace(analysis, spectra=None, history=None, order_spectra=None, campbell=()))
    for name in ("spectra", "history", "order_spectra", "campbell"):  # these lie in the Parquet files
        del document[name]
    return document


def _without_nan(value):
    """The same with null, which JSON has, for nan and infinities, which it has not."""
    if isinstance(value, dict):
        return {key: _without_nan(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value


_FILES = {  # file -> what its columns are of an `Analysis`
    "spectra.parquet": spectra_columns,
    "history.parquet": history_columns,
    "by_way.csv": lambda analysis: records_columns(analysis.by_way),
    "by_speed.csv": lambda analysis: records_columns(analysis.by_speed),
    "order_levels.csv": lambda analysis: records_columns(analysis.order_levels),
    "order_spectra.parquet": order_columns,
    "campbell_engine_speed.parquet": _campbell_over("engine speed"),
    "campbell_speed.parquet": _campbell_over("speed"),
}
