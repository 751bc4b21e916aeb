"""A table of bodies in Pinocchio, an engine that shares nothing with ours but the table."""

from typing import NamedTuple

import numpy as np

from ...extras import require

require("studies", "pinocchio")

import pinocchio as pin  # noqa: E402

from ...rui.reference.placement import parent_rows  # noqa: E402
from ...rui.state import free_bodies  # noqa: E402

_JOINTS = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}


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
    """A table of bodies in Pinocchio: articulated-body algorithm. What an elastic hinge does is among the loads."""

    def __init__(self, bodies, gravity):
        self._model, self._joints, within = pinocchio_model(bodies, gravity)
        self._arms = np.array([pin.skew(place.translation) for place in within])  # of the origins, in the joints' axes
        self._data = self._model.createData()
        self._free = [self._model.joints[self._joints[row]] for row in free_bodies(bodies)]
        moving = {row: self._model.joints[self._joints[row]] for row in _moving(bodies)}
        self._rows = list(moving)
        self._q_of, self._v_of = [joint.idx_q for joint in moving.values()], [joint.idx_v for joint in moving.values()]
        self._frames = [self._model.getFrameId(body.name, pin.FrameType.BODY) for body in bodies]
        # Views of Pinocchio's own numbers: to ask for each of them anew takes longer than its algorithm.
        self._attitudes = [self._data.oMf[frame].rotation for frame in self._frames]
        self._external = pin.StdVec_Force()
        self._external.extend(pin.Force.Zero() for _ in range(self._model.njoints))
        self._wrenches = [force.vector for force in self._external]
        self._q, self._v, self._torque = pin.neutral(self._model), np.zeros(self._model.nv), np.zeros(self._model.nv)

    def solve(self, state, loads):
        """Return the `BodyAccelerations` in a state under loads (`rui.state`), all in the order of the table."""
        model, data, q, v, torque = self._model, self._data, self._q, self._v, self._torque
        for k, joint in enumerate(self._free):
            w, *imaginary = state.attitude[k]
            to_local = pin.Quaternion(w, *imaginary).matrix().T
            q[joint.idx_q : joint.idx_q + 7] = *state.position[k], *imaginary, w
            speeds = to_local @ np.stack((state.velocity[k], state.angular_velocity[k]), axis=1)
            v[joint.idx_v : joint.idx_v + 6] = speeds.T.ravel()
        q[self._q_of], v[self._v_of] = state.hinge[self._rows], state.hinge_rate[self._rows]
        torque[self._v_of] = loads.torque[self._rows]
        pin.framesForwardKinematics(model, data, q)
        self._load(loads)
        a = pin.aba(model, data, q, v, torque, self._external).copy()
        pin.forwardKinematics(model, data, q, v, a)
        axes = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        linear = [pin.getFrameClassicalAcceleration(model, data, frame, axes).linear for frame in self._frames]
        angular = [pin.getFrameAcceleration(model, data, frame, axes).angular for frame in self._frames]
        hinge = np.zeros(len(self._joints))
        hinge[self._rows] = a[self._v_of]
        return BodyAccelerations(np.array(linear), np.array(angular), hinge)

    def _load(self, loads):
        """Let loads on bodies act on their joints, about the joints' origins and in their axes."""
        to_local = np.array(self._attitudes).transpose(0, 2, 1)
        force, moment = to_local @ loads.force[:, :, None], to_local @ loads.moment[:, :, None]
        total = np.zeros((len(self._wrenches), 6))
        np.add.at(total, self._joints, np.hstack((force, moment + self._arms @ force))[:, :, 0])
        for wrench, new in zip(self._wrenches, total, strict=True):
            wrench[:] = new


def _moving(bodies):
    return [row for row, body in enumerate(bodies) if body.hinge is not None and body.hinge.kind in _JOINTS]


def pinocchio_model(bodies, gravity):
    """Return the model, and of every body its joint and its place in that; branches one after the other, depth first.

    A body on an elastic hinge is as free as the root; one on a locked hinge is part of its parent's joint.

    Raises
    ------
    ValueError
        A hinge has a prescribed motion.
    """
    model, parents = pin.Model(), parent_rows(bodies)
    joints, within = [0] * len(bodies), [pin.SE3.Identity() for _ in bodies]
    model.gravity.linear = np.asarray(gravity, dtype=float)

    def add(row):
        body, hinge, parent = bodies[row], bodies[row].hinge, parents[row]
        if hinge is None or hinge.kind == "elastic":
            joints[row] = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), body.name)
        elif hinge.prescribed:
            raise ValueError(f"hinge {hinge.number} has a prescribed motion")
        else:
            place = within[parent] * pin.SE3(np.eye(3), np.asarray(hinge.place, dtype=float))
            if hinge.kind in _JOINTS:
                axis = np.asarray(hinge.axis, dtype=float)
                joint = _JOINTS[hinge.kind](axis / np.linalg.norm(axis))
                joints[row] = model.addJoint(joints[parent], joint, place, body.name)
            else:
                joints[row], within[row] = joints[parent], place
        inertia = pin.Inertia(body.mass, np.asarray(body.centre, dtype=float), np.asarray(body.inertia, dtype=float))
        model.appendBodyToJoint(joints[row], inertia, within[row])
        model.addFrame(pin.Frame(body.name, joints[row], 0, within[row], pin.FrameType.BODY))
        for child in np.flatnonzero(np.asarray(parents) == row):
            add(child)

    add(0)
    return model, joints, within
