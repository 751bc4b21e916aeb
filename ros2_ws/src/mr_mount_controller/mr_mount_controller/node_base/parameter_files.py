"""Parameter files of ROS: their sections, and what they give to many nodes at once."""

import re
from pathlib import Path

import yaml

_OPTION = "--params-file"
_PARAMETERS = "ros__parameters"


def given_by_wildcard(arguments):
    """Return the names of all parameters that files among the arguments of ROS give by a wildcard, as `/**`.

    ROS has read the files before.
    """
    found = (section for _, tree in _files(arguments) for section in sections(tree))
    return {name for node, values in found if is_wildcard(node) for name in values}


def without_effect(arguments, names):
    """Yield a sentence on each file among the arguments of ROS that has no section for nodes of full names.

    ROS has read the files before.
    """
    for path, tree in _files(arguments):
        found = [section for section, _ in sections(tree)]
        if found and not any(is_for(section, name) for section in found for name in names):
            yield of_no_node(f"parameter file {path!r}", found, names)


def of_no_node(what, found, names):
    """Return the sentence that says that sections which were found in a file are for none of some nodes."""
    return f"{what} has sections for {', '.join(found)}, but the nodes here are {', '.join(names)}"


def is_for(section, name):
    """Return whether a section is for a node of a full name, as ROS decides."""
    parts = (r"(/\w+)*" if part == "**" else r"/\w+" if part == "*" else "/" + re.escape(part)
             for part in section.strip("/").split("/"))  # fmt: skip
    return re.fullmatch("".join(parts), name) is not None


def _files(arguments):
    """Yield path and contents of each parameter file among the arguments of ROS."""
    for option, path in zip(arguments, arguments[1:], strict=False):
        if option == _OPTION:
            yield path, yaml.safe_load(Path(path).read_text(encoding="utf-8")) or {}


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
