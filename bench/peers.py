"""The same tree in other engines: Pinocchio, MuJoCo and Drake, each behind the same two methods.

Every peer is made from a table of bodies (`trackvib_sim.rui.table`; revolute and prismatic hinges, one free root).
`accelerations(state, torque)` takes coordinates in the order of the table (`trackvib_sim.rui.state`) and returns
(6 + hinges,): acceleration of the root's origin, its angular acceleration (global axes), hinge accelerations.
`calls(count)` returns functions, by name, that evaluate the last state `count` times.
"""

import ctypes

import numpy as np
from numba import njit
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.state import rest_state


class PinocchioTree:
    """Pinocchio's articulated-body algorithm, in both of its conventions."""

    name = "Pinocchio"

    def __init__(self, bodies, gravity):
        import pinocchio as pin

        self._pin = pin
        self._model = model = pin.Model()
        model.gravity.linear = np.array(gravity, dtype=float)
        joints = {}
        for body in _depth_first(bodies):
            parent, place, joint = 0, np.zeros(3), pin.JointModelFreeFlyer()
            if body.hinge is not None:
                parent, place, joint = joints[body.hinge.parent], np.array(body.hinge.place), self._joint(body.hinge)
            joints[body.name] = model.addJoint(parent, joint, pin.SE3(np.eye(3), place.astype(float)), body.name)
            inertia = pin.Inertia(body.mass, np.array(body.centre, dtype=float), np.array(body.inertia, dtype=float))
            model.appendBodyToJoint(joints[body.name], inertia, pin.SE3.Identity())
        own = [model.joints[joints[body.name]] for body in bodies[1:]]
        self._hinge = np.array([joint.idx_q for joint in own], dtype=int), np.array([j.idx_v for j in own], dtype=int)
        self._data = model.createData()
        self._q, self._v, self._tau = pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)

    def _joint(self, hinge):
        """The specialised joint where the axis is one of the body's own: it is the faster one."""
        pin, axis = self._pin, np.array(hinge.axis, dtype=float)
        special = {
            "revolute": (pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ, pin.JointModelRevoluteUnaligned),
            "prismatic": (pin.JointModelPX, pin.JointModelPY, pin.JointModelPZ, pin.JointModelPrismaticUnaligned),
        }[hinge.kind]
        for k in range(3):
            if np.array_equal(axis, np.eye(3)[k]):
                return special[k]()
        return special[3](axis / np.linalg.norm(axis))

    def accelerations(self, state, torque):
        """See the module."""
        turn = Rotation.from_quat(np.roll(state.attitude[0], -1))
        self._q[:3], self._q[3:7] = state.position[0], turn.as_quat()
        self._v[:3], self._v[3:6] = turn.inv().apply(state.velocity[0]), turn.inv().apply(state.angular_velocity[0])
        q, v = self._hinge
        self._q[q], self._v[v], self._tau[v] = state.hinge[1:], state.hinge_rate[1:], torque[1:]
        a = self._pin.aba(self._model, self._data, self._q, self._v, self._tau)
        linear = turn.apply(a[:3]) + np.cross(state.angular_velocity[0], state.velocity[0])
        return np.concatenate((linear, turn.apply(a[3:6]), a[v]))

    def calls(self, count):
        """See the module."""
        aba, arguments = self._pin.aba, (self._model, self._data, self._q, self._v, self._tau)

        def loop(*convention):
            for _ in range(count):
                aba(*arguments, *convention)

        conventions = getattr(self._pin, "Convention", None)
        if conventions is None:  # before version 3
            return {"aba": loop}
        return {"aba, local": lambda: loop(conventions.LOCAL), "aba, world": lambda: loop(conventions.WORLD)}


def aba_tasks(bodies, gravity, count):
    """Return functions, by tree or one body and by convention, that call Pinocchio's aba `count` times."""
    peers = {"tree": (bodies, PinocchioTree(bodies, gravity)), "one": (bodies[:1], PinocchioTree(bodies[:1], gravity))}
    for table, peer in peers.values():
        state = rest_state(table)
        peer.accelerations(state, np.zeros(len(state.hinge)))
    return {(name, how): task for name, (_, peer) in peers.items() for how, task in peer.calls(count).items()}


def aba_time(times, count):
    """Return the time of a call of aba on the tree [s], the call from Python taken off.

    `times` are those of `aba_tasks` by the same names; the quicker convention counts.
    """
    return min(times["tree", how] - times["one", how] for name, how in times if name == "tree") / count


