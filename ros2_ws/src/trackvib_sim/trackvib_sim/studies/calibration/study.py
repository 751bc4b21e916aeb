"""`trackvib study calibrate`: fit uncertain parameters of the vehicle to the given rows of [Tao2025]'s Table 1."""

from pathlib import Path

import yaml
from dask.system import CPU_COUNT
from rich.progress import MofNCompleteColumn

from ...console import Terminal, progress_on
from ...data import calibration_plan_file, find_vehicle, paper_table_file
from ...new_files import new_file
from ...vehicle.vehicle_file import parse_vehicle, read_vehicle
from ..case_store import program, text_hash
from ..paper.paper_table import error_factor, read_table
from ..workers import workers
from .history import History
from .objective import cases, level_cases
from .pictures import convergence_picture, frontier_picture, sensitivity_picture
from .plan import PlanError, read_plan
from .report import report
from .search import Candidates, search
from .sensitivity import sensitivity, sensitivity_csv
from .vehicle_text import calibrated_vehicle_text

_HASH = 16  # digits


def run_calibrate(plan_file, vehicle_file, without, generations, scheduler, out):
    """Do the study, or go on with it; everything it leaves lies in the folder `out`.

    Parameters
    ----------
    plan_file, vehicle_file : path-like or None
        None for those that come with the package.
    without : sequence of str
        Road classes whose rows are left out.
    generations : int or None
        How many the search has in all, with those done earlier; None for the plan's number.
    scheduler : str or None
        As `workers.workers` takes it.
    out : path-like

    Raises
    ------
    PlanError, VehicleFileError, HistoryError, WorkersError, OSError
        Plan, vehicle file or the folder cannot be used, or nothing can run.
    """
    vehicle, text = read_vehicle(find_vehicle(vehicle_file))
    given = read_table(paper_table_file())
    plan = read_plan(plan_file or calibration_plan_file(), text, given)
    plan = plan.model_copy(update={"rows": [row for row in plan.rows if row[0] not in without]})
    if not plan.rows:
        raise PlanError(f"without {', '.join(without)} no row is left of {len(given)}")
    paper = {row: given[row] for row in plan.rows}
    folder, console = Path(out), Terminal()
    folder.mkdir(parents=True, exist_ok=True)
    key = _key(text, plan, paper)
    history, around = (
        History(folder / name, key, plan.items, list(paper)) for name in ("history.csv", "sensitivity_runs.csv")
    )
    with workers(scheduler, CPU_COUNT) as client, progress_on(console, MofNCompleteColumn()) as progress:
        runs = cases(paper, plan.seeds) + level_cases(paper)
        candidates = Candidates(client, text, plan, runs, paper)
        start = plan.values(plan.shares([parameter.of(vehicle) for parameter in plan.parameters]))
        search(candidates, history, start, generations or plan.generations, progress)
        best = history.chosen
        _write_vehicle(folder / "vehicle.yaml", text, plan, best.values)
        with new_file(folder / "values.yaml") as file:
            file.write(yaml.safe_dump(dict(zip(plan.items, best.values, strict=True)), sort_keys=False).encode())
        sensitive = sensitivity(candidates, around, best.values, progress)
    with new_file(folder / "sensitivity.csv") as file:
        file.write(sensitivity_csv(plan, list(paper), sensitive).encode())
    with new_file(folder / "sensitivity.png") as file:
        sensitivity_picture(file, plan, list(paper), sensitive)
    with new_file(folder / "convergence.png") as file:
        convergence_picture(file, plan, history.candidates)
    with new_file(folder / "frontier.png") as file:
        frontier_picture(file, history)
    with new_file(folder / "calibration.md") as file:
        file.write(report(plan, start, history, list(paper), sensitive).encode())
    console.print(
        f"objective {best.objective:.3f}, at the start {history.candidates[0].objective:.3f}; "
        f"error factor over {len(paper)} rows {error_factor(best.ratios, 1.0):.3f}"
    )
    pictures = "convergence.png, frontier.png, sensitivity.png"
    console.print(
        f"written to {folder}: vehicle.yaml, values.yaml, calibration.md, {pictures}, sensitivity.csv, history.csv",
        soft_wrap=True,
    )


def _key(vehicle_text, plan, paper):
    """Return a hash of all that decides about the candidates and their numbers."""
    # more generations may be asked for later, and sources put into better words
    asked = plan.model_dump_json(exclude={"generations": True, "parameters": {"__all__": {"source"}}})
    numbers = repr([values.tolist() for values in paper.values()])
    return text_hash(vehicle_text + asked + numbers + program())[:_HASH]


def _write_vehicle(path, text, plan, values):
    new = calibrated_vehicle_text(text, plan.parameters, values)
    vehicle = parse_vehicle(new, str(path))
    for parameter, value in zip(plan.parameters, values, strict=True):
        if parameter.of(vehicle) != value:
            raise ValueError(f"{path}: {parameter.item} reads {parameter.of(vehicle)}, must be {value}")
    with new_file(path) as file:
        file.write(new.encode())
