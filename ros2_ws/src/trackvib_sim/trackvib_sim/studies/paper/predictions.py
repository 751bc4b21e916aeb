"""How well the paper's table is predicted: by us, and by models that know nothing but the speed.

A model is worth its numbers if it foretells rows that it was not fitted to. So each is also fitted without one road
class after the other, and asked for that class.
"""

from typing import NamedTuple

import numpy as np
import yaml

from ...data import calibration_plan_file, find_vehicle, left_out_file
from ...vehicle.vehicle_file import parse_vehicle
from ..calibration.plan import read_plan
from ..calibration.vehicle_text import calibrated_vehicle_text
from ..case_store import CaseStore
from ..run_missing import run_shown
from .paper_table import error_factor, given, table_rows


class Prediction(NamedTuple):
    """Error factors of one model, not a number where there is none."""

    name: str
    fitted: float  # over the rows that it was fitted to
    left_out: float  # over all rows, each class foretold by the model that was fitted to the others


def by_speed_alone(paper):
    """Return the `Prediction`s of two models without an eye for the road class.

    One has a level of its own for each column and speed, the other levels that grow with a power of the speed.

    Parameters
    ----------
    paper : dict
        (class, speed) -> values (6,).
    """
    logs = np.log(np.array(list(paper.values())))
    speed = np.array([speed for _, speed in paper])
    road_class = np.array([road_class for road_class, _ in paper])
    bases = {
        "mean of each speed": (speed[:, None] == np.unique(speed)).astype(float),
        "power of the speed": np.stack((np.ones_like(speed), np.log(speed)), axis=1),
    }
    return [Prediction(f"{name}, {6 * basis.shape[1]} numbers", *_factors(basis, logs, road_class))
            for name, basis in bases.items()]  # fmt: skip


def _factors(basis, logs, road_class):
    fitted = error_factor(np.exp(basis @ np.linalg.lstsq(basis, logs, rcond=None)[0]), np.exp(logs))
    foretold = np.full_like(logs, np.nan)
    for each in np.unique(road_class):
        others = road_class != each
        if np.linalg.matrix_rank(basis[others]) == basis.shape[1]:
            foretold[~others] = basis[~others] @ np.linalg.lstsq(basis[others], logs[others], rcond=None)[0]
    return float(fitted), float(error_factor(np.exp(foretold), np.exp(logs)))


def left_out_vehicles(text, paper):
    """Return, by road class, the text of the vehicle that was calibrated without that class.

    Empty for a vehicle other than the default one: nobody has calibrated it.
    """
    if text != find_vehicle().read_text(encoding="utf-8"):
        return {}
    known = {parameter.item: parameter for parameter in read_plan(calibration_plan_file(), text, paper).parameters}
    found = yaml.safe_load(left_out_file().read_text(encoding="utf-8"))
    return {
        road_class: calibrated_vehicle_text(text, [known[item] for item in values], list(values.values()))
        for road_class, values in found.items()
    }


def foretold(text, paper, cases, folder, scheduler, console):
    """Return the `paper_table.Row`s of the cases of given classes, each by the vehicle calibrated without its class.

    Parameters
    ----------
    text : str
        Of the vehicle file.
    paper : dict
        (class, speed) -> values (6,).
    cases : sequence of case.Case
    folder : pathlib.Path
        Where finished runs are kept.
    scheduler : str, None or workers.SharedWorkers
        As `workers.workers` takes it.
    console : rich.console.Console
    """
    rows = []
    for road_class, other in left_out_vehicles(text, paper).items():
        mine = [case for case in cases if case.road_class == road_class and (road_class, case.speed) in paper]
        if not mine:
            continue
        store = CaseStore(folder / f"without_{road_class}", other)
        vehicle = parse_vehicle(other, f"vehicle calibrated without class {road_class}")
        words = f"calibrated without {road_class}"
        rows += table_rows(run_shown(vehicle, mine, store, folder, console, scheduler, description=words))
    return rows


def ours(rows, left_out_rows, paper):
    """Return our `Prediction` from the rows of the vehicle, and from those of `foretold`."""
    factors = [float(error_factor(*pair)) if (pair := given(each, paper)).size else np.nan
               for each in (rows, left_out_rows)]  # fmt: skip
    return Prediction("trackvib", *factors)
