"""`trackvib study resistance`: force and power to roll on level ground, and where the heat goes."""

from pathlib import Path

from rich.table import Table

from ...console import Terminal
from ...data import find_vehicle
from ...new_files import new_file
from ...vehicle.body_tree import GRAVITY, whole_mass
from ...vehicle.vehicle_file import read_vehicle
from ..case import GOOD
from ..case_store import CaseStore
from ..run_missing import run_shown
from .case import ResistanceCase, ResistanceResult, roll
from .picture import resistance_picture
from .table import force, published, table_csv

KILO = 1e3
SHOWN = 3.0  # %


def run_resistance(speeds, vehicle_file, scheduler, out):
    """Do the study; everything it leaves lies in the folder `out`.

    Parameters
    ----------
    speeds : sequence of float
        m/s.
    vehicle_file, scheduler, out
        As `table1.run_table1` takes them.

    Raises
    ------
    WorkersError, VehicleFileError, OSError
        Nothing can run, the vehicle file or the folder cannot be used.
    """
    vehicle, text = read_vehicle(find_vehicle(vehicle_file))
    folder, console = Path(out), Terminal()
    store = CaseStore(folder / "cases", text, ResistanceCase, ResistanceResult)
    cases = [ResistanceCase(speed) for speed in speeds]
    found = run_shown(vehicle, cases, store, folder, console, scheduler, roll)
    found, mass = {case: found[case] for case in cases}, whole_mass(vehicle)
    title = f"Running resistance of {vehicle.name}, {mass / KILO:.1f} t, on level ground"
    with new_file(folder / "resistance.csv") as file:
        file.write(table_csv(found, mass).encode())
    with new_file(folder / "resistance.png") as file:
        resistance_picture(found, mass, title, file)
    console.print(_table(found, mass, title))
    for case, result in found.items():
        if result.status != GOOD:
            console.print(f"{case.speed:g} m/s: {result.status}", soft_wrap=True)
    console.print(f"written to {folder}: resistance.csv, resistance.png, cases/", soft_wrap=True)


def _table(found, mass, title):
    table = Table("m/s", title=title, title_justify="left")
    for name in ("kN", "of weight", "kW"):
        table.add_column(name, justify="right")
    table.add_column("heat, %")
    table.add_column("formulas, kN")
    for case, result in found.items():
        if result.status == GOOD:
            pull = force(result)
            numbers = f"{pull / KILO:.1f}", f"{pull / (mass * GRAVITY):.1%}", f"{result.drive / KILO:.1f}"
            theirs = ", ".join(f"{each / KILO:.1f}" for each in published(mass, case.speed).values())
            table.add_row(f"{case.speed:g}", *numbers, _largest(result.heat), theirs)
    return table


def _largest(heat):
    """Name what takes `SHOWN` or more of all heat, the largest first."""
    parts = {name: 100.0 * each / sum(heat.values()) for name, each in heat.items()}
    largest = sorted((name for name in parts if parts[name] >= SHOWN), key=parts.get, reverse=True)
    return ", ".join(f"{name} {parts[name]:.1f}" for name in largest)
