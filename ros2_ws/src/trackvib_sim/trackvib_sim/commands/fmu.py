"""`trackvib fmu`: a vehicle on its road for other simulators, and what it needs where it runs."""

import sys
from pathlib import Path

from ..console import Terminal
from ..data import find_vehicle
from ..fmu.export import export
from ..nodes.simulator_parameters import PARAMETERS
from ..road.classes import CLASSES
from ..road_sources.road_file import find_road, road_in_words, whole_name
from ..road_sources.words import composition
from ..vehicle.drive.drive_file import drive_text
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import CommandError, whole_or_none


def run_fmu(out, vehicle, road, seed, speed, drive, gears, physics_rate):
    """Write the FMU of a vehicle (name or file) on a road, driven at a speed [m/s] or by a drive file, to `out`.

    Raises
    ------
    CommandError
        The file's name does not end in .fmu, or it cannot be written; what was there before is as it was.
    ValueError
        Vehicle, road or drive cannot be used, or do not fit each other.
    """
    file = Path(out).absolute()
    if file.suffix != ".fmu":
        raise CommandError(f"--out is {out!r}, must end in .fmu")
    parameters, text = read_vehicle(find_vehicle(vehicle))
    found = find_road(road, 2.0 * parameters.road_wheels.y, seed)  # refused here, before any work
    values = {parameter.name: parameter.default for parameter in PARAMETERS}
    values |= {"speed": speed, "gears": gears, "physics_rate": physics_rate}
    driven = f"{speed:g} m/s" if drive is None else f"drive {Path(drive).name}"
    name = f"{road_in_words(road, composition(found))}{f', seed {seed}' if road in CLASSES else ''}"
    title = f"vehicle {parameters.name}, {name}, {driven}{' in gears' if gears else ''}"
    console = Terminal()
    console.print(f"FMU: {title}")
    with whole_or_none(file) as (draft,):
        made = export(
            draft,
            title=title,
            vehicle=text,
            drive="" if drive is None else drive_text(drive),
            road=whole_name(road),
            seed=seed,
            values=values,
        )
    console.print(f"{out}: co-simulation by FMI 2.0, {made.inputs} inputs, {made.outputs} outputs")
    console.print(f"steps: whole multiples of the control period, {made.period:g} s")
    console.print(
        f"needs: Linux on x86-64, a simulator whose process is Python {sys.version_info[0]}.{sys.version_info[1]} "
        "(FMPy, for instance), and the packages, kernels and road files in their present folders; the FMU contains "
        "vehicle and drive"
    )
