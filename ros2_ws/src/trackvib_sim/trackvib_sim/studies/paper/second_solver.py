"""The vehicle with its body tree solved by Pinocchio, the second solver: it plays the part of ADAMS in [Tao2025].

Forces, integration and measuring are the simulation's own. What hinges, suspension, tracks, mounts, engine and driver
add to the cuts goes to Pinocchio as external wrenches and hinge torques; kinematics, inertia and with them all
accelerations are Pinocchio's.
"""

from typing import NamedTuple

import numpy as np

from ...analysis.numbers import SENSORS
from ...analysis.vibration import rms
from ...rui.state import Loads
from ...rui.sweeps.articulated import CutOffset, new_cuts, open_cuts
from ...rui.sweeps.cells import columns
from ...rui.sweeps.kinematics import MotionOffset
from ...rui.sweeps.response import ResponseOffset
from ...rui.sweeps.riccati import solve_accelerations
from ...rui.sweeps.tree import new_rows, to_table
from ...simulation.simulation import Simulation
from ...simulation.step import Status, add_forces, end_step, observe
from ...vehicle.body_tree import build_body_table
from ...vehicle.coil import drive_coils
from ..case import MEASURING, RATES, prepare, record, settling
from .pinocchio_tree import BodyAccelerations, PinocchioTree, relative_difference


class PinocchioSimulation(Simulation):
    """A `Simulation` whose accelerations are Pinocchio's, in Python step by step: some hundred times slower.

    Attributes
    ----------
    difference : float
        Greatest difference so far between our accelerations and Pinocchio's from the same state and forces, over the
        largest of Pinocchio's (linear, angular and hinge accelerations each for themselves).
    """

    def __init__(self, vehicle, settings, probes=()):
        super().__init__(vehicle, settings, probes)
        self.difference = 0.0
        self._pinocchio = PinocchioTree(build_body_table(vehicle), self.system.tree.gravity)

    def advance(self, demanded):
        """As `Simulation.advance`."""
        system, state, work, road = self.system, self.state, self._work, self._road_around(1)
        for step in range(self.settings.rates.steps):
            drive_coils(system.coil, demanded, state.coils)
            add_forces(system, state, road, work)
            self._solve()
            status = end_step(system, state, road, work, self.points, self._next, step)
            if status != Status.GOOD:
                self._end_periods(status, 0)
        observe(system, state, work.motion, self._next)
        self._end_periods(Status.GOOD, 1)

    def advance_many(self, demanded, force, probed, speed):
        """As `Simulation.advance_many`."""
        for k in range(len(speed)):
            self.advance(demanded)
            sample = self.sample
            force[k], probed[k], speed[k] = sample.specific_force, sample.probed, sample.hull_velocity[0, 0]

    def _solve(self):
        """Fill the response with Pinocchio's accelerations and note how far ours are from them."""
        tree, work = self.system.tree, self._work
        loads = added_loads(tree, work)
        solve_accelerations(tree, work.motion, work.cuts, work.response)
        ours = solved(tree, work)
        theirs = self._pinocchio.solve(to_table(tree, self.state.tree), loads)
        self.difference = np.maximum(self.difference, relative_difference(ours, theirs))  # a nan must show
        put_back(tree, work, theirs)


def added_loads(tree, work):
    """Return the `Loads` that forces have added to the cuts of a `vehicle.system.Work`, as long as it is not solved."""
    own = new_cuts(tree)
    open_cuts(tree, work.motion, new_rows(tree), own)
    first, count = CutOffset.FORCE, CutOffset.TORQUE + 1 - CutOffset.FORCE
    added = (columns(work.cuts, first, count) - columns(own, first, count))[tree.row]
    moment, torque = CutOffset.MOMENT - first, CutOffset.TORQUE - first
    return Loads(added[:, :moment], added[:, moment:torque], added[:, torque], np.zeros(len(tree.row)))


def solved(tree, work):
    """Return the `BodyAccelerations` in the response of a `vehicle.system.Work`."""
    linear = (
        columns(work.response, ResponseOffset.LINEAR, 3) + columns(work.motion, MotionOffset.DRIFT, 3) + tree.gravity
    )
    angular = columns(work.response, ResponseOffset.ANGULAR, 3) + columns(work.motion, MotionOffset.ANGULAR_DRIFT, 3)
    return BodyAccelerations(
        *(part[tree.row] for part in (linear, angular, columns(work.response, ResponseOffset.HINGE, 1)[:, 0]))
    )


def put_back(tree, work, found):
    """Write `BodyAccelerations` into the response of a `vehicle.system.Work`, where they count from free fall."""
    w = len(tree.lanes)
    linear = found.linear - tree.gravity - columns(work.motion, MotionOffset.DRIFT, 3)[tree.row]
    angular = found.angular - columns(work.motion, MotionOffset.ANGULAR_DRIFT, 3)[tree.row]
    by_lane = work.response.cells.reshape(-1, ResponseOffset.SIZE, w)
    by_lane[tree.row // w, :, tree.row % w] = np.column_stack((linear, angular, found.hinge))


SOLVERS = {"Rui method": Simulation, "Pinocchio": PinocchioSimulation}


class Comparison(NamedTuple):
    """One case by both solvers."""

    drives: dict  # solver -> `drive.Drive`
    difference: float  # greatest one of accelerations from the same state, as in `PinocchioSimulation`

    def levels(self):
        """Return solver -> sensor -> RMS (3,) of the accelerations [m/s^2]."""
        return {
            solver: {sensor: rms(drive.limited[sensor]) for sensor in SENSORS} for solver, drive in self.drives.items()
        }


def compare(vehicle, case, progress, duration=MEASURING):
    """Drive a case by both solvers; returns a `Comparison`.

    `progress(solver, share)` is called now and then with the part of the run that the solver has done.

    Raises
    ------
    RunFailed
        The state left what the model can describe.
    """
    drives, periods = {}, (settling(case.speed) + duration) * RATES.control
    for solver, kind in SOLVERS.items():
        simulation, road = prepare(vehicle, case, kind)
        drives[solver] = record(
            simulation, road, duration, lambda done, solver=solver: progress(solver, min(done / periods, 1.0))
        )
    return Comparison(drives, simulation.difference)
