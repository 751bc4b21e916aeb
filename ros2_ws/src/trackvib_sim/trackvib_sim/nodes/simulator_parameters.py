"""Parameters of the simulator node, and the simulation that they describe."""

from contextlib import suppress

from mr_mount_controller.node_base.parameters import Parameter, ParameterError
from mr_mount_controller.node_base.topics import VEHICLE_DESCRIPTION

from ..bags.provenance import parameters_with
from ..data import find_vehicle
from ..simulation.settings import Rates, RunSettings
from ..simulation.simulation import Simulation
from ..vehicle.coil import usable_current
from ..vehicle.system import Operation
from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle, read_vehicle

PARAMETERS = (
    Parameter("vehicle_file", "", "Vehicle file; empty for the one that comes with the package."),
    Parameter("speed", 10.0, "Speed that the driver keeps; below 0 backwards.", "m/s", -25.0, 25.0),
    Parameter("engine_speed", 1650.0, "Engine speed; 0 for a standing engine.", "r/min", 0.0, 4000.0),
    Parameter(
        "engine_excitation",
        "forces",
        "Forces and moments of each order on the powertrain, or the displacement across the mounts of [Tao2025].",
        choices=("forces", "displacement"),
    ),
    Parameter(
        "track_phase", 0.25, "Part of a pitch by which the right track lies ahead of the left one.", "", 0.0, 1.0
    ),
    Parameter("duration", 0.0, "Simulated time after which the node ends; 0 for no end.", "s", 0.0, 1e6),
    Parameter(
        "pace",
        "lockstep",
        "Wait for the answer to every sample and run as fast as that allows, or follow the wall clock.",
        choices=("lockstep", "realtime"),
    ),
    Parameter("real_time_factor", 1.0, "Simulated per wall time where pace is realtime.", "", 0.01, 100.0),
    Parameter("answer_timeout", 1.0, "Wall time after which a controller is silent.", "s", 0.001, 60.0),
    Parameter(
        "on_silence",
        "hold",
        "When the controller is silent: hold the last current, fall back to passive_current, or stop.",
        choices=("hold", "passive", "stop"),
    ),
    Parameter("passive_current", 1.0, "Current before the first answer, and of on_silence passive.", "A", 0.0, 5.0),
    Parameter("physics_rate", 10_000, "Rate of the physics steps.", "Hz", 1000, 200_000),
    Parameter("control_rate", 1_000, "Rate of the Imu messages and of the control loop.", "Hz", 10, 10_000),
    Parameter("odometry_rate", 100, "Rate of odometry and /clock.", "Hz", 1, 10_000),
    Parameter("wait_for_recorder", False, "Start only with a recorder, and never run far ahead of it."),
)


def prepare(values):
    """Return the `Simulation` for a dict of parameter values, the range of usable currents [A] and the vehicle's text.

    Raises
    ------
    ParameterError
        A value does not fit the vehicle, or the others.
    """
    try:
        vehicle, text = read_vehicle(find_vehicle(values["vehicle_file"]))
    except VehicleFileError as error:
        raise ParameterError(f"simulator: parameter 'vehicle_file': {error}") from None
    return simulation_of(vehicle, values), usable_current(vehicle), text


def simulation_of(vehicle, values):
    """Return the `Simulation` of a vehicle for a dict of parameter values; raises as `prepare` does."""
    low, high = vehicle.engine.speed_range
    engine_speed = values["engine_speed"]
    if engine_speed != 0.0 and not low <= engine_speed <= high:
        raise ParameterError(
            f"simulator: parameter 'engine_speed' is {engine_speed}, accepted is 0 or {low:g} to {high:g} r/min"
        )
    operation = Operation(
        values["speed"], engine_speed, values["engine_excitation"] == "displacement", values["track_phase"]
    )
    try:
        rates = Rates(values["physics_rate"], values["control_rate"], values["odometry_rate"])
        return Simulation(vehicle, RunSettings(operation, rates, values["passive_current"]))
    except ValueError as error:  # also of the vehicle: its tracks do not fit, it cannot roll
        raise ParameterError(f"simulator: {error}") from None


def prepare_again(recording):
    """Return the `Simulation` of a `bags.recording.Recording` with all its road, and the recorded parameter values.

    Raises
    ------
    ParameterError
        The recording does not tell the parameters, or one cannot be used.
    VehicleFileError
        The recorded vehicle cannot be used.
    """
    _, recorded = parameters_with(recording.provenance, "physics_rate")
    if not recorded:
        raise ParameterError("the bag does not tell the parameters of its simulator")
    values = {parameter.name: _value(parameter, recorded) for parameter in PARAMETERS}
    simulation = simulation_of(parse_vehicle(recording.vehicle, VEHICLE_DESCRIPTION), values)
    for patch in recording.road:
        with suppress(ValueError):  # which the simulator refused as well
            simulation.road.add(*patch)
    return simulation, values


def _value(parameter, recorded):
    """What was recorded as text, in the type of the parameter; one that is younger than the bag has its default."""
    text = recorded.get(parameter.name, str(parameter.default))
    kind = type(parameter.default)
    try:
        return parameter.check(text == "True" if kind is bool else kind(text))
    except ValueError as error:
        raise ParameterError(f"recorded {parameter.name} is {text!r}: {error}") from None
