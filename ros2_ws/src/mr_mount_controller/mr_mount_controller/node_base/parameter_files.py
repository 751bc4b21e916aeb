"""What parameter files give to many nodes at once, and so to nodes that do not have it."""

from pathlib import Path

import yaml

_OPTION = "--params-file"
_PARAMETERS = "ros__parameters"


def given_by_wildcard(arguments):
    """Return the names of all parameters that files among the arguments of ROS give by a wildcard, as `/**`.

    ROS has read the files before; names within names are joined by dots, as it does.
    """
    names = set()
    for option, path in zip(arguments, arguments[1:], strict=False):
        if option == _OPTION:
            names |= _by_wildcard(yaml.safe_load(Path(path).read_text(encoding="utf-8")) or {}, "")
    return names


def _by_wildcard(tree, node):
    names = set()
    for key, inner in tree.items():
        if key == _PARAMETERS:
            names |= set(_flat(inner, "")) if "*" in node else set()
        elif isinstance(inner, dict):
            names |= _by_wildcard(inner, f"{node}/{key}")
    return names


def _flat(values, prefix):
    for name, value in (values or {}).items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}"
