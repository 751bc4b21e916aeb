"""The vehicle with its body tree solved by Pinocchio, the second solver: it plays the part of ADAMS in [Tao2025].

Forces, integration and measuring are the simulation's own. What hinges, suspension, tracks, mounts, engine and driver
add to the cuts goes to Pinocchio as external wrenches and hinge torques; kinematics, inertia and with them all
accelerations are Pinocchio's.
"""

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from ..rui.cells import columns
from ..rui.cuts import FORCE, MOMENT, TORQUE, new_cuts, open_cuts
from ..rui.kinematics import ANGULAR_DRIFT, DRIFT
from ..rui.placement import parent_rows
from ..rui.riccati import ANGULAR, HINGE, LINEAR, RESPONSE, solve_accelerations
from ..rui.state import Loads
from ..rui.tree import new_rows, to_table
from ..simulation.simulation import Simulation
from ..simulation.step import GOOD, add_forces, end_step, observe
from ..vehicle.body_tree import body_table
from ..vehicle.coil import drive_coils


class BodyAccelerations(NamedTuple):
    """How the bodies of a table accelerate, global axes."""

    linear: np.ndarray  # (n, 3) of the origin, m/s^2
    angular: np.ndarray  # (n, 3) rad/s^2
    hinge: np.ndarray  # (n,) rad/s^2 or m/s^2, the root's is 0


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
        self._pinocchio = PinocchioTree(body_table(vehicle), self.system.tree.gravity)

    def advance(self, demanded):
        """As `Simulation.advance`."""
        system, state, work, road = self.system, self.state, self._work, self._stretch(1)
        steps = self.settings.rates.steps
        self._next.specific_force[:] = self._next.rate[:] = 0.0
        for _ in range(steps):
            drive_coils(system.coil, demanded, state.currents)
            add_forces(system, state, road, work)
            self._solve()
            status = end_step(system, state, road, work, self.sensors, self._next, 1.0 / steps)
            if status != GOOD:
                self._end_periods(status, 0)
        observe(system, state, work.motion, self._next)
        self._end_periods(GOOD, 1)
        self.sample, self._next = self._next, self.sample

    def advance_many(self, demanded, force, speed):
        """As `Simulation.advance_many`."""
        for k in range(len(speed)):
            self.advance(demanded)
            force[k], speed[k] = self.sample.specific_force, self.sample.hull_velocity[0, 0]

    def _solve(self):
        """Fill the response with Pinocchio's accelerations and note how far ours are from them."""
        tree, work = self.system.tree, self._work
        loads = added_loads(tree, work)
        solve_accelerations(tree, work.motion, work.cuts, work.response)
        ours = solved(tree, work)
        theirs = self._pinocchio.solve(to_table(tree, self.state.tree), loads)
        self.difference = max(self.difference, relative_difference(ours, theirs))
        put_back(tree, work, theirs)


def added_loads(tree, work):
    """Return the `Loads` that forces have added to the cuts of a `vehicle.system.Work`, as long as it is not solved."""
    own = new_cuts(tree)
    open_cuts(tree, work.motion, new_rows(tree), own)
    force, moment, torque = (
        (columns(work.cuts, first, count) - columns(own, first, count))[tree.row]
        for first, count in ((FORCE, 3), (MOMENT, 3), (TORQUE, 1))
    )
    return Loads(force, moment, torque[:, 0], np.zeros(len(tree.row)))


def solved(tree, work):
    """Return the `BodyAccelerations` in the response of a `vehicle.system.Work`."""
    linear = columns(work.response, LINEAR, 3) + columns(work.motion, DRIFT, 3) + tree.gravity
    angular = columns(work.response, ANGULAR, 3) + columns(work.motion, ANGULAR_DRIFT, 3)
    return BodyAccelerations(*(part[tree.row] for part in (linear, angular, columns(work.response, HINGE, 1)[:, 0])))


