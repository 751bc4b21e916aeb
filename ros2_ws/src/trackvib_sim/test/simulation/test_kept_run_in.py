"""Property: a run-in that was kept is the one that would be done, to the last bit."""

import numpy as np
import pytest
from trackvib_sim.simulation import kept_run_in
from trackvib_sim.simulation import run_in as fresh
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.vehicle.system import Operation, build_system

pytestmark = pytest.mark.property


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Where run-ins are kept, and none is yet; the kernels stay where they were when numba was loaded."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    return tmp_path / "run_in"


def run_in(vehicle, speed=5.0, physics=10_000, of=kept_run_in):
    """The arrays of the state after a run-in at a speed [m/s]."""
    settings = RunSettings(Operation(speed, 1650.0, False, 0.25), Rates(physics), 1.0)
    system = build_system(vehicle, settings.operation, 1.0 / physics)
    return list(kept_run_in._leaves(of.run_in(vehicle, system, settings)))


@pytest.mark.slow(reason="runs in the vehicle twice")
def test_kept_and_fresh_are_the_same(folder, vehicle, monkeypatch):
    """The first is done and kept, the second is taken from there: nothing is stepped any more."""
    first = run_in(vehicle)
    assert len(list(folder.iterdir())) == 1
    done = run_in(vehicle, of=fresh)
    monkeypatch.setattr(fresh, "control_periods", None)
    for ours in (first, run_in(vehicle)):
        assert all(map(np.array_equal, ours, done))


@pytest.mark.slow(reason="runs in four vehicles")
def test_what_differs_is_kept_apart(folder, vehicle):
    """Another speed, rate or vehicle has a run-in of its own."""
    heavier = vehicle.model_copy(update={"hull": vehicle.hull.model_copy(update={"mass": vehicle.hull.mass + 1.0})})
    run_in(vehicle)
    run_in(vehicle, speed=5.1)
    run_in(vehicle, physics=20_000)
    run_in(heavier)
    assert len(list(folder.iterdir())) == 4


@pytest.mark.slow(reason="runs in the vehicle three times")
def test_a_damaged_file_is_done_again(folder, vehicle):
    first = run_in(vehicle)
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    for damaged in (whole[:-8], whole[:-8] + bytes(8), b""):
        file.write_bytes(damaged)
        assert all(map(np.array_equal, run_in(vehicle), first))
        assert file.read_bytes() == whole


def test_the_oldest_make_room(folder, vehicle, monkeypatch):
    monkeypatch.setattr(kept_run_in, "MOST", 1)
    run_in(vehicle)
    (before,) = folder.iterdir()
    run_in(vehicle, speed=5.1)
    (after,) = folder.iterdir()
    assert after != before


def test_without_a_folder_none_is_kept(folder, vehicle, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    run_in(vehicle)
    assert not folder.exists()
