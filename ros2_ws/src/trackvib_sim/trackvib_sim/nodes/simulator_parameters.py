"""Parameters of the simulator node, and the simulation that they describe."""

from contextlib import suppress

from mr_mount_controller.node_base.parameters import Parameter, ParameterError
from mr_mount_controller.node_base.scheduling import SCHEDULING
from mr_mount_controller.node_base.topics import DRIVE_DESCRIPTION, VEHICLE_DESCRIPTION

from ..bags.provenance import parameters_with, recorded_value
from ..data import find_vehicle
from ..numerics.units import RPM
from ..simulation.settings import Rates, RunSettings
from ..simulation.simulation import Simulation
from ..vehicle.coil import usable_current
from ..vehicle.drive.drive_file import DriveFileError, drive_text, parse_drive
from ..vehicle.drive.limits import FASTEST
from ..vehicle.step_size import recommended_rate
from ..vehicle.system import Operation
from ..vehicle.vehicle_file import VehicleFileError, parse_vehicle, read_vehicle
from .loop_arguments import SLOWEST_PHYSICS

PARAMETERS = (
    Parameter("vehicle_file", "", "Vehicle file; empty for the default vehicle."),
    Parameter("drive", "", "Drive file: speed, path and engine speed over time or distance; empty for none."),
    Parameter(
        "speed", 10.0, "Constant speed, if no drive file gives it; negative for reverse.", "m/s", -FASTEST, FASTEST
    ),
    Parameter(
        "gears", False, "Whether engine speed is derived from vehicle speed through the gears of the vehicle file."
    ),
    Parameter(
        "engine_speed",
        1650.0,
        "Engine speed without gears, if no drive file gives it; 0 for an engine at rest.",
        "r/min",
        0.0,
        4000.0,
    ),
    Parameter(
        "engine_excitation",
        "forces",
        "Forces and moments of each order on the powertrain, or the displacement across the mounts of [Tao2025].",
        choices=("forces", "displacement"),
    ),
    Parameter(
        "track_phase", 0.25, "Fraction of a pitch by which the right track is ahead of the left one.", "", 0.0, 1.0
    ),
    Parameter("duration", 0.0, "Simulated time after which the node ends; 0 for no end.", "s", 0.0, 1e6),
    Parameter(
        "pace",
        "lockstep",
        "Wait for the answer to every sample and run as fast as that allows, or follow the wall clock.",
        choices=("lockstep", "realtime"),
    ),
    Parameter("real_time_factor", 1.0, "Simulated time per wall time if pace is realtime.", "", 0.01, 100.0),
    Parameter(
        "answer_timeout",
        1.0,
        "Wall time without an answer after which a controller counts as silent.",
        "s",
        0.001,
        60.0,
    ),
    Parameter(
        "on_silence",
        "hold",
        "When the controller is silent: hold the last current, fall back to passive_current, or stop.",
        choices=("hold", "passive", "stop"),
    ),
    Parameter("passive_current", 1.0, "Current before the first answer, and with on_silence passive.", "A", 0.0, 5.0),
    Parameter(
        "physics_rate",
        0,
        "Rate of the physics steps, 1000 or more; 0 for the recommended rate of the vehicle.",
        "Hz",
        0,
        200_000,
    ),
    Parameter("control_rate", 1_000, "Rate of the Imu messages and of the control loop.", "Hz", 10, 10_000),
    Parameter("odometry_rate", 100, "Rate of odometry and /clock.", "Hz", 1, 10_000),
    Parameter("view_rate", 0, "Rate of frames, joint states and track links for viewers; 0 for none.", "Hz", 0, 1_000),
    Parameter("measure_rate", 0, "Rate of the running-gear signals; 0 for none.", "Hz", 0, 10_000),
    Parameter("wait_for_recorder", False, "Wait for a recorder before the start, and never run far ahead of it."),
    Parameter("wait_for_view", False, "Wait for the live view of `trackvib run --view` before the start."),
    *SCHEDULING,
)


