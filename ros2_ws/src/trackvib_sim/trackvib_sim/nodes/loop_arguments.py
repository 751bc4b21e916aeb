"""What may be chosen of a closed loop, once for `trackvib run` and for the launch file, and the parameters that it is.

An option `--physics-rate` of the one is an argument `physics_rate:=` of the other. What takes time to load is loaded
late, for the help of both need not wait for it.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from mr_mount_controller.node_base.parameters import ParameterError

from ..data import DEFAULT_VEHICLE, find_vehicle

SIMULATOR, ROAD, CONTROLLER, RECORDER = NODES = "simulator", "road_excitation", "controller", "recorder"
SLOWEST_PHYSICS = 1000  # Hz, of the physics steps
VIEW_RATE = 50  # Hz of simulated time


class Argument(NamedTuple):
    """One choice."""

    kind: type  # of its value: str, int, float or bool
    default: str  # where no parameter file says otherwise; empty for none
    description: str
    parameters: Callable  # from its value to parameters by node


def _of(*places, read=lambda value: value):
    """Return the function that gives a value, as `read` makes it, to parameters that are told as (node, name)."""
    return lambda value: {node: {name: read(value)} for node, name in places}


def _road(name):
    from ..road_sources.road_file import whole_name

    return whole_name(name)


def _law_parameters(text):
    values = {}
    for word in text.split(","):
        name, equals, value = map(str.strip, word.partition("="))
        if not (equals and name and value):
            raise ParameterError(f"law_parameters is {text!r}, accepted: NAME=VALUE, separated by commas")
        values[name] = _scalar(value, name)
    return {CONTROLLER: values}


ARGUMENTS = {
    "vehicle": Argument(
        str,
        DEFAULT_VEHICLE,
        "Name of an included vehicle, or a vehicle file.",
        _of((SIMULATOR, "vehicle_file"), read=lambda name: str(find_vehicle(name).absolute())),
    ),
    "road": Argument(
        str,
        "E",
        "ISO 8608 class, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag.",
        _of((ROAD, "road"), read=_road),
    ),
    "speed": Argument(float, "10.0", "Speed in m/s; negative for reverse.", _of((SIMULATOR, "speed"))),
    "drive": Argument(
        str,
        "",
        "Drive file: speed, path and engine speed over time or distance. Replaces the speed.",
        _of((SIMULATOR, "drive"), read=lambda path: str(Path(path).absolute())),
    ),
    "gears": Argument(
        bool,
        "",
        "Derive engine speed from vehicle speed through the gears of the vehicle file.",
        _of((SIMULATOR, "gears")),
    ),
    "duration": Argument(
        float,
        "10.0",
        "Simulated time in s, at least 1 s longer than the run settles, which at 10 m/s takes 2 s.",
        _of((SIMULATOR, "duration")),
    ),
    "law": Argument(str, "passive", "Control law", _of((CONTROLLER, "law"))),
    "law_parameters": Argument(
        str, "", "Parameters of the law, separated by commas, such as firm_current=2.5.", _law_parameters
    ),
    "seed": Argument(int, "1", "Seed of the road.", _of((ROAD, "seed"))),
    "physics_rate": Argument(
        int,
        "0",
        "Rate of the physics steps in Hz; 0 for the recommended one, which `trackvib vehicle` prints.",
        _of((SIMULATOR, "physics_rate")),
    ),
    "control_rate": Argument(
        int,
        "1000",
        "Rate in Hz of the sensor samples and of the controller's answers.",
        _of((SIMULATOR, "control_rate"), (CONTROLLER, "sample_rate")),
    ),
    "measure_rate": Argument(
        int,
        "0",
        "Rate in Hz of running-gear signals: travel, forces, tension, torque; 0 for none.",
        _of((SIMULATOR, "measure_rate")),
    ),
    "realtime_priority": Argument(
        int,
        "0",
        "Priority in real time (SCHED_FIFO) of simulator and controller; 0 for none.",
        _of((SIMULATOR, "realtime_priority"), (CONTROLLER, "realtime_priority")),
    ),
    "core": Argument(
        int,
        "-1",
        "Core that simulator and controller keep to; -1 for any.",
        _of((SIMULATOR, "core"), (CONTROLLER, "core")),
    ),
    "view": Argument(
        bool,
        "",
        f"Publish frames and markers for viewers, at {VIEW_RATE} Hz of simulated time.",
        _of((SIMULATOR, "view_rate"), read=lambda wanted: VIEW_RATE if wanted else 0),
    ),
}


def closed_loop_parameters():
    """Return the path of the node parameters that `closed_loop.launch.py` and `trackvib run` share."""
    from ament_index_python.packages import get_package_share_directory

    return Path(get_package_share_directory("trackvib_sim")) / "config" / "closed_loop.yaml"


def loop_parameters(given, files=(), namespace="/"):
    """Return the `NodeParameters` of a loop, and its vehicle (`parameters.Vehicle`).

    Parameters
    ----------
    given : dict
        Values of `ARGUMENTS` by name; they count more than the files.
    files : iterable of path
        Parameter files after that of the closed loop; what comes later counts.
    namespace : str
        Full name.

    Raises
    ------
    ParameterError
        An argument or file cannot be used.
    VehicleFileError
        The vehicle cannot be used.
    """
    from ..vehicle.vehicle_file import read_vehicle
    from .node_parameters import NodeParameters

    parameters = NodeParameters(NODES, namespace)
    for path in (closed_loop_parameters(), *files):
        parameters.read(path)
    for name, value in given.items():
        for node, values in ARGUMENTS[name].parameters(value).items():
            parameters.give(node, **values)
    vehicle, _ = read_vehicle(find_vehicle(parameters.get(SIMULATOR, "vehicle_file")))
    if parameters.get(ROAD, "track_distance") is None:
        parameters.give(ROAD, track_distance=2.0 * vehicle.road_wheels.y)
    return parameters, vehicle


def default_of(name):
    """Return the value of an argument that is not given: None, or False for a flag, where it has no default."""
    argument = ARGUMENTS[name]
    return argument_from_text(name, argument.default) if argument.default else False if argument.kind is bool else None


def argument_from_text(name, text):
    """Return the value of an argument that a text tells; raises `ParameterError` where it is of another kind."""
    kind = ARGUMENTS[name].kind
    if kind is str:
        return text
    value = _scalar(text, name)
    if kind is float and type(value) is int:
        value = float(value)
    if type(value) is not kind:
        words = {bool: "true or false", int: "a whole number", float: "a number"}[kind]
        raise ParameterError(f"argument {name} is {text!r}, accepted: {words}")
    return value


def _scalar(text, name):
    from ..yaml_text import YamlTextError, load

    try:
        return load(text, name)
    except YamlTextError as error:
        raise ParameterError(f"{name} is {text!r}: {error}") from None
