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
    """Write `numbers.json`, `numbers.csv`, `spectra.parquet` and `history.parquet` of some `Analysis`es to a folder."""
    document = {"units": UNITS, "bags": [_plain(analysis) for analysis in analyses]}
    text = json.dumps(_without_nan(document), indent=2, allow_nan=False, ensure_ascii=False)
    (folder / "numbers.json").write_text(text + "\n", encoding="utf-8")
    found = [row for analysis in analyses for row in rows(analysis)]
    columns = [pa.array(column, from_pandas=True) for column in zip(*found, strict=True)]  # nan becomes an empty cell
    csv.write_csv(pa.table(dict(zip(COLUMNS, columns, strict=True))), folder / "numbers.csv")
    for name, columns_of in (("spectra", spectra_columns), ("history", history_columns)):
        tables = [_table(analysis.bag, columns_of(analysis)) for analysis in analyses]
        # bags may differ in their mounts
        parquet.write_table(pa.concat_tables(tables, promote_options="default"), folder / f"{name}.parquet")


def rows(analysis):
    """Iterate over the single numbers of an `Analysis` as (bag, part, axis, quantity, value, unit)."""
    bag = analysis.bag
    yield from _of(bag, "run", "", analysis)
    for sensor, axes in analysis.sensors.items():
        for axis, of_axis in axes.items():
            yield from _of(bag, sensor, axis, of_axis)
        yield bag, sensor, "", "total_weighted", analysis.total_weighted[sensor], UNITS["Analysis"]["total_weighted"]
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
    for name in ("current", "power_dissipated", "travel"):
        columns |= _by(history.mounts, name, getattr(history, name), units[name])
    return columns


def _by(parts, name, values, unit):
    return {f"{name}_{part}": (values[:, k], unit) for k, part in enumerate(parts[: values.shape[1]])}


def _table(bag, columns):
    count = len(next(iter(columns.values()))[0])
    arrays = {"bag": pa.array([bag] * count)}
    arrays |= {name: pa.array(np.ascontiguousarray(values)) for name, (values, _) in columns.items()}
    units = {name: {"unit": unit} for name, (_, unit) in columns.items()}
    schema = pa.schema([pa.field(name, array.type, metadata=units.get(name)) for name, array in arrays.items()])
    return pa.table(list(arrays.values()), schema)


def _plain(analysis):
    document = asdict(replace(analysis, spectra=None, history=None))  # these lie in the Parquet files
    del document["spectra"], document["history"]
    return document


def _without_nan(value):
    """The same with null, which JSON has, for nan and infinities, which it has not."""
    if isinstance(value, dict):
        return {key: _without_nan(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(each) for each in value]
    return None if isinstance(value, float) and not isfinite(value) else value