class MujocoTree:
    """MuJoCo's `mj_forward` without contacts, called in a compiled loop."""

    name = "MuJoCo"

    def __init__(self, bodies, gravity):
        import mujoco

        self._mujoco = mujoco
        spec = mujoco.MjSpec()
        spec.option.gravity = gravity
        spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT
        kinds = {"revolute": mujoco.mjtJoint.mjJNT_HINGE, "prismatic": mujoco.mjtJoint.mjJNT_SLIDE}
        made = {}
        for body in bodies:
            hinge, i = body.hinge, np.array(body.inertia, dtype=float)
            parent = spec.worldbody if hinge is None else made[hinge.parent]
            made[body.name] = each = parent.add_body(name=body.name, pos=(0, 0, 0) if hinge is None else hinge.place)
            each.mass, each.ipos, each.explicitinertial = body.mass, np.array(body.centre, dtype=float), True
            each.fullinertia = (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
            if hinge is None:
                each.add_freejoint(name=body.name)
            else:
                each.add_joint(name=body.name, type=kinds[hinge.kind], axis=np.array(hinge.axis, dtype=float))
        self._model = spec.compile()
        self._data = mujoco.MjData(self._model)
        joints = [self._model.joint(body.name) for body in bodies[1:]]
        self._hinge = tuple(
            np.array([getattr(joint, item)[0] for joint in joints], dtype=int) for item in ("qposadr", "dofadr")
        )

    def accelerations(self, state, torque):
        """See the module."""
        data, turn, (q, v) = self._data, Rotation.from_quat(np.roll(state.attitude[0], -1)), self._hinge
        data.qpos[:3], data.qpos[3:7] = state.position[0], state.attitude[0]
        data.qvel[:3], data.qvel[3:6] = (
            state.velocity[0],
            turn.inv().apply(state.angular_velocity[0]),
        )  # the rate in body axes
        data.qpos[q], data.qvel[v], data.qfrc_applied[v] = state.hinge[1:], state.hinge_rate[1:], torque[1:]
        self._mujoco.mj_forward(self._model, data)
        return np.concatenate((data.qacc[:3], turn.apply(data.qacc[3:6]), data.qacc[v]))

    def calls(self, count):
        """See the module."""
        with open("/proc/self/maps") as maps:
            library = next(line.split()[-1] for line in maps if "libmujoco" in line)
        forward = ctypes.CDLL(library).mj_forward
        forward.argtypes, forward.restype = [ctypes.c_void_p, ctypes.c_void_p], None

        @njit
        def loop(model, data, count):
            for _ in range(count):
                forward(model, data)

        arguments = self._model._address, self._data._address
        loop(*arguments, 1)
        return {"mj_forward": lambda: loop(*arguments, count)}


class DrakeTree:
    """Drake's `MultibodyPlant`: time derivatives of the continuous plant, nothing remembered between calls."""

    name = "Drake"

    def __init__(self, bodies, gravity):
        from pydrake.math import RigidTransform
        from pydrake.multibody import tree
        from pydrake.multibody.plant import MultibodyPlant

        self._plant = plant = MultibodyPlant(time_step=0.0)
        plant.mutable_gravity_field().set_gravity_vector(np.array(gravity, dtype=float))
        kinds = {"revolute": tree.RevoluteJoint, "prismatic": tree.PrismaticJoint}
        for body in bodies:
            i, centre = np.array(body.inertia, dtype=float), np.array(body.centre, dtype=float)
            central = tree.RotationalInertia(i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
            inertia = tree.SpatialInertia.MakeFromCentralInertia(body.mass, centre, central)
            child, hinge = plant.AddRigidBody(body.name, inertia), body.hinge
            if hinge is not None:
                place = RigidTransform(np.array(hinge.place, dtype=float))
                on = plant.GetBodyByName(hinge.parent).body_frame()
                frame = plant.AddFrame(tree.FixedOffsetFrame(f"at {body.name}", on, place))
                axis = np.array(hinge.axis, dtype=float)
                plant.AddJoint(kinds[hinge.kind](body.name, frame, child.body_frame(), axis))
        plant.Finalize()
        joints = [plant.GetJointByName(body.name) for body in bodies[1:]]
        positions = plant.num_positions()
        self._hinge = (
            np.array([joint.position_start() for joint in joints], dtype=int),
            np.array([positions + joint.velocity_start() for joint in joints], dtype=int),
        )
        self._context = plant.CreateDefaultContext()
        self._x = np.zeros(positions + plant.num_velocities())

    def accelerations(self, state, torque):
        """See the module."""
        plant, x, (q, v) = self._plant, self._x, self._hinge
        p = plant.num_positions()
        x[:4], x[4:7], x[p : p + 3], x[p + 3 : p + 6] = (
            state.attitude[0], state.position[0], state.angular_velocity[0], state.velocity[0],
        )  # fmt: skip
        x[q], x[v] = state.hinge[1:], state.hinge_rate[1:]
        applied = np.zeros(plant.num_velocities())
        applied[v - p] = torque[1:]
        plant.get_applied_generalized_force_input_port().FixValue(self._context, applied)
        plant.SetPositionsAndVelocities(self._context, x)
        a = plant.EvalTimeDerivatives(self._context).CopyToVector()
        return np.concatenate((a[p + 3 : p + 6], a[p : p + 3], a[v]))

    def calls(self, count):
        """See the module."""
        plant, context, x = self._plant, self._context, self._x

        def loop():
            for _ in range(count):
                plant.SetPositionsAndVelocities(context, x)  # or it would return what it has
                plant.EvalTimeDerivatives(context)

        return {"EvalTimeDerivatives": loop}


def _depth_first(bodies):
    """Bodies in the order in which Pinocchio numbers its joints."""
    children = {}
    for body in bodies[1:]:
        children.setdefault(body.hinge.parent, []).append(body)
    stack = [bodies[0]]
    while stack:
        body = stack.pop()
        yield body
        stack += reversed(children.get(body.name, []))