def put_back(tree, work, found):
    """Write `BodyAccelerations` into the response of a `vehicle.system.Work`, where they count from free fall."""
    w = len(tree.lanes)
    linear = found.linear - tree.gravity - columns(work.motion, DRIFT, 3)[tree.row]
    angular = found.angular - columns(work.motion, ANGULAR_DRIFT, 3)[tree.row]
    by_lane = work.response.cells.reshape(-1, RESPONSE, w)
    by_lane[tree.row // w, :, tree.row % w] = np.column_stack((linear, angular, found.hinge))


def relative_difference(found, reference):
    """Return the largest difference of two `BodyAccelerations` over the largest entry of the reference, kind by kind."""
    pairs = zip(found, reference, strict=True)
    return max(np.abs(one - other).max() / np.abs(other).max() for one, other in pairs)


class PinocchioTree:
    """A table of bodies (revolutes and slides, one free root) in Pinocchio: articulated-body algorithm."""

    def __init__(self, bodies, gravity):
        self._model, self._joints = _model(bodies, gravity)
        self._data = self._model.createData()
        hinges = [self._model.joints[joint] for joint in self._joints[1:]]
        self._q_of, self._v_of = [hinge.idx_q for hinge in hinges], [hinge.idx_v for hinge in hinges]
        self._q, self._v, self._torque = pin.neutral(self._model), np.zeros(self._model.nv), np.zeros(self._model.nv)
        self._external = pin.StdVec_Force()
        for _ in range(self._model.njoints):
            self._external.append(pin.Force.Zero())

    def solve(self, state, loads):
        """Return the `BodyAccelerations` in a state under loads (`rui.state`), all in the order of the table."""
        model, data, q, v, torque = self._model, self._data, self._q, self._v, self._torque
        w, *imaginary = state.attitude[0]
        to_local = pin.Quaternion(w, *imaginary).matrix().T
        q[:7] = *state.position[0], *imaginary, w
        v[:6] = *(to_local @ state.velocity[0]), *(to_local @ state.rate[0])
        q[self._q_of], v[self._v_of], torque[self._v_of] = state.hinge[1:], state.hinge_rate[1:], loads.torque[1:]
        pin.forwardKinematics(model, data, q, v)
        for joint, force, moment in zip(self._joints, loads.force, loads.moment, strict=True):
            to_local = data.oMi[joint].rotation.T
            self._external[joint] = pin.Force(to_local @ force, to_local @ moment)
        a = pin.aba(model, data, q, v, torque, self._external).copy()
        pin.forwardKinematics(model, data, q, v, a)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        linear = [pin.getClassicalAcceleration(model, data, joint, axes).linear for joint in self._joints]
        angular = [pin.getAcceleration(model, data, joint, axes).angular for joint in self._joints]
        return BodyAccelerations(np.array(linear), np.array(angular), np.array([0.0, *a[self._v_of]]))


def _model(bodies, gravity):
    """Return the model and the joint of every body; Pinocchio wants branches one after the other, depth first."""
    model, joints, parents = pin.Model(), [0] * len(bodies), parent_rows(bodies)
    model.gravity.linear = np.asarray(gravity, dtype=float)
    kinds = {"revolute": pin.JointModelRevoluteUnaligned, "slide": pin.JointModelPrismaticUnaligned}

    def add(row):
        body = bodies[row]
        parent, joint, place = 0, pin.JointModelFreeFlyer(), np.zeros(3)
        if body.hinge is not None:
            axis = np.asarray(body.hinge.axis, dtype=float)
            parent, joint = joints[parents[row]], kinds[body.hinge.kind](axis / np.linalg.norm(axis))
            place = np.asarray(body.hinge.place, dtype=float)
        joints[row] = model.addJoint(parent, joint, pin.SE3(np.eye(3), place), body.name)
        inertia = pin.Inertia(body.mass, np.asarray(body.centre, dtype=float), np.asarray(body.inertia, dtype=float))
        model.appendBodyToJoint(joints[row], inertia, pin.SE3.Identity())
        for child in np.flatnonzero(np.asarray(parents) == row):
            add(child)

    add(0)
    return model, joints
