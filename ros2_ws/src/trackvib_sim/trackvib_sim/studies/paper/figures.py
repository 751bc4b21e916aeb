"""`trackvib study figures`: the other figures of [Tao2025] as pictures, and a second solver beside ours."""

from pathlib import Path

import numpy as np

from ...analysis.numbers import SENSORS
from ...console import Terminal, progress_on
from ...data import find_vehicle
from ...new_files import new_file
from ...road.iso8608 import FADE, Iso8608Road
from ...simulation.simulation import RunFailed
from ...vehicle.drive.engine import IMPOSED_ORDER
from ...vehicle.vehicle_file import read_vehicle
from ..case import BAND, ENGINE_SPEED, Case
from ..case_store import CaseStore
from ..run_missing import run_missing
from . import paper_figures
from .figures_report import case_in_words, report
from .second_solver import SOLVERS, compare

CLASSES, SPEEDS = "ABCDE", (5.0, 10.0, 20.0)  # m/s
SEED = 1
TRACK_PHASE = 0.25  # neither in step nor in opposition, where the two tracks' vertical lines at v/p cancel
SHOWN = Case("E", 10.0, SEED, TRACK_PHASE)  # whose histories and spectra are drawn
ROAD_SPEED = 20.0  # m/s at which the road is drawn


def run_figures(vehicle, scheduler, out):
    """Draw all figures into the folder `out`.

    Parameters
    ----------
    vehicle, scheduler, out
        As `table1.run_table1` takes them.

    Raises
    ------
    WorkersError, OSError
        As workers and folder do.
    ValueError
        The case that is drawn has left the valid range.
    """
    vehicle, text = read_vehicle(find_vehicle(vehicle))
    folder, console = Path(out), Terminal()
    store = CaseStore(folder / "cases", text)
    cases = [Case(road_class, speed, SEED, TRACK_PHASE) for road_class in CLASSES for speed in SPEEDS]
    with progress_on(console) as progress:
        found = run_missing(vehicle, cases, store, scheduler, progress, "all classes and speeds")
        tasks = {solver: progress.add_task(f"{case_in_words(SHOWN)}, {solver}", total=1.0) for solver in SOLVERS}
        try:
            comparison = compare(vehicle, SHOWN, lambda solver, done: progress.update(tasks[solver], completed=done))
        except RunFailed as error:
            raise ValueError(f"{case_in_words(SHOWN)}, the case that is drawn: {error}") from None
    names = draw(folder, vehicle, found, comparison)
    console.print(f"accelerations of both solvers differ by {comparison.difference:.1e} of the largest at most")
    console.print(f"written to {folder}: {', '.join(names)}", soft_wrap=True)


def draw(folder, vehicle, found, comparison):
    """Write all pictures and `figures.md` to a folder; returns their names.

    Parameters
    ----------
    folder : pathlib.Path
    vehicle : vehicle.parameters.Vehicle
    found : dict
        `drive.Case` -> `drive.Result`, of all `CLASSES` and `SPEEDS`.
    comparison : second_solver.Comparison
        Of the case `SHOWN`.
    """
    road = Iso8608Road(SHOWN.road_class, SEED, -FADE, FADE)
    force = {
        solver: {sensor: drive.specific_force[sensor] for sensor in SENSORS}
        for solver, drive in comparison.drives.items()
    }
    ours = comparison.drives["Rui method"]
    limited = {sensor: ours.limited[sensor] for sensor in SENSORS}
    link_passing = SHOWN.speed / vehicle.tracks.pitch
    orders = {f"engine order {IMPOSED_ORDER:g}": IMPOSED_ORDER * ENGINE_SPEED / 60.0}
    levels = {sensor: _levels(found, sensor) for sensor in SENSORS}
    shown, band = f"{case_in_words(SHOWN)}, seed {SEED}", f"{BAND[0]:g}-{BAND[1]:g} Hz"
    pictures = {
        "road.png": (
            f"Road of class {SHOWN.road_class} at {ROAD_SPEED:g} m/s, seed {SEED}",
            paper_figures.road_picture, (road, ROAD_SPEED),
        ),
        "histories.png": (
            f"Acceleration of chassis and powertrain, {shown}, {band}",
            paper_figures.history_picture, (ours.time, limited),
        ),
        "spectra.png": (
            f"Vertical power spectral density, {shown}, {band}",
            paper_figures.spectrum_picture, (ours.rate, force["Rui method"], link_passing, orders),
        ),
        "levels.png": (
            f"RMS acceleration against speed and road class, seed {SEED}, {band}",
            paper_figures.level_picture, (CLASSES, SPEEDS, levels),
        ),
        "solvers.png": (
            f"Rui method and Pinocchio as second solver, {shown}, {band}",
            paper_figures.solver_picture, (ours.rate, force, comparison.levels()),
        ),
    }  # fmt: skip
    for name, (title, picture, arguments) in pictures.items():
        with new_file(folder / name) as file:
            picture(file, title, *arguments)
    titles = {name: title for name, (title, *_) in pictures.items()}
    with new_file(folder / "figures.md") as file:
        file.write(report(titles, found, SHOWN, comparison, link_passing).encode())
    return ["figures.md", *pictures]


def _levels(found, sensor):
    """RMS values (classes, speeds, 3) of a sensor [m/s^2], nan where a run has failed."""
    missing = (np.nan,) * 3
    return np.array(
        [[found[Case(each, speed, SEED, TRACK_PHASE)].rms.get(sensor, missing) for speed in SPEEDS] for each in CLASSES]
    )
