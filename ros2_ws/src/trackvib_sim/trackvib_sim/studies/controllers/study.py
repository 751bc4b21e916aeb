"""`trackvib study controllers`: every control law in four scenarios, beside constant currents."""

import hashlib
import inspect
from pathlib import Path

import mr_mount_controller
from mr_mount_controller.laws import find_law, known_laws
from mr_mount_controller.laws.running import make_law
from rich.table import Table

from ...console import Terminal
from ...data import find_vehicle
from ...new_files import new_file
from ...numerics.units import NANO
from ...vehicle.vehicle_file import read_vehicle
from ..case import rates_for
from ..case_store import CaseStore
from ..paper.table1 import track_phase
from ..run_missing import run_shown
from .picture import controllers_picture
from .report import report
from .scenario import PASSIVE, PASSIVE_CURRENT, SCENARIOS, ControlCase, ControlResult, control
from .table import SURE, table_csv, table_rows, verdict

GRID = (0.7, 0.8, 0.9, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # A, over which the best constant current is searched


def run_controllers(laws, scenarios, seeds, vehicle_file, scheduler, out):
    """Do the study; everything it leaves lies in the folder `out`.

    Parameters
    ----------
    laws : sequence of str, or None
        As `find_law` takes them; None for all that are known.
    scenarios : sequence of str
        Names in `scenario.SCENARIOS`.
    seeds : int
        Number of runs a scenario that varies, each with its own road and track phase.
    vehicle_file, scheduler, out
        As `table1.run_table1` takes them.

    Raises
    ------
    WorkersError, ParameterError, VehicleFileError, OSError
        Nothing can run, there is no such law, the vehicle file or the folder cannot be used.
    """
    laws = [name for name in laws or known_laws() if name != PASSIVE]
    classes = [find_law(name) for name in laws]
    path = Path(find_vehicle(vehicle_file))
    vehicle, text = read_vehicle(path)
    for each in classes:  # one that cannot be made is refused before there is a folder
        make_law(each, rates_for(vehicle).period / NANO, {})
    folder, console = Path(out), Terminal()
    store = CaseStore(folder / "cases", text + controllers(classes), ControlCase, ControlResult)
    found = run_shown(vehicle, cases(laws, scenarios, seeds), store, folder, console, scheduler, control)
    rows = table_rows(found)
    with new_file(folder / "controllers.csv") as file:
        file.write(table_csv(rows).encode())
    with new_file(folder / "controllers.md") as file:
        file.write(report(rows, seeds, path.name, text).encode())
    with new_file(folder / "controllers.png") as file:
        controllers_picture(rows, file)
    _print(console, rows, folder)


def cases(laws, scenarios, seeds):
    """Return the cases of a study: each law, and the passive one at each current of `GRID`."""
    choices = [(law, PASSIVE_CURRENT) for law in laws] + [(PASSIVE, current) for current in GRID]
    return [
        ControlCase(scenario, seed, track_phase(seed), law, current)
        for scenario in scenarios
        for seed in range(1, (seeds if SCENARIOS[scenario].varies else 1) + 1)
        for law, current in choices
    ]


def controllers(classes):
    """Return a hash of the controller package and of the files of law classes: what decides besides the simulation."""
    package = Path(mr_mount_controller.__file__).parent
    files = sorted({*package.rglob("*.py"), *(Path(inspect.getfile(each)) for each in classes)})
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def _print(console, rows, folder):
    verdicts = verdict(rows)
    table = Table("scenario", "quantity", title="gain over passive mounts, %", title_justify="left")
    for name in ("best constant, A", "over 1 A", "best law", "over 1 A", "over best constant", "chance"):
        table.add_column(name, justify="right")
    for each in verdicts:
        table.add_row(
            SCENARIOS[each.scenario].title, each.quantity, f"{each.current:g}", each.constant_gain.text(),
            each.law, each.law_gain.text(), each.over_best.text(), f"{each.chance:.1f}",
        )  # fmt: skip
    if verdicts:
        console.print(table)
        console.print(f"* {SURE}")
    else:
        console.print("no law to compare with the constant currents; their levels are in controllers.md")
    for row in rows:
        if row.failures:
            console.print(f"{row.scenario}, {row.name}: {'; '.join(row.failures)}", soft_wrap=True)
    console.print(f"written to {folder}: controllers.csv, controllers.md, controllers.png, cases/", soft_wrap=True)
