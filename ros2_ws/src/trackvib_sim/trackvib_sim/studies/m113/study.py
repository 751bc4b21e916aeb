"""`trackvib study m113`: the M113 beside an independent code."""

from pathlib import Path

from rich.table import Table

from ...console import Terminal
from ...data import find_vehicle
from ...new_files import new_file
from ...rui.linear.mode import describe
from ...rui.linear.modes import modes
from ...vehicle.linear_vehicle import build_linear_vehicle
from ...vehicle.system import Operation, build_system
from ...vehicle.vehicle_file import read_vehicle
from ..case import rates_for
from ..case_store import CaseStore
from ..run_missing import run_shown
from .case import ROAD_SHARE, M113Case, M113Result, drive_m113
from .measures import LINES, LINES_SHARE, line_name
from .picture import m113_picture
from .reference import references
from .report import range_cell, report
from .statics import reference_ride_frequencies, reference_wheel_loads, standing_wheel_loads
from .table import FACTORS, beside_variants, failures, table_csv, table_rows, variant_factors
from .variants import BASE, VARIANTS

VEHICLE = "m113"
HIGHEST = 10.0  # Hz, among which the ride motions are


def run_m113(phases, scheduler, out):
    """Do the study; everything it leaves lies in the folder `out`.

    Parameters
    ----------
    phases : int
        Number of runs a case, each with its own phase between the two tracks; variants have two of them.
    scheduler, out
        As `table1.run_table1` takes them.

    Raises
    ------
    WorkersError, OSError
        Nothing can run, the folder cannot be used.
    """
    vehicle, text = read_vehicle(find_vehicle(VEHICLE))
    folder, console = Path(out), Terminal()
    store = CaseStore(folder / "cases", text, M113Case, M113Result)
    found = run_shown(vehicle, cases(phases), store, folder, console, scheduler, drive_m113)
    rows = table_rows(found, vehicle)
    factors = variant_factors(table_rows(beside_variants(found), vehicle))
    loads = standing_wheel_loads(vehicle), reference_wheel_loads()
    with new_file(folder / "m113.csv") as file:
        file.write(table_csv(rows).encode())
    with new_file(folder / "m113.md") as file:
        file.write(report(rows, factors, loads, ride_frequencies(vehicle), phases).encode())
    with new_file(folder / "m113.png") as file:
        m113_picture(rows, found, file)
    _print(console, rows, factors, loads, failures(found), folder)


def cases(phases):
    """Return the cases of the study: the vehicle at all phases, variants at the first and the middle one."""
    return [
        M113Case(variant, road, speed, k / phases)
        for variant in VARIANTS
        for road, speed in references()
        for k in (range(phases) if variant == BASE else sorted({0, phases // 2}))
    ]


def ride_frequencies(vehicle):
    """Return heave and pitch [Hz] by name, each ours and the reference's."""
    step = 1.0 / rates_for(vehicle).physics
    model = build_linear_vehicle(vehicle, build_system(vehicle, Operation(0.0, 0.0, False), step), 0.0)
    swinging = [mode for mode in modes(model, HIGHEST) if not mode.overdamped]
    theirs = dict(zip(("heave", "pitch"), reference_ride_frequencies(), strict=True))
    ours = {name: next(mode.frequency for mode in swinging if f"whole {name}" in str(describe(model, mode)))
            for name in theirs}  # fmt: skip
    return {name: (ours[name], theirs[name]) for name in theirs}


def _print(console, rows, factors, loads, failed, folder):
    mine = [row for row in rows if row.variant == BASE]
    names = [*dict.fromkeys(row.quantity for row in mine if row.agrees is not None), ROAD_SHARE, LINES_SHARE]
    heads = list(dict.fromkeys((row.road, row.speed) for row in mine))
    title = "M113 and Project Chrono, ours / theirs, RMS in m/s²; ! where the goal is not met"
    by_place = {(row.quantity, row.road, row.speed): row for row in mine}
    cells = {name: [_cell(by_place.get((name, *head))) for head in heads] for name in names}
    _print_cases(console, title, heads, cells)
    title = "Lines over the phases, range of our runs / theirs; ! where theirs is outside"
    lines = {name: [range_cell(by_place[(name, *head)], "{} !") for head in heads] for name in map(line_name, LINES)}
    _print_cases(console, title, heads, lines)
    carried = ", ".join(f"{each:.2f}" for each in (loads[0] / loads[1]).ravel())
    console.print(f"static wheel loads, ours / theirs, left and right from front to rear: {carried}", soft_wrap=True)
    title = "Variants with one change: levels relative to the same phases, correlation as is"
    changed = Table("variant", title=title, title_justify="left")
    for name in FACTORS:
        changed.add_column(name, justify="right")
    for name, values in factors.items():
        changed.add_row(name, *(f"{each:.2f}" for each in values))
    console.print(changed)
    for line in failed:
        console.print(line, soft_wrap=True)
    console.print(f"written to {folder}: m113.csv, m113.md, m113.png, cases/", soft_wrap=True)


def _print_cases(console, title, heads, cells):
    table = Table("", title=title, title_justify="left")
    for road, speed in heads:
        table.add_column(f"{road}, {speed} m/s", justify="right")
    for name, texts in cells.items():
        table.add_row(name, *texts)
    console.print(table)


def _cell(row):
    if row is None:
        return ""
    text = f"{row.ours:.2f}" if row.theirs is None else f"{row.ours:.2f} / {row.theirs:.2f}"
    return text + (" !" if row.agrees is False else "  ")
