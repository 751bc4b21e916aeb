"""The second solver (Pinocchio) beside ours: one state at a time, and a run."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.rui.solve import accelerations
from trackvib_sim.rui.sweeps.riccati import solve_accelerations
from trackvib_sim.rui.sweeps.tree import to_table
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Probe, Simulation
from trackvib_sim.simulation.step import add_forces
from trackvib_sim.studies.paper.pinocchio_tree import PinocchioTree, relative_difference
from trackvib_sim.studies.paper.second_solver import PinocchioSimulation, added_loads, put_back, solved
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.system import Operation, new_work

from ...vehicle.generated_vehicles import made

pytestmark = pytest.mark.cross_engine

ENGINES = 1e-9  # of the largest entry
GRAVITY = (0.0, 0.0, -9.81)
SPACING = 0.05  # m


@pytest.fixture(scope="module")
def rough():
    """A class E road that becomes rough under the vehicle."""
    return Iso8608Road("E", 1, 0.0, 4.0)


@pytest.fixture(scope="module")
def make(vehicle):
    """A function that makes a simulation of either kind at 10 m/s with the engine running and a probe on the turret."""

    def of(kind):
        probes = (Probe("turret", (1.0, 0.5, 0.2)),)
        return kind(vehicle, RunSettings(Operation(10.0, 2100.0, True), Rates(), 1.0), probes)

    return of


@pytest.fixture(scope="module")
def moments(make, rough):
    """A simulation at 20 moments of a run, 20 ms apart, with fresh `Work` on which all forces act."""

    def run():
        moving, work = make(Simulation), None
        first = -int(10.0 / SPACING)
        segment = rough.heights(first, int(30.0 / SPACING))
        moving.road.add(first * SPACING, SPACING, *segment)
        for _ in range(20):
            for _ in range(20):
                moving.advance(np.ones(2))
            work = new_work(moving.system)
            add_forces(moving.system, moving.state, moving.road.around(-9.0, 15.0), work)
            yield moving, work

    return run


@pytest.mark.parametrize("seed", range(20))
def test_same_accelerations_in_any_state(table, random_state, random_loads, seed):
    """Random attitudes, speeds, torques and wrenches on all bodies: linear, angular and hinge accelerations."""
    state, loads = random_state(seed), random_loads(seed)
    theirs = PinocchioTree(table, GRAVITY).solve(state, loads)
    assert relative_difference(accelerations(table, state, loads, GRAVITY)[:3], theirs) < ENGINES


@pytest.mark.parametrize("hinge", ["elastic", "free", "fixed"])
def test_same_accelerations_of_bodies_on_any_hinge(rough, hinge):
    """A cabin on a bushing, on mounts or one with the hull, its forces taken from the cuts of a rolling vehicle."""
    vehicle = made(5, 0.0, 2, 1, False, True, 4, 2, hinge)
    moving = Simulation(vehicle, RunSettings(Operation(5.0, 1650.0, True), Rates(), 1.0))
    first = -int(10.0 / SPACING)
    moving.road.add(first * SPACING, SPACING, *rough.heights(first, int(30.0 / SPACING)))
    for _ in range(20):
        moving.advance(np.ones(len(moving.state.coils.field)))
    work, tree = new_work(moving.system), moving.system.tree
    add_forces(moving.system, moving.state, moving.road.around(-9.0, 15.0), work)
    state, loads = to_table(tree, moving.state.tree), added_loads(tree, work)
    solve_accelerations(tree, work.motion, work.cuts, work.response)
    theirs = PinocchioTree(build_body_table(vehicle), GRAVITY).solve(state, loads)
    assert relative_difference(solved(tree, work), theirs) < ENGINES


def test_same_accelerations_along_a_run(table, moments):
    """The forces of a rolling vehicle, taken from its cuts, accelerate it in both solvers alike.

    They are all of its forces: without those on the powertrain the solvers differ.
    """
    tree, checked = PinocchioTree(table, GRAVITY), 0
    powertrain = [body.name for body in table].index("powertrain")
    weight = 9.81 * sum(body.mass for body in table)
    for moving, work in moments():
        state, loads = to_table(moving.system.tree, moving.state.tree), added_loads(moving.system.tree, work)
        assert np.abs(loads.force[:, 2]).sum() > 0.1 * weight  # whether on the ground or between impacts
        solve_accelerations(moving.system.tree, work.motion, work.cuts, work.response)
        ours = solved(moving.system.tree, work)
        assert relative_difference(ours, tree.solve(state, loads)) < ENGINES
        loads.force[powertrain] = loads.moment[powertrain] = 0.0
        assert relative_difference(ours, tree.solve(state, loads)) > 1e-3
        checked += 1
    assert checked == 20


def test_accelerations_written_back_are_read_alike(table, moments):
    """What is put back into the response reads as what it was."""
    moving, work = next(moments())
    tree = moving.system.tree
    theirs = PinocchioTree(table, GRAVITY).solve(to_table(tree, moving.state.tree), added_loads(tree, work))
    assert not work.response.cells.any()
    put_back(tree, work, theirs)
    for found, expected in zip(solved(tree, work), theirs, strict=True):
        assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_a_short_run_stays_with_ours(make, rough):
    """50 ms on a rough road: all sensors and the speed agree to 1e-6 of the largest; rounding alone parts the runs."""
    ours = run_open_loop(make(Simulation), rough, 50)
    second = make(PinocchioSimulation)
    theirs = run_open_loop(second, rough, 50)
    assert 0.0 < second.difference < ENGINES
    for found, expected in zip(theirs, ours, strict=True):
        assert_allclose(found, expected, rtol=0, atol=1e-6 * np.abs(expected).max())
    assert np.ptp(ours.specific_force[:, :, 2], axis=0).min() > 0.1
