"""What the user chose of a run of the closed loop: by options, and by parameter files where no option says it."""

from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from mr_mount_controller.laws import find_law
from mr_mount_controller.laws.running import make_law
from mr_mount_controller.node_base.parameters import ParameterError

from ..analysis.settling import SHORTEST_MEASURING, SHORTEST_SETTLING, VEHICLE_BEHIND, settling_time
from ..nodes.loop_arguments import CONTROLLER, ROAD, SIMULATOR, loop_parameters
from ..nodes.simulator_parameters import PARAMETERS, physics_rate
from ..road.classes import CLASSES
from ..road_sources.road_file import RoadError, find_road, road_in_words
from ..road_sources.words import composition
from ..vehicle.drive.drive_file import DriveFileError, drive_text, parse_drive
from ..vehicle.drive.schedule import arrival_time
from ..vehicle.vehicle_file import VehicleFileError
from .result_folder import CommandError


@dataclass(frozen=True)
class Choices:
    """What the summary of a run tells of it."""

    vehicle: str | None  # name or file; None for the default one
    road: str  # class, or file
    road_consists_of: str  # in words
    speed: float | None  # None where a drive file gives it
    drive: str | None  # file
    gears: bool
    duration: float
    law: str
    seed: int | None  # of a road that is a class
    physics_rate: int  # Hz
    one_process: bool
    namespace: str  # full name
    measure_rate: int  # Hz, of the running gear; 0 for none
    view: bool  # in a browser

    @property
    def title(self):
        """The run in words."""
        vehicle = f"vehicle {self.vehicle}, " if self.vehicle else ""
        drive = f"drive {Path(self.drive).name}" if self.speed is None else f"{self.speed:g} m/s"
        name = road_in_words(self.road, self.road_consists_of)
        road = f"{name}, {drive}{' in gears' if self.gears else ''}"
        seed = "" if self.seed is None else f", seed {self.seed}"
        space = "" if self.namespace == "/" else f", namespace {self.namespace}"
        return f"{vehicle}{road}, law {self.law}{seed}, {self.duration:g} s{space}"


def choose(given, files, namespace, one_process, view):
    """Return the `Choices`, the `NodeParameters` that they are, and the vehicle (`parameters.Vehicle`).

    Parameters
    ----------
    given : dict
        Values of `loop_arguments.ARGUMENTS` by name.
    files : iterable of path
        Parameter files, which count where no option is given.
    namespace : str
        Its full name.
    one_process, view : bool

    Raises
    ------
    CommandError
        An option or file cannot be used, or the duration is too short.
    """
    try:
        parameters, vehicle = loop_parameters(given, files, namespace)
        own = {each.name: each.check(parameters.get(SIMULATOR, each.name, each.default)) for each in PARAMETERS}
        name = given.get("road") or str(parameters.get(ROAD, "road"))
        drive = given.get("drive") or own["drive"] or None
        road = find_road(name, 2.0 * vehicle.road_wheels.y)
        choices = Choices(
            vehicle=given.get("vehicle") or own["vehicle_file"] or None,
            road=name,
            road_consists_of=composition(road),
            speed=own["speed"] if drive is None else None,
            drive=drive,
            law=str(parameters.get(CONTROLLER, "law")),
            seed=parameters.get(ROAD, "seed") if name in CLASSES else None,
            one_process=one_process,
            namespace=parameters.namespace,
            view=view,
            physics_rate=physics_rate(vehicle, own),
            **{name: own[name] for name in ("gears", "duration", "measure_rate")},
        )
        _make_law(choices.law, parameters)
        settling = _settling(choices, road.begins)
    except (ParameterError, RoadError, DriveFileError, VehicleFileError) as error:
        raise CommandError(str(error)) from None
    if choices.duration < settling + SHORTEST_MEASURING:
        how = f"at {choices.speed:g} m/s" if choices.drive is None else f"with drive {choices.drive}"
        raise CommandError(
            f"--duration is {choices.duration:g} s, must be at least {settling + SHORTEST_MEASURING:.1f} s {how}: "
            f"{settling:.1f} s to settle and {SHORTEST_MEASURING:g} s to measure"
        )
    return choices, parameters, vehicle


def _make_law(name, parameters):
    """Make the law of a run once, so that one that cannot be is refused here; raises `ParameterError`."""
    kind = find_law(name)
    given = {each.name: parameters.get(CONTROLLER, each.name, each.default) for each in kind.parameters}
    values = {each.name: each.check(given[each.name]) for each in kind.parameters}
    make_law(kind, 1.0 / parameters.get(CONTROLLER, "sample_rate", 1000.0), values)


def _settling(choices, begins):
    """How long a run settles [s]: until all of the vehicle is on the road proper, which begins at a distance [m].

    A vehicle that never gets there, for it stands, settles as shortly as any."""
    if choices.drive is None:
        return settling_time(choices.speed, begins)
    arrival = arrival_time(parse_drive(drive_text(choices.drive), 0.0, choices.drive), begins + VEHICLE_BEHIND)
    return max(arrival, SHORTEST_SETTLING) if isfinite(arrival) else SHORTEST_SETTLING
