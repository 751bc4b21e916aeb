"""Results of cases on disk: whole or not there, and only for the vehicle and program that made them."""

import subprocess
import sys
from dataclasses import replace

import pytest
from trackvib_sim.studies.case import Case, Result
from trackvib_sim.studies.case_store import DECISIVE, PACKAGE, CaseStore

pytestmark = pytest.mark.property

CASE = Case("E", 10.0, 3, 0.1)
LEVELS = {probe: (0.1, 1.0 / 3.0, 12.5) for probe in ("chassis", "powertrain", "rigid")}
RESULTS = (Result("ok", LEVELS, 9.99), Result("failed: the vehicle has overturned after t = 3.210 s", {}, None))


@pytest.mark.parametrize("result", RESULTS)
def test_a_result_comes_back_as_it_was(tmp_path, result):
    """To the last bit, from another store on the same folder; nothing else lies beside it."""
    CaseStore(tmp_path / "new" / "cases", "text").save(CASE, result)
    store = CaseStore(tmp_path / "new" / "cases", "text")
    assert store.load(CASE) == result
    assert store.foreign == 0
    assert len(list((tmp_path / "new" / "cases").iterdir())) == 1


@pytest.mark.parametrize(
    "other",
    [{"road_class": "D"}, {"speed": 10.5}, {"seed": 4}, {"track_phase": 0.2}, {"current": 1.5}],
    ids=lambda change: next(iter(change)),
)
def test_every_part_of_a_case_counts(tmp_path, other):
    """A case that differs in anything is another one."""
    store = CaseStore(tmp_path, "text")
    store.save(CASE, RESULTS[0])
    assert store.load(replace(CASE, **other)) is None
    assert store.load(CASE) == RESULTS[0]


def test_results_of_another_vehicle_are_not_used(tmp_path):
    """They are counted, and are there again for the vehicle that they belong to."""
    CaseStore(tmp_path, "one vehicle").save(CASE, RESULTS[0])
    other = CaseStore(tmp_path, "another vehicle")
    assert other.load(CASE) is None
    assert other.foreign == 1
    other.save(CASE, RESULTS[1])
    assert CaseStore(tmp_path, "one vehicle").load(CASE) == RESULTS[0]


@pytest.mark.parametrize("content", ["", '{"case"', '{"case": {}, "result": {}}'])
def test_a_broken_file_counts_as_missing(tmp_path, content):
    """What a power cut may leave is done again and replaced."""
    store = CaseStore(tmp_path, "text")
    store.save(CASE, RESULTS[0])
    (file,) = tmp_path.iterdir()
    file.write_text(content)
    assert store.load(CASE) is None
    store.save(CASE, RESULTS[0])
    assert store.load(CASE) == RESULTS[0]


@pytest.mark.slow(reason="a fresh process that imports everything")
def test_every_module_that_a_drive_runs_makes_results_void():
    """What a fresh process imports for a drive is among the modules whose change is noticed."""
    drives = "trackvib_sim.studies.case, trackvib_sim.studies.controllers.scenario"
    script = f"import sys, {drives}; print(*sys.modules, sep='\\n')"
    names = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
    parts = [name.split(".")[1:] for name in names if name.startswith("trackvib_sim.")]
    ours = {str(PACKAGE.joinpath(*part)) + ".py" for part in parts if not PACKAGE.joinpath(*part).is_dir()}
    noticed = {str(file) for pattern in DECISIVE for file in PACKAGE.glob(pattern)}
    assert len(ours) > 30
    assert ours <= noticed
