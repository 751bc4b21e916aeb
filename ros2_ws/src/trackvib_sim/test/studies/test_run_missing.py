"""Cases on real Dask workers, and what is not done twice."""

import pytest
from rich.progress import Progress
from trackvib_sim.data import find_vehicle
from trackvib_sim.studies.case import drive
from trackvib_sim.studies.case_store import CaseStore
from trackvib_sim.studies.paper.table1 import cases
from trackvib_sim.studies.run_missing import run_missing
from trackvib_sim.studies.workers import WorkersError

pytestmark = pytest.mark.system

NOBODY = "tcp://127.0.0.1:1"  # where no scheduler is


@pytest.mark.slow(reason="starts worker processes")
def test_only_missing_cases_are_done(vehicle, tmp_path):
    """Workers give what a run in this process gives; a second call needs none, a further case does."""
    wanted = cases("A", (20.0,), 2)
    store = CaseStore(tmp_path, find_vehicle().read_text())
    with Progress(disable=True) as progress:
        found = run_missing(vehicle, wanted, store, None, progress, "runs")
        assert found[wanted[0]] == drive(vehicle, wanted[0])
        before = {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()}
        assert len(before) == 2
        assert run_missing(vehicle, wanted, store, NOBODY, progress, "runs") == found
        assert {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()} == before
        with pytest.raises(WorkersError, match=NOBODY):
            run_missing(vehicle, cases("A", (20.0,), 3), store, NOBODY, progress, "runs")


@pytest.mark.slow(reason="waits for a scheduler that is not there")
@pytest.mark.parametrize("address", [NOBODY, "nonsense", "", "foo://host:1", "127.0.0.1"])
def test_an_address_without_scheduler_is_named(vehicle, tmp_path, address):
    """Whatever is wrong with it, the error repeats the address and shows what one looks like."""
    store = CaseStore(tmp_path, "")
    with Progress(disable=True) as progress, pytest.raises(WorkersError, match="tcp://host:8786") as refused:
        run_missing(vehicle, cases("A", (20.0,), 1), store, address, progress, "runs")
    assert repr(address) in str(refused.value)


@pytest.mark.property
def test_phases_of_the_tracks_fill_the_pitch_evenly():
    """Gaps are at most twice as wide as with even spacing; a seed's phase does not depend on how many there are."""
    for count in (3, 5, 20):
        phases = sorted(case.track_phase for case in cases("A", (5.0,), count))
        gaps = [b - a for a, b in zip(phases, [*phases[1:], phases[0] + 1.0], strict=True)]
        assert max(gaps) < 2.0 / count
    assert cases("A", (5.0,), 2) == cases("A", (5.0,), 3)[:2]
