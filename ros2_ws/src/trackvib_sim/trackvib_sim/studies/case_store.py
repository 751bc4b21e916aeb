"""Results of cases as files, so that a study does only what no earlier one has done."""

import hashlib
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from ..new_files import new_file
from .case import Case, Result

PACKAGE = Path(__file__).parents[1]
DECISIVE = (  # modules that `drive` runs; all others may change without making its results void
    "data/__init__.py",
    "extras.py",
    "yaml_text.py",
    "numerics/**/*.py",
    "rui/**/*.py",
    "road/**/*.py",
    "vehicle/**/*.py",
    "simulation/**/*.py",
    "analysis/iso2631.py",
    "analysis/settling.py",
    "analysis/vibration.py",
    "studies/case.py",
    "studies/controllers/scenario.py",
    "studies/m113/case.py",
    "studies/m113/measures.py",
    "studies/m113/reference.py",
    "studies/m113/variants.py",
    "studies/resistance/case.py",
)
C, R = TypeVar("C"), TypeVar("R")


@dataclass(frozen=True)
class _Stored(Generic[C, R]):
    """What a file holds."""

    case: C
    result: R


class CaseStore:
    """A folder with one JSON file a finished case.

    A file counts only for the vehicle file and the program that made it: a hash of both leads its name.
    Cases and results are dataclasses of the types given.
    """

    def __init__(self, folder, vehicle_text, case=Case, result=Result):
        """Make the folder if there is none; raises OSError if that cannot be."""
        self._file = TypeAdapter(_Stored[case, result])
        self._folder = Path(folder)
        self._folder.mkdir(parents=True, exist_ok=True)
        self._key = text_hash(vehicle_text + program())[:12]

    @property
    def foreign(self):
        """How many files come from another vehicle file or another version of the program."""
        return sum(not path.name.startswith(self._key) for path in self._folder.glob("*.json"))

    def load(self, case):
        """Return the result of a case, or None if there is no file, or none that can be used."""
        try:
            return self._file.validate_json(self._path(case).read_bytes()).result
        except (FileNotFoundError, ValidationError):
            return None

    def save(self, case, result):
        """Keep a result. Whatever happens, there is either a whole file or none."""
        with new_file(self._path(case)) as file:
            file.write(self._file.dump_json(_Stored(case, result), indent=1))

    def _path(self, case):
        return self._folder / f"{'_'.join(map(str, (self._key, *astuple(case))))}.json"


def program():
    """Return a hash of the modules that decide about a case's result."""
    files = sorted({file for pattern in DECISIVE for file in PACKAGE.glob(pattern)})
    return text_hash("".join(f"{file.relative_to(PACKAGE)}\n{file.read_text(encoding='utf-8')}" for file in files))


def text_hash(text):
    """Return the SHA-256 of a text, in hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()
