"""`trackvib modes`: natural frequencies and damping of the standing vehicle, as a table and as pictures."""

import re
from pathlib import Path

from rich.table import Table

from ..console import Terminal
from ..data import find_vehicle
from ..drawings.mode_pictures import mode_pictures
from ..rui.linear.mode import describe
from ..rui.linear.modes import modes
from ..vehicle.body_tree import running_gear_kind
from ..vehicle.coil import usable_current
from ..vehicle.linear_vehicle import build_linear_vehicle
from ..vehicle.system import Operation, build_system
from ..vehicle.vehicle_file import read_vehicle
from .result_folder import whole_or_none

DRAWN = 12  # most modes in the picture
ALIKE = 0.05  # relative distance of neighbours that share a line, if the same parts move


def run_modes(name_or_file, current, highest, picture):
    """Print the table of a vehicle's modes up to `highest` [Hz] at a coil current [A], and draw the lowest ones.

    Raises
    ------
    ValueError
        The file cannot be used, the vehicle cannot stand, the current is none of its mounts', or the picture's folder
        does not exist.
    CommandError
        The picture cannot be written.
    """
    if not Path(picture).absolute().parent.is_dir():
        raise ValueError(f"picture {picture}: its folder must exist")
    vehicle, _ = read_vehicle(find_vehicle(name_or_file))
    low, high = usable_current(vehicle)
    if not low <= current <= high:
        raise ValueError(
            f"current is {current:g} A, must be within the valid range of the mounts, {low:g} to {high:g} A"
        )
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    model = build_linear_vehicle(vehicle, system, current)
    found = [mode for mode in modes(model, highest) if mode.frequency <= highest]
    oscillating = [mode for mode in found if not mode.overdamped]
    creeping = [mode for mode in found if mode.overdamped]
    out = Terminal()
    carried = f", {current:g} A in its coils" if system.mounts.coils else ""
    out.print(_table(model, oscillating, f"Oscillations of the standing vehicle{carried}"))
    if creeping:
        out.print(_creeping(model, creeping))
    drawn = [group[0] for group in _groups(model, oscillating)][:DRAWN]
    if drawn:
        titles = [f"{mode.frequency:.2f} Hz, {mode.damping_ratio:.3f}\n{_motion(model, mode)}" for mode in drawn]
        with whole_or_none(Path(picture)) as (file,):
            mode_pictures(model, drawn, titles, file)
        out.print(f"picture of the first mode of each line: {picture}")


def _table(model, found, title):
    table = Table("Hz", "damping ratio", "modes", "motion: share of the kinetic energy", title=title)
    for group in _groups(model, found):
        frequency = _range([mode.frequency for mode in group], 3)
        table.add_row(frequency, _range([mode.damping_ratio for mode in group], 3), *_rest(model, group))
    return table


def _creeping(model, found):
    title = "Motions that creep back without oscillating"
    table = Table("time constant, s", "modes", "motion: share of the kinetic energy", title=title)
    for group in _groups(model, found):
        table.add_row(_range([1.0 / abs(mode.pole) for mode in group], 4), *_rest(model, group))
    return table


def _rest(model, group):
    return str(len(group)), _motion(model, group[0])


def _range(values, digits):
    low, high = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return low if low == high else f"{low} - {high}"


def _groups(model, found):
    """Neighbours in frequency in which the same parts move."""
    groups = []
    for mode in found:
        last = groups[-1][-1] if groups else None
        if last and _parts(model, mode) == _parts(model, last) and mode.frequency < (1.0 + ALIKE) * last.frequency:
            groups[-1].append(mode)
        else:
            groups.append([mode])
    return groups


def _parts(model, mode):
    return re.sub(" [0-9]+%", "", _motion(model, mode))


def _motion(model, mode):
    """The parts that matter, wheels and arms of all stations taken together."""
    return describe(model, mode, group=lambda name: running_gear_kind(name) or name.replace("_", " "))
