"""All candidates of a calibration that were evaluated, in a CSV file that grows line by line."""

import csv
from typing import NamedTuple

import numpy as np

from ...new_files import new_file
from ..paper.paper_table import COLUMNS
from .objective import level_speeds, typical_excess

ALIKE = 1.05  # an objective up to this multiple of the best is as good
_KEYS = ("generation", "index", "objective", "scatter")


class HistoryError(ValueError):
    """A history that belongs to something else."""


class Candidate(NamedTuple):
    """A set of values and what it is worth."""

    generation: int
    index: int  # within the generation
    objective: float
    scatter: float  # as `calibration_objective.ratios` gives it
    values: list  # of the parameters
    ratios: np.ndarray  # (rows, 6) ours over the paper's, nan in rows with a failed run
    resistance: np.ndarray  # (speeds, 2) running resistance over both ends of its range, nan where the run failed


class History:
    """A CSV file of candidates, each there as soon as it has been evaluated.

    The first line names by a hash what the numbers depend on. All numbers but ratios and resistances are exact: a
    search that is done again with them takes the same way.

    Attributes
    ----------
    candidates : list of Candidate
        In the order of their evaluation.
    """

    def __init__(self, path, key, items, rows):
        """Read the file, or begin one.

        Parameters
        ----------
        path : pathlib.Path
        key : str
            Hash of all that decides about the numbers.
        items : sequence of str
            Names of the parameters.
        rows : sequence of (str, float)
            Class and speed of each row.

        Raises
        ------
        HistoryError
            The file is of another calibration.
        OSError
            It cannot be read or written.
        """
        names = [f"{road_class}_{speed:g}_{column}" for road_class, speed in rows for column in COLUMNS]
        names += [f"resistance_{speed:g}_over_{end}" for speed in level_speeds(rows) for end in ("low", "high")]
        head = f"# vehicle, plan, paper's rows and program: {key}\n{','.join((*_KEYS, *items, *names))}\n"
        self._path, self._values, self._ratios = path, len(items), len(rows) * len(COLUMNS)
        if not path.exists():
            _write(path, head)
        text = path.read_text(encoding="utf-8")
        if not text.startswith(head):
            raise HistoryError(
                f"{path} belongs to another vehicle file, plan, table or version of the program; choose another --out"
            )
        whole = text[: text.rfind("\n") + 1]
        if whole != text:  # the last line was cut short by a crash
            _write(path, whole)
        self.candidates = [self._candidate(line) for line in csv.reader(whole[len(head) :].splitlines())]
        self._known = {(each.generation, each.index): each for each in self.candidates}

    @property
    def best(self):
        """The candidate with the smallest objective."""
        return min(self.candidates, key=lambda candidate: candidate.objective)

    @property
    def alike(self):
        """Candidates that are as good as the best one, for chance alone makes such differences."""
        return [each for each in self.candidates if each.objective <= ALIKE * self.best.objective]

    @property
    def chosen(self):
        """Of those that are alike the one that rolls most easily."""
        return min(self.alike, key=lambda candidate: np.nan_to_num(typical_excess(candidate.resistance), nan=np.inf))

    def find(self, generation, index, values):
        """Return the candidate at a place if it has been evaluated with these values, else None."""
        known = self._known.get((generation, index))
        return known if known is not None and known.values == values else None

    def append(self, candidate):
        """Add a candidate, to the file at once."""
        first = (str(candidate.generation), str(candidate.index), repr(candidate.objective), repr(candidate.scatter))
        numbers = np.concatenate((candidate.ratios.ravel(), candidate.resistance.ravel()))
        numbers = [f"{number:.6g}" if np.isfinite(number) else "" for number in numbers]
        with self._path.open("a", encoding="utf-8") as file:
            file.write(",".join([*first, *map(repr, candidate.values), *numbers]) + "\n")
        self.candidates.append(candidate)
        self._known[candidate.generation, candidate.index] = candidate

    def _candidate(self, line):
        generation, index, objective, scatter, *numbers = line
        values = [float(each) for each in numbers[: self._values]]
        found = np.array([float(each or "nan") for each in numbers[self._values :]])
        ratios, resistance = np.split(found, [self._ratios])
        return Candidate(
            int(generation),
            int(index),
            float(objective),
            float(scatter),
            values,
            ratios.reshape(-1, len(COLUMNS)),
            resistance.reshape(-1, 2),
        )


def _write(path, text):
    with new_file(path) as file:
        file.write(text.encode())
