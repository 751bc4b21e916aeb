"""The search of a calibration: candidates by CMA-ES [Hansen2016], each driven over all rows on many cores.

[Hansen2016] N. Hansen, The CMA evolution strategy: a tutorial, arXiv 1604.00772.
"""

from functools import lru_cache
from typing import NamedTuple

import cma
import numpy as np
from distributed import Client

from ...simulation.run_in import CannotRoll
from ...simulation.simulation import RunFailed
from ...vehicle.body_tree import whole_mass
from ...vehicle.vehicle_file import parse_vehicle
from ..case import Result, drive
from ..paper.paper_table import error_factor
from ..resistance.case import ResistanceCase, pull
from ..resistance.table import published_range
from ..workers import finished
from .history import Candidate
from .objective import objective, ratios
from .plan import Plan
from .vehicle_text import calibrated_vehicle_text


class Candidates(NamedTuple):
    """Turns values into numbers beside the paper's."""

    client: Client
    vehicle_text: str  # what is calibrated
    plan: Plan
    cases: list  # of one candidate: first those of `objective.cases`, then those of `objective.level_cases`
    paper: dict  # (class, speed) -> values (6,)

    def evaluate(self, history, wanted, advance):
        """Return the `Candidate` of each place; those that the history lacks are driven and appended to it.

        Parameters
        ----------
        history : calibration_history.History
        wanted : dict
            (generation, index) -> values of the parameters.
        advance : function of int
            Called with the number of runs that have been done since.
        """
        missing = [(place, values) for place, values in wanted.items() if history.find(*place, values) is None]
        count = len(self.cases)
        advance((len(wanted) - len(missing)) * count)
        texts = [calibrated_vehicle_text(self.vehicle_text, self.plan.parameters, values) for _, values in missing]
        tasks = [(text, case, self.plan.measuring) for text in texts for case in self.cases]
        results = [{} for _ in missing]
        for number, result in finished(self.client, attempt, tasks) if tasks else ():
            k, case = divmod(number, count)
            results[k][case] = result
            if len(results[k]) == count:
                place, values = missing[k]
                level = [case for case in range(count) if isinstance(self.cases[case], ResistanceCase)]
                found, scatter = ratios([results[k][case] for case in range(count) if case not in level], self.paper)
                resistance = np.array([results[k][case] for case in level])
                history.append(Candidate(*place, objective(found, resistance), scatter, values, found, resistance))
            advance(1)
        return [history.find(*place, values) for place, values in wanted.items()]


def attempt(vehicle_text, case, duration):
    """Return what a case gave; a vehicle that cannot be built or cannot stand has failed, too.

    That is the `case.Result` of a drive over a road, and of a case on level ground the running resistance over both
    ends of its range, not a number if the run failed.
    """
    try:
        vehicle = _vehicle(vehicle_text)
        if isinstance(case, ResistanceCase):
            return pull(vehicle, case) / np.array(published_range(whole_mass(vehicle), case.speed))
        return drive(vehicle, case, duration)
    except (ValueError, CannotRoll, RunFailed) as error:
        failed = np.full(2, np.nan) if isinstance(case, ResistanceCase) else Result(f"failed: {error}", {}, None)
        return failed


@lru_cache(maxsize=4)  # reading takes a tenth of a run's time, and one candidate's runs come one after the other
def _vehicle(text):
    return parse_vehicle(text, "candidate")


def search(candidates, history, start, generations, progress):
    """Search for the values with the smallest objective; what the history has already is not driven again.

    Parameters
    ----------
    candidates : Candidates
    history : calibration_history.History
        Generation 0 in it is the start alone.
    start : sequence of float
        Values of the parameters.
    generations : int
        In all, with those in the history.
    progress : rich.progress.Progress
    """
    plan, runs = candidates.plan, len(candidates.cases)
    task = progress.add_task("start", total=(1 + generations * plan.population) * runs)
    candidates.evaluate(history, {(0, 0): start}, lambda done: progress.advance(task, done))
    options = {
        "bounds": [0.0, 1.0],
        "popsize": plan.population,
        "randn": np.random.RandomState(plan.seed).randn,  # of its own: the way can be gone again from the history
        "seed": np.nan,
        "verbose": -9,
    }
    strategy = cma.CMAEvolutionStrategy(plan.shares(start), plan.step, options)
    for generation in range(1, generations + 1):

        def advance(done, of=f"generation {generation}/{generations}"):
            best = history.best
            now = f"{of}, objective {best.objective:.3f}, factor {error_factor(best.ratios, 1.0):.3f}"
            progress.update(task, advance=done, description=now)

        shares = strategy.ask()
        wanted = {(generation, index): plan.values(each) for index, each in enumerate(shares)}
        strategy.tell(shares, [candidate.objective for candidate in candidates.evaluate(history, wanted, advance)])