def prepare(values):
    """Return the `Simulation` for a dict of parameter values, the range of usable currents [A], and two texts: of the
    vehicle file and of the drive file, the latter empty where there is none.

    Raises
    ------
    ParameterError
        A value does not fit the vehicle, or the others.
    """
    try:
        vehicle, text = read_vehicle(find_vehicle(values["vehicle_file"]))
    except VehicleFileError as error:
        raise ParameterError(f"simulator: parameter 'vehicle_file': {error}") from None
    try:
        drive = drive_text(values["drive"]) if values["drive"] else ""
    except DriveFileError as error:
        raise ParameterError(f"simulator: parameter 'drive': {error}") from None
    for name in ("view_rate", "measure_rate"):
        if values[name] and values["control_rate"] % values[name]:
            raise ParameterError(
                f"simulator: control_rate {values['control_rate']} Hz and {name} {values[name]} Hz conflict: the "
                "first must be a multiple of the second"
            )
    return simulation_of(vehicle, values, drive), usable_current(vehicle), text, drive


def simulation_of(vehicle, values, drive):
    """Return the `Simulation` of a vehicle for a dict of parameter values and the text of a drive file, or none of it.

    Raises as `prepare` does.
    """
    engine_speed = values["engine_speed"]
    _check_engine_speed(vehicle, "parameter 'engine_speed'", engine_speed)
    displacement = values["engine_excitation"] == "displacement"
    try:
        schedule = parse_drive(drive, engine_speed, "drive file") if drive else None
        for speed in schedule.engine_speed if schedule else ():
            _check_engine_speed(vehicle, "engine_speed in the drive file", round(float(speed / RPM), 6))
        operation = Operation(
            values["speed"], engine_speed, displacement, values["track_phase"], schedule, values["gears"]
        )
        rates = Rates(physics_rate(vehicle, values), values["control_rate"], values["odometry_rate"])
        return Simulation(vehicle, RunSettings(operation, rates, values["passive_current"]))
    except ValueError as error:  # also of the vehicle: its tracks do not fit, it cannot roll
        raise ParameterError(f"simulator: {error}") from None


def physics_rate(vehicle, values):
    """Return the rate of the physics steps [Hz] that parameter values ask for; raises `ParameterError`."""
    rate = values["physics_rate"]
    if 0 < rate < SLOWEST_PHYSICS:
        raise ParameterError(f"parameter 'physics_rate' is {rate}, accepted: 0 or at least {SLOWEST_PHYSICS} Hz")
    return rate or recommended_rate(vehicle, values["control_rate"])


def _check_engine_speed(vehicle, item, value):
    low, high = vehicle.engine.speed_range
    if value != 0.0 and not low <= value <= high:
        raise ParameterError(f"simulator: {item} is {value}, accepted: 0 or {low:g} to {high:g} r/min")


def prepare_again(recording):
    """Return the `Simulation` of a `bags.recording.Recording` with all its road and commands, and the recorded
    parameter values.

    Raises
    ------
    ParameterError
        The recording does not tell the parameters, or one cannot be used.
    VehicleFileError
        The recorded vehicle cannot be used.
    """
    _, recorded = parameters_with(recording.provenance, "physics_rate")
    if not recorded:
        raise ParameterError("the bag does not hold the parameters of its simulator")
    values = {parameter.name: recorded_value(parameter, recorded) for parameter in PARAMETERS}
    if values["drive"] and not recording.drive_file:
        raise ParameterError(f"the bag holds no {DRIVE_DESCRIPTION}, but its run had a drive file")
    vehicle = parse_vehicle(recording.vehicle, VEHICLE_DESCRIPTION)
    simulation = simulation_of(vehicle, values, recording.drive_file or "")
    if recording.commands is not None:
        simulation.expect(list(zip(*(column.tolist() for column in recording.commands), strict=True)))
    for patch in recording.road:
        with suppress(ValueError):  # which the simulator refused as well
            simulation.road.add(*patch)
    return simulation, values
