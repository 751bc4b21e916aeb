"""Parameter files of ROS: their sections, and what they give to many nodes at once."""

from pathlib import Path

import yaml

_OPTION = "--params-file"
_PARAMETERS = "ros__parameters"


def given_by_wildcard(arguments):
    """Return the names of all parameters that files among the arguments of ROS give by a wildcard, as `/**`.

    ROS has read the files before.
    """
    names = set()
    for option, path in zip(arguments, arguments[1:], strict=False):
        if option == _OPTION:
            for node, values in sections(yaml.safe_load(Path(path).read_text(encoding="utf-8")) or {}):
                names |= values.keys() if is_wildcard(node) else set()
    return names


def is_wildcard(node):
    """Return whether a section is for many nodes, by the name of its node."""
    return "*" in node


def sections(tree):
    """Yield the sections of a parameter file: the full name of the node, with wildcards, and its values by name.

    Names within names are joined by dots, as ROS does.
    """
    yield from _sections(tree, "")


def _sections(tree, node):
    for key, inner in tree.items():
        if key == _PARAMETERS and isinstance(inner, dict | None):
            yield node, dict(_flat(inner or {}, ""))
        elif isinstance(inner, dict):
            yield from _sections(inner, f"{node}/{str(key).strip('/')}")


def _flat(values, prefix):
    for name, value in values.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
