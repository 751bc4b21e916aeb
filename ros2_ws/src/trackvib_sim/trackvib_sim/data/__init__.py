"""The files that come with the package: vehicle, calibration plan, part of the paper's table."""

from importlib.resources import files
from pathlib import Path


def default_vehicle_file() -> Path:
    """Return the path of the vehicle that comes with the package.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.default_vehicle_file().name
    'vehicle.yaml'
    """
    return _path("vehicle.yaml")


def calibration_plan_file() -> Path:
    """Return the path of the calibration plan that comes with the package."""
    return _path("calibration.yaml")


def paper_table_file() -> Path:
    """Return the path of the part of [Tao2025]'s Table 1 that the studies compare with."""
    return _path("table1_part.csv")


def _path(name):
    return Path(str(files(__package__) / name))
