"""A CSV file with time and three axes of one sensor, or of chassis and powertrain, as a recording."""

import os
from collections import Counter

import numpy as np
from mr_mount_controller.mounting import PAIR

from ..csv_columns import CsvError, read_columns
from ..numerics.units import NANO
from .errors import BagError
from .recording import Inertial, LoopCounts, Recording
from .sources import Origin, end_of_sensor

SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
GRAVITY = 9.80665  # m/s^2
ACCELERATIONS = {"m/s2": 1.0, "m/s^2": 1.0, "m/s²": 1.0, "g": GRAVITY, "mg": 1e-3 * GRAVITY}
_AXES = ("x", "y", "z")
_PAIR = ("chassis", "powertrain")
_COLUMNS = {sensor: tuple(f"{sensor}_{axis}" for axis in _AXES) for sensor in _PAIR}
UNITS = {
    "time": SECONDS,
    **dict.fromkeys((*_AXES, *(name for names in _COLUMNS.values() for name in names)), ACCELERATIONS),
}
LAYOUTS = (("time", *_COLUMNS["chassis"], *_COLUMNS["powertrain"]), ("time", *_AXES),
           *(("time", *names) for names in _COLUMNS.values()))  # fmt: skip
_MOST = 50_000_000  # samples
_LONGEST = 2.0**62 / NANO  # s, that a stamp can hold


def read_csv(path, sources, single="chassis", on_progress=lambda done: None):
    """Return `Inertial` and `Origin` by sensor of a CSV file.

    Parameters
    ----------
    path : path
    sources : Sources
        Its `csv_columns` tell what the file calls its columns.
    single : str
        Which sensor the axes are of that belong to none by their names.
    on_progress : callable
        Called from time to time with the number of bytes read.

    Raises
    ------
    BagError
        It cannot be read, or its times do not go on.
    """
    try:
        columns = read_columns(path, UNITS, LAYOUTS, (), _MOST, sources.csv_columns, on_progress)
    except CsvError as error:
        raise BagError(str(error)) from None
    except OSError as error:
        raise BagError(f"{str(path)!r} cannot be read: {error.strerror or error}") from None
    time = columns["time"]
    if len(time) < 2 or not np.abs(time).max() < _LONGEST:
        raise BagError(f"{str(path)!r} has {len(time)} times, at least two are needed, all of them finite")
    stamp = np.round(time * NANO).astype(np.int64)
    found = {}
    for sensor, names in ((single, _AXES), *_COLUMNS.items()):
        if names[0] in columns:
            force = np.column_stack([columns[name] for name in names])
            found[sensor] = Inertial(stamp, force), Origin(str(path), "CSV")
    return found


def csv_recording(path, sources, on_progress):
    """Return the `Recording` of a CSV file, and of those that `sources` name beside it; raises as `read_csv` does.

    `on_progress` is called from time to time with the number of bytes read and their total number.
    """
    sensors, done = {}, 0
    files = [("chassis", path), *sources.topics.items()]
    sizes = [_size(file) for _, file in files]
    for (name, file), size in zip(files, sizes, strict=True):
        sensors |= read_csv(file, sources, name, lambda read, before=done: on_progress(before + read, sum(sizes)))
        done += size
        on_progress(done, sum(sizes))
    return Recording(
        path=path,
        topics={end_of_sensor(name): origin.source for name, (_, origin) in sensors.items()},
        **pair_of({name: inertial for name, (inertial, _) in sensors.items()}),
        origins={name: origin for name, (_, origin) in sensors.items()},
        mounting=PAIR,
        **dict.fromkeys(("mounts", "answers", "odometry", "drive", "commands", "vehicle", "drive_file")),
        road=[],
        loop_counts=LoopCounts(*np.zeros((3, 0), np.int64)),
        diagnostics={},
        provenance={},
        counts=Counter({origin.source: len(inertial.stamp) for inertial, origin in sensors.values()}),
        complete=True,
    )


def _size(file):
    try:
        return os.stat(file).st_size
    except (OSError, ValueError):
        return 0  # reading it says what is wrong


def pair_of(sensors):
    """Return chassis, powertrain and the further ones of some `Inertial`s by sensor, as a `Recording` has them.

    One of the two that is not there has the other one's stamps, and no sample that is a number.
    """
    rest = dict(sensors)
    pair = [rest.pop(name, None) for name in _PAIR]
    there = next(each for each in (*pair, *rest.values()) if each is not None)
    nothing = Inertial(there.stamp, np.broadcast_to(np.nan, (len(there.stamp), 3)), logged=there.logged)
    chassis, powertrain = (nothing if each is None else each for each in pair)
    return {"chassis": chassis, "powertrain": powertrain, "sensors": rest}
