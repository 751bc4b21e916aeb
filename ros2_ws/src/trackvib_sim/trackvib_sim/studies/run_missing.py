"""All cases of a study: those that are in its store already, and the others done on many cores."""

from rich.progress import MofNCompleteColumn

from ..console import progress_on
from .case import drive
from .workers import results, workers


def run_missing(vehicle, cases, store, scheduler, progress, description, run=drive):
    """Return a dict of every case and its result; each new one is stored as soon as it is there.

    Parameters
    ----------
    vehicle : vehicle.parameters.Vehicle
    cases : sequence of drive.Case, or of what `run` takes
    store : case_store.CaseStore
        Of the same cases and of the results of `run`.
    scheduler : str, None or workers.SharedWorkers
        As `workers.workers` takes it.
    progress : rich.progress.Progress
        Shows how many of the cases are done, as `description`.
    run : function of a vehicle and a case

    Raises
    ------
    WorkersError, OSError
        As the workers and the store do.
    """
    found = {case: result for case in cases if (result := store.load(case)) is not None}
    missing = [case for case in cases if case not in found]
    task = progress.add_task(description, total=len(cases), completed=len(found))
    progress.advance(task, 0)  # a task is looked at, whether it is done, where it moves on
    if missing:
        with workers(scheduler, len(missing)) as client:
            for case, result in results(client, vehicle, missing, run):
                store.save(case, result)
                found[case] = result
                progress.advance(task)
    return {case: found[case] for case in cases}  # not in the order in which workers have finished them


def run_shown(vehicle, cases, store, folder, console, scheduler, run=drive, description="runs"):
    """Return what `run_missing` does, with a bar on the `console`, and a line on runs in `folder` that do not count."""
    if store.foreign:
        console.print(f"{store.foreign} runs in {folder} are from another vehicle or version and are not used")
    with progress_on(console, MofNCompleteColumn()) as progress:
        return run_missing(vehicle, cases, store, scheduler, progress, description, run)
