"""A table of bodies in Pinocchio, an engine that shares nothing with ours but the table."""

from typing import NamedTuple

import numpy as np
import pinocchio as pin

from ...rui.reference.placement import parent_rows


class BodyAccelerations(NamedTuple):
    """How the bodies of a table accelerate, global axes."""

    linear: np.ndarray  # (n, 3) of the origin, m/s^2
    angular: np.ndarray  # (n, 3) rad/s^2
    hinge: np.ndarray  # (n,) rad/s^2 or m/s^2, the root's is 0


def relative_difference(found, reference):
    """Return the largest difference of two `BodyAccelerations` over the reference's largest entry, kind by kind."""
    pairs = zip(found, reference, strict=True)
    return max(np.abs(one - other).max() / np.abs(other).max() for one, other in pairs)


class PinocchioTree:
    """A table of bodies (revolute and prismatic hinges, one free root) in Pinocchio: articulated-body algorithm."""

    def __init__(self, bodies, gravity):
        self._model, self._joints = pinocchio_model(bodies, gravity)
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
        v[:6] = *(to_local @ state.velocity[0]), *(to_local @ state.angular_velocity[0])
        q[self._q_of], v[self._v_of], torque[self._v_of] = state.hinge[1:], state.hinge_rate[1:], loads.torque[1:]
        pin.forwardKinematics(model, data, q, v)
        to_global = np.array([data.oMi[joint].rotation for joint in self._joints])
        wrenches = np.stack((loads.force, loads.moment), axis=1) @ to_global
        for joint, wrench in zip(self._joints, wrenches.reshape(-1, 6), strict=True):
            self._external[joint] = pin.Force(wrench)
        a = pin.aba(model, data, q, v, torque, self._external).copy()
        pin.forwardKinematics(model, data, q, v, a)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        linear = [pin.getClassicalAcceleration(model, data, joint, axes).linear for joint in self._joints]
        angular = [pin.getAcceleration(model, data, joint, axes).angular for joint in self._joints]
        return BodyAccelerations(np.array(linear), np.array(angular), np.array([0.0, *a[self._v_of]]))


def pinocchio_model(bodies, gravity):
    """Return the model and the joint of every body; Pinocchio wants branches one after the other, depth first.

    Raises
    ------
    ValueError
        A hinge is neither a free revolute nor a free prismatic hinge.
    """
    model, joints, parents = pin.Model(), [0] * len(bodies), parent_rows(bodies)
    model.gravity.linear = np.asarray(gravity, dtype=float)
    kinds = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}

    def add(row):
        body = bodies[row]
        parent, joint, place = 0, pin.JointModelFreeFlyer(), np.zeros(3)
        if body.hinge is not None:
            if body.hinge.kind not in kinds or body.hinge.prescribed:
                raise ValueError(f"hinge {body.hinge.number} is neither a free revolute nor a free prismatic hinge")
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
