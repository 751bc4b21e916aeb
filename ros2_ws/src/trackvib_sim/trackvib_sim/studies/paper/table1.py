"""`trackvib study table1`: RMS accelerations over road classes and speeds, beside Table 1 of [Tao2025]."""

from math import sqrt
from pathlib import Path

import numpy as np
from rich.table import Table

from ...console import Terminal
from ...data import find_vehicle, paper_table_file
from ...new_files import new_file
from ...vehicle.vehicle_file import read_vehicle
from ..case import BAND, GOOD, Case
from ..case_store import CaseStore
from ..run_missing import run_shown
from ..workers import SharedWorkers
from .paper_table import error_factor, given, read_table, table_csv, table_rows
from .predictions import by_speed_alone, foretold, ours
from .table1_picture import table_picture
from .table1_report import report

_GOLDEN = (sqrt(5.0) - 1.0) / 2.0  # multiples of it fill an interval evenly, however many there are


def run_table1(classes, speeds, seeds, vehicle_file, scheduler, out):
    """Do the study; everything it leaves lies in the folder `out`.

    Parameters
    ----------
    classes, speeds : sequences of str and of float
        Road classes, and speeds [m/s].
    seeds : int
        Number of runs a class and speed.
    vehicle_file : path-like or None
        None for the vehicle that comes with the package.
    scheduler : str or None
        As `workers.workers` takes it.
    out : path-like

    Raises
    ------
    WorkersError, VehicleFileError, OSError
        Nothing can run, the vehicle file or the folder cannot be used.
    """
    path = Path(find_vehicle(vehicle_file))
    vehicle, text = read_vehicle(path)
    paper = read_table(paper_table_file())
    folder, console = Path(out), Terminal()
    store = CaseStore(folder / "cases", text)
    wanted = cases(classes, speeds, seeds)
    with SharedWorkers(scheduler, len(wanted)) as shared:
        rows = table_rows(run_shown(vehicle, wanted, store, folder, console, shared))
        left_out = foretold(text, paper, wanted, folder / "left_out", shared, console)
    predictions = [ours(rows, left_out, paper), *by_speed_alone(paper)]
    with new_file(folder / "table1.csv") as file:
        file.write(table_csv(rows).encode())
    with new_file(folder / "table1.md") as file:
        file.write(report(rows, paper, seeds, predictions, path.name, text).encode())
    with new_file(folder / "table1.png") as file:
        table_picture(rows, paper, seeds, file)
    _print(console, rows, paper, predictions, folder)


def cases(classes, speeds, seeds):
    """Return the cases of a study; seed and track phase of a case do not depend on how many there are."""
    return [
        Case(road_class, speed, seed, track_phase(seed))
        for road_class in classes
        for speed in speeds
        for seed in range(1, seeds + 1)
    ]


def track_phase(seed):
    """Return the part of a pitch by which the right track lies ahead of the left one in the runs of a seed."""
    return seed * _GOLDEN % 1.0


def _print(console, rows, paper, predictions, folder):
    title = f"RMS acceleration, m/s², {BAND[0]:g}-{BAND[1]:g} Hz, paper axes (Y is vertical)"
    table = Table("class", title=title, title_justify="left")
    for name in ("m/s", "chassis X, Y, Z", "powertrain X, Y, Z", "error factor"):
        table.add_column(name, justify="right")
    for row in rows:
        sensors = ("  ".join(_number(value) for value in part) for part in (row.rms[:3], row.rms[3:]))
        pair = given([row], paper)
        table.add_row(row.road_class, f"{row.speed:g}", *sensors, f"{error_factor(*pair):.2f}" if pair.size else "")
    console.print(table)
    for row in rows:
        if row.status != GOOD:
            console.print(f"class {row.road_class}, {row.speed:g} m/s: {row.status}", soft_wrap=True)
    if given(rows, paper).size:
        console.print(_predictions(predictions))
    console.print(f"written to {folder}: table1.csv, table1.md, table1.png, cases/, left_out/", soft_wrap=True)


def _predictions(predictions):
    table = Table("error factor over the paper's rows", title="Prediction", title_justify="left")
    for name in ("fitted to them", "classes left out"):
        table.add_column(name, justify="right")
    for each in predictions:
        table.add_row(each.name, *(f"{value:.3f}" if np.isfinite(value) else "-" for value in each[1:]))
    return table


def _number(value):
    return f"{value:5.2f}" if np.isfinite(value) else "    -"
