"""Messages as text, and requests from text."""

import array
import re

import numpy as np
import yaml

from environment.ros2_stand_in.session import interface
from environment.ros2_stand_in.terminal import Failure

_SEQUENCE = re.compile(r"(?:sequence<(.+?)(?:, \d+)?>|(.+)\[\d+\])")
_PART = re.compile(r"([A-Za-z]\w*)((?:\[-?\d+\])*)")


def part_of(message, path):
    """Return a part of a message by a path such as `twist.linear.x` or `values[0]`; raises `Failure`."""
    for step in path.split("."):
        match = _PART.fullmatch(step)
        if not match or not _is_message(message) or match[1] not in message.get_fields_and_field_types():
            raise Failure(f"Invalid field '{path}': {step!r} is not a field of {type(message).__name__}")
        message = getattr(message, match[1])
        for index in re.findall(r"-?\d+", match[2]):
            try:
                message = message[int(index)]
            except (IndexError, TypeError):
                raise Failure(f"Invalid field '{path}': there is no [{index}]") from None
    return message


def plain(value, longest=None, no_arr=False, no_str=False, kind=""):
    """Return a message or a part of it as what YAML has; arrays and texts are cut after `longest`."""
    if _is_message(value):
        fields = value.get_fields_and_field_types()
        return {name: plain(getattr(value, name), longest, no_arr, no_str, fields[name]) for name in fields}
    if isinstance(value, bytes):
        value = value.decode("latin-1")
    if isinstance(value, str):
        if no_str:
            return f"<string length: <{len(value)}>>"
        return value if longest is None or len(value) <= longest else f"{value[:longest]}..."
    if isinstance(value, (list, tuple, array.array, np.ndarray)):
        if no_arr:
            of = _SEQUENCE.fullmatch(kind)
            if of and of[1]:
                return f"<sequence type: {of[1]}, length: {len(value)}>"
            return f"<array type: {kind}>"
        kept = [plain(each, longest, no_arr, no_str) for each in value[:longest]]
        return kept if len(kept) == len(value) else [*kept, "..."]
    return value.item() if isinstance(value, np.generic) else value


def to_yaml(value, flow_style=False):
    """Return a plain value as YAML."""
    return yaml.safe_dump(value, sort_keys=False, allow_unicode=True, width=float("inf"), default_flow_style=flow_style)


def to_csv(value):
    """Return all numbers and texts of a plain value, with commas between."""
    if isinstance(value, dict):
        return ",".join(map(to_csv, value.values()))
    return ",".join(map(to_csv, value)) if isinstance(value, list) else str(value)


def from_yaml(text, what):
    """Return what a text in YAML says; raises `Failure`."""
    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise Failure(f"{what} is not YAML: {' '.join(str(error).split())}") from None


def fill(message, values):
    """Set fields of a message by a mapping of names to values; raises `Failure`."""
    fields = message.get_fields_and_field_types()
    if not isinstance(values, dict):
        raise Failure(f"Failed to populate field: {values!r} for {type(message).__name__}, accepted: a mapping")
    for name, value in values.items():
        if name not in fields:
            known = ", ".join(fields) or "none"
            raise Failure(f"Failed to populate field: {type(message).__name__} has no {name!r}, it has: {known}")
        try:
            setattr(message, name, _fitting(getattr(message, name), value, fields[name]))
        except (AssertionError, TypeError, ValueError, OverflowError) as error:
            reason = " ".join(str(error).split()) or f"accepted: {fields[name]}"
            raise Failure(f"Failed to populate field: {name} is {value!r}: {reason}") from None


def _fitting(current, value, kind):
    if _is_message(current):
        fill(current, value)
        return current
    if isinstance(current, float) and type(value) is int:
        return float(value)
    if isinstance(current, bytes) and type(value) is int:
        return bytes([value])
    of = _SEQUENCE.fullmatch(kind)
    if not of or not isinstance(value, list):
        return value
    if "/" in (element := of[1] or of[2]):
        made = interface(element, "msg")
        return [_fitting(made(), each, element) for each in value]
    return [float(each) if element in ("float", "double") and type(each) is int else each for each in value]


def _is_message(value):
    return hasattr(value, "get_fields_and_field_types")
