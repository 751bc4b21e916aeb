"""The files that come with the package: vehicles, calibration plan, part of the paper's table, the M113's histories."""

from importlib.resources import files
from pathlib import Path

DEFAULT_VEHICLE = "tao2025"


def vehicle_names() -> list[str]:
    """Return the names of the included vehicles, the default one first.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.vehicle_names()[0]
    'tao2025'
    """
    names = sorted(path.stem for path in _path("vehicles").glob("*.yaml"))
    return sorted(names, key=lambda name: name != DEFAULT_VEHICLE)


def find_vehicle(name: str | Path | None = None) -> Path:
    """Return the path of an included vehicle by its name, or a given path unchanged.

    Without a name it is the path of the default vehicle. A text with a folder or an extension is a file, even if a
    vehicle has the same name.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.find_vehicle().name, tv.find_vehicle("my_own.yaml").name
    ('tao2025.yaml', 'my_own.yaml')
    """
    name = str(name or DEFAULT_VEHICLE)
    return _path(f"vehicles/{name}.yaml") if name in vehicle_names() else Path(name)


def calibration_plan_file() -> Path:
    """Return the path of the calibration plan that comes with the package."""
    return _path("calibration.yaml")


def left_out_file() -> Path:
    """Return the path of the values that calibrations without one road class found, by that class."""
    return _path("left_out.yaml")


def paper_table_file() -> Path:
    """Return the path of the part of [Tao2025]'s Table 1 that the studies compare with."""
    return _path("table1_part.csv")


def m113_histories_file() -> Path:
    """Return the path of the histories of the M113 in Project Chrono that `study m113` compares with."""
    return _path("m113/histories.csv.gz")


def m113_standing_file() -> Path:
    """Return the path of the third octaves of the M113 in Project Chrono that stands."""
    return _path("m113/standing.csv")


def _path(name):
    return Path(str(files(__package__) / name))
