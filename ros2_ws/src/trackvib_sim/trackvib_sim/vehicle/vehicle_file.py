"""Reads a vehicle file, and says in one sentence an item what is wrong with it."""

from os.path import exists
from pathlib import Path

from mr_mount_controller.node_base.suggestion import suggestion

from ..data import vehicle_names
from ..yaml_text import YamlTextError, read_text, validated
from .parameters import Vehicle

# where pydantic puts the word for a body's hinge or a mount's kind among the names of its items
_KINDS = {"bodies": 2, "powertrain": 1, "mount_types": 2}


class VehicleFileError(ValueError):
    """A vehicle file that cannot be used; the message names file, item, value and what is accepted.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.read_vehicle("nowhere.yaml")
    Traceback (most recent call last):
    trackvib_sim.vehicle.vehicle_file.VehicleFileError: vehicle file 'nowhere.yaml' cannot be read: ...
    """


def parse_vehicle(text: str, name: str) -> Vehicle:
    """Return the `Vehicle` that a YAML text describes.

    Raises
    ------
    VehicleFileError
        The text is not YAML, or an item is missing, unknown, in the wrong unit or out of range.
    """
    try:
        return validated(Vehicle, text, name, _KINDS)
    except YamlTextError as error:
        raise VehicleFileError(str(error)) from None


def read_vehicle(path: str | Path) -> tuple[Vehicle, str]:
    """Return the `Vehicle` in a YAML file and the file's text.

    Raises
    ------
    VehicleFileError
        The file cannot be read, or as in `parse_vehicle`.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, text = tv.read_vehicle(tv.find_vehicle())
    >>> vehicle.tracks.links, vehicle.tracks.pitch  # left and right, m
    ([120.0, 120.0], 0.115)
    """
    try:
        text = read_text(path, "vehicle file")
    except YamlTextError as error:
        names = vehicle_names()
        known = f"; vehicles known by name are {', '.join(names)}{suggestion(Path(path).name, names)}"
        by_name = "" if exists(path) else known
        raise VehicleFileError(f"{error}{by_name}") from None
    return parse_vehicle(text, str(path)), text
