"""The tables of the documents that are made from the code: a function each, by its name in the documents' marks."""

import importlib
import inspect
from importlib.metadata import entry_points, requires

import mr_mount_controller.laws
import numpy as np
import trackvib_sim.rui
from file_tables import TABLES as FILE_TABLES
from message_tables import TABLES as MESSAGE_TABLES
from mr_mount_controller.laws import find_law, shipped_laws
from mr_mount_controller.mount import HIGHEST_CURRENT, LOWEST_CURRENT, PUBLISHED
from mr_mount_controller.node import PARAMETERS as CONTROLLER
from mr_mount_controller.node_base.plain_text import span
from mr_mount_controller.node_base.topic_table import TOPICS
from trackvib_sim.nodes.player import PARAMETERS as PLAYER
from trackvib_sim.nodes.recorder_parameters import PARAMETERS as RECORDER
from trackvib_sim.nodes.road_excitation import PARAMETERS as ROAD
from trackvib_sim.nodes.simulator_parameters import PARAMETERS as SIMULATOR
from vehicle_tables import TABLES as VEHICLE_TABLES

PACKAGES = ("trackvib_sim", "mr_mount_controller")
_PARAMETER_HEAD = ("parameter", "default", "accepted", "meaning")


def executables():
    """Each program that `ros2 run PACKAGE NAME` starts, with what its module says of itself."""
    found = {}
    for entry in entry_points(group="console_scripts"):
        package = entry.module.partition(".")[0]
        if package in PACKAGES:
            found[f"`{package} {entry.name}`"] = importlib.import_module(entry.module).__doc__.splitlines()[0]
    return [("`ros2 run`", "is"), *sorted(found.items())]


def extras():
    """What `pip install` brings with each package, and with each of its extras."""
    rows = [("`pip install`", "brings")]
    for package in reversed(PACKAGES):
        brought = {}
        for requirement in requires(package):
            name, _, extra = requirement.partition("; extra == ")
            brought.setdefault(f"{package}[{extra.strip(chr(34))}]" if extra else package, []).append(f"`{name}`")
        rows += [(f"`{what}`", ", ".join(names)) for what, names in brought.items()]
    return rows


def library():
    """Each name of the library with the first line of its docstring."""
    rows = [("name", "is")]
    for door in (trackvib_sim, trackvib_sim.rui, mr_mount_controller.laws):
        for name in sorted(set(door.__all__), key=lambda name: (name[0].islower(), name)):
            rows.append((f"`{door.__name__}.{name}`", inspect.getdoc(getattr(door, name)).splitlines()[0]))
    return rows


def topics():
    """All topics of the loop."""
    head = ("topic", "type", "from", "rate", "meaning")
    return [head, *((f"`{t.name}`", f"`{t.type}`", f"`{t.publisher}`", t.rate, t.meaning) for t in TOPICS)]


def node_parameters(declared):
    """Return the function that makes the table of a node's parameters."""
    return lambda: [_PARAMETER_HEAD, *map(_parameter, declared)]


def laws():
    """The laws of this project: a row with what each does, then one for each parameter."""
    rows = [_PARAMETER_HEAD]
    for name in shipped_laws():
        law = find_law(name)
        rows += [(f"**{name}**", "", "", law.__doc__.splitlines()[0]), *map(_parameter, law.parameters)]
    return rows


def mount():
    """Stiffness and damping of a mount at some currents, that of the most damping among them."""
    firmest = round(PUBLISHED.current_for_damping(np.inf), 2)
    rows = [("current, A", "k, kN/mm", "c, kN s/m")]
    for current in (LOWEST_CURRENT, 0.8, 1.0, 2.0, 3.0, firmest, HIGHEST_CURRENT):
        most = " (most)" if current == firmest else ""
        stiffness, damping = 1e-6 * PUBLISHED.stiffness(current), 1e-3 * PUBLISHED.damping(current)
        rows.append((f"{current:g}", f"{stiffness:.2f}", f"{damping:.1f}{most}"))
    return rows


def _parameter(each):
    choices = ("false", "true") if isinstance(each.default, bool) else each.choices
    accepted = ", ".join(f"`{choice}`" for choice in choices)
    if each.low is not None:
        accepted = span(each.low, each.high, each.unit)
    return f"`{each.name}`", _default(each.default), accepted, each.description


def _default(value):
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, (list, tuple)):
        return ", ".join(f"`{each}`" for each in value)
    return f"`{value}`" if value != "" else "empty"


TABLES = {
    "executables": executables,
    "extras": extras,
    "names of the library": library,
    "topics": topics,
    "parameters of simulator": node_parameters(SIMULATOR),
    "parameters of road_excitation": node_parameters(ROAD),
    "parameters of controller": node_parameters(CONTROLLER),
    "parameters of recorder": node_parameters(RECORDER),
    "parameters of player": node_parameters(PLAYER),
    "laws": laws,
    "mount": mount,
    **FILE_TABLES,
    **MESSAGE_TABLES,
    **VEHICLE_TABLES,
}
