"""All cases of a study: those that are in its store already, and the others done on many cores."""

from .farm import farm, results


def finish(vehicle, cases, store, scheduler, progress, description):
    """Return a dict of every case and its `drive.Result`; each new one is stored as soon as it is there.

    Parameters
    ----------
    vehicle : vehicle.parameters.Vehicle
    cases : sequence of drive.Case
    store : case_store.CaseStore
    scheduler : str or None
        As `farm.farm` takes it.
    progress : rich.progress.Progress
        Shows how many of the cases are done, as `description`.

    Raises
    ------
    FarmError, OSError
        As the workers and the store do.
    """
    found = {case: result for case in cases if (result := store.load(case)) is not None}
    missing = [case for case in cases if case not in found]
    task = progress.add_task(description, total=len(cases), completed=len(found))
    if missing:
        with farm(scheduler, len(missing)) as client:
            for case, result in results(client, vehicle, missing):
                store.save(case, result)
                found[case] = result
                progress.advance(task)
    return found
