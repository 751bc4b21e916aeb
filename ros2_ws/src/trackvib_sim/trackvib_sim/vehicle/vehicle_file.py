"""Reads a vehicle file, and says in one sentence an item what is wrong with it."""

from pathlib import Path

import yaml
from pydantic import ValidationError

from .parameters import Vehicle


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
        return Vehicle.model_validate(load_vehicle(text, name))
    except ValidationError as error:
        raise VehicleFileError("\n".join(_sentence(name, each) for each in error.errors())) from None


def load_vehicle(text, name):
    """Return what a YAML text holds, as it stands.

    Raises
    ------
    VehicleFileError
        It is not YAML, is nested beyond all measure, or has aliases, of which a small text can make a huge one.
    """
    try:
        return yaml.load(text, _Loader)  # noqa: S506, a safe one
    # all but the first from tagged values that PyYAML does not check: impossible dates, `!!bool x`, `!!int ''`
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, OverflowError) as error:
        raise VehicleFileError(f"{name}: not a YAML file: {error}") from None
    except RecursionError:
        raise VehicleFileError(f"{name}: not a vehicle file: nested too deeply") from None


class _Loader(yaml.SafeLoader):
    """PyYAML's safe one, but without aliases."""

    def compose_node(self, parent, index):
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError(f"alias *{self.peek_event().anchor} is not accepted, write it out")
        return super().compose_node(parent, index)


def read_vehicle(path: str | Path) -> tuple[Vehicle, str]:
    """Return the `Vehicle` in a YAML file and the file's text.

    Raises
    ------
    VehicleFileError
        The file cannot be read, or as in `parse_vehicle`.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, text = tv.read_vehicle(tv.default_vehicle_file())
    >>> vehicle.tracks.links, vehicle.tracks.pitch  # a side, m
    (120.0, 0.115)
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise VehicleFileError(f"vehicle file {str(path)!r} cannot be read: {error}") from None
    return parse_vehicle(text, str(path)), text


def _sentence(name, error):
    item = ".".join(str(part) for part in error["loc"])
    reason = error["msg"].removeprefix("Value error, ")
    if error["type"] in ("model_type", "model_attributes_type"):
        return f"{name}: {item or 'the whole file'} is {error['input']!r}: must be a section with items"
    if error["type"] in ("missing", "value_error"):
        return f"{name}: {item}: {reason}" if item else f"{name}: {reason}"
    return f"{name}: {item} is {error['input']!r}: {reason}"
