"""Closed chains for the tests, and all their equations as dense algebra."""

import numpy as np
import pinocchio as pin
from scipy.linalg import null_space
from scipy.spatial.transform import Rotation
from trackvib_sim.rui.cut_pin import CutPin
from trackvib_sim.rui.reference.placement import parent_rows
from trackvib_sim.rui.state import Loads, no_loads, rest_state
from trackvib_sim.rui.table import Body, Hinge

GRAVITY = np.array([0.0, 0.0, -9.81])
ROUNDING = 1e-9  # of the largest; the longest chains leave some 1e-11
FRAME = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


class DenseChain:
    """All equations of a closed chain in Pinocchio's coordinates: mass matrix, bias, five equations for every pin."""

    def __init__(self, bodies, pins, state, gravity=GRAVITY):
        self.bodies, self.model, n = bodies, pin.Model(), len(bodies)
        self.model.gravity.linear = np.asarray(gravity, dtype=float)
        parents, self.joints = parent_rows(bodies), [0] * n
        self._add(0, parents)
        self.data, self.q, self.v = self.model.createData(), pin.neutral(self.model), np.zeros(self.model.nv)
        w, *xyz = state.attitude[0]
        self.to_global = Rotation.from_quat(state.attitude[0], scalar_first=True).as_matrix()
        self.q[:7] = *state.position[0], *xyz, w
        self.v[:6] = *(self.to_global.T @ state.velocity[0]), *(self.to_global.T @ state.angular_velocity[0])
        for row in range(1, n):
            joint = self.model.joints[self.joints[row]]
            self.q[joint.idx_q], self.v[joint.idx_v] = state.hinge[row], state.hinge_rate[row]
        self.jacobian, self.bias = self._closure(pins)

    def _add(self, row, parents):
        body, parent, place, joint = self.bodies[row], 0, np.zeros(3), pin.JointModelFreeFlyer()
        if row:
            parent, place = self.joints[parents[row]], np.asarray(body.hinge.place, dtype=float)
            kind = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}
            joint = kind[body.hinge.kind](np.asarray(body.hinge.axis) / np.linalg.norm(body.hinge.axis))
        self.joints[row] = self.model.addJoint(parent, joint, pin.SE3(np.eye(3), place), body.name)
        inertia = pin.Inertia(body.mass, np.asarray(body.centre, dtype=float), np.asarray(body.inertia))
        self.model.appendBodyToJoint(self.joints[row], inertia, pin.SE3.Identity())
        for child in [child for child, p in enumerate(parents) if p == row]:
            self._add(child, parents)

    def _closure(self, pins):
        """Jacobian and bias of B's point less A's and of the turning across the axis; T alone is turned by body a."""
        model, data, ends = self.model, self.data, []
        rows = {body.name: row for row, body in enumerate(self.bodies)}
        for k, each in enumerate(pins):
            ends.append([
                model.addFrame(pin.Frame(f"{k}{name}", self.joints[rows[name]], 0,
                                         pin.SE3(np.eye(3), np.array(place, float)), pin.FrameType.OP_FRAME))
                for name, place in ((each.body_a, each.point_a), (each.body_b, each.point_b))
            ])  # fmt: skip
        self.data = data = model.createData()
        pin.computeJointJacobians(model, data, self.q)
        pin.forwardKinematics(model, data, self.q, self.v, np.zeros(model.nv))
        pin.updateFramePlacements(model, data)
        jacobians, biases = [], []
        for each, (a, b) in zip(pins, ends, strict=True):
            across = data.oMf[a].rotation @ null_space(np.array([each.axis], dtype=float))
            J = pin.getFrameJacobian(model, data, b, FRAME) - pin.getFrameJacobian(model, data, a, FRAME)
            bias = [
                getattr(pin.getFrameClassicalAcceleration(model, data, b, FRAME), part)
                - getattr(pin.getFrameClassicalAcceleration(model, data, a, FRAME), part)
                for part in ("linear", "angular")
            ]
            rate_a = pin.getFrameVelocity(model, data, a, FRAME).angular
            relative = J[3:] @ self.v  # along the axis, with which it turns
            jacobians += [J[:3], across.T @ J[3:]]
            biases += [bias[0], across.T @ (bias[1] - np.cross(rate_a, relative))]
        return np.vstack(jacobians), np.concatenate(biases)

    def project(self, state, speeds):
        """Return the state with those of the speeds that the closure allows."""
        free = null_space(self.jacobian, rcond=1e-10)
        return self._with_speeds(state, free @ (free.T @ speeds))

    def _with_speeds(self, state, v):
        return state._replace(velocity=(self.to_global @ v[:3])[None], angular_velocity=(self.to_global @ v[3:6])[None],
                              hinge_rate=self._hinges(v))  # fmt: skip

    def _hinges(self, v):
        return np.array([0.0, *(v[self.model.joints[joint].idx_v] for joint in self.joints[1:])])

    def accelerations(self, loads):
        """Return linear, angular and hinge accelerations; a = particular + free y, of M a = f projected on free."""
        model, data = self.model, self.data
        free = null_space(self.jacobian, rcond=1e-10)
        particular = -np.linalg.pinv(self.jacobian, rcond=1e-10) @ self.bias
        force = self._force(loads) - pin.nonLinearEffects(model, data, self.q, self.v)
        mass = pin.crba(model, data, self.q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        y = np.linalg.solve(free.T @ mass @ free, free.T @ (force - mass @ particular))
        a = particular + free @ y
        pin.forwardKinematics(model, data, self.q, self.v, a)
        linear = [pin.getClassicalAcceleration(model, data, joint, FRAME).linear for joint in self.joints]
        angular = [pin.getAcceleration(model, data, joint, FRAME).angular for joint in self.joints]
        return np.array(linear), np.array(angular), self._hinges(a)

    def hinges_by_inverse(self, loads, axis):
        """Return hinge accelerations from O(n) parts and the closure equations across a global axis: more accurate."""
        model, data, across = self.model, self.data, null_space(axis[None])
        J, bias = across.T @ self.jacobian[:3], across.T @ self.bias[:3]
        a = pin.aba(model, data, self.q, self.v, self._force(loads)).copy()
        inverse = pin.computeMinverse(model, data, self.q)
        inverse = np.triu(inverse) + np.triu(inverse, 1).T
        return self._hinges(a - inverse @ J.T @ np.linalg.solve(J @ inverse @ J.T, J @ a + bias))

    def _force(self, loads):
        model, data = self.model, self.data
        force = np.zeros(model.nv)
        pin.computeJointJacobians(model, data, self.q)
        for row, joint in enumerate(self.joints):
            wrench = np.concatenate((loads.force[row], loads.moment[row]))
            force += pin.getJointJacobian(model, data, joint, FRAME).T @ wrench
            if row:
                force[model.joints[joint].idx_v] += loads.torque[row]
        return force


def _random_body(random, number, name, turn, length, hinge):
    mass, sides = random.uniform(5.0, 20.0), length * np.array([1.0, *random.uniform(0.2, 0.6, 2)])
    axes = turn @ Rotation.from_rotvec(0.2 * random.normal(size=3)).as_matrix()
    inertia = axes @ np.diag(mass / 12.0 * (np.sum(sides**2) - sides**2)) @ axes.T
    return Body(number, name, mass, turn @ (0.5 * length, 0.1 * length, 0.05 * length), inertia, hinge)


def polygon(seed, links, axis=None):
    """An irregular closed polygon of links, in planes across any axis: table, cut pin, state, random loads.

    The links' points are not in one plane but in parallel ones. Free, turning and moving as the closure allows.
    """
    random = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(random.normal(size=3)).as_matrix()  # plane of the polygon -> body axes
    angle = 2.0 * np.pi * (np.arange(links) + random.uniform(-0.2, 0.2, links)) / links
    corner = random.uniform(0.9, 1.1, links)[:, None] * np.array([np.cos(angle), np.sin(angle)]).T
    side = np.roll(corner, -1, axis=0) - corner
    length, heading = np.linalg.norm(side, axis=1), np.arctan2(side[:, 1], side[:, 0])
    height = np.append(0.1 * random.normal(size=links - 1), 0.0)
    height[-1] = -np.sum(height)
    bodies, end = [], None
    for k in range(links):
        hinge = Hinge(k, "revolute", f"link {k - 1}", end, 2.0 * turn[:, 2]) if k else None
        bodies.append(_random_body(random, k, f"link {k}", turn, length[k], hinge))
        end = turn @ (length[k], 0.0, height[k])
    cut = CutPin(f"link {links - 1}", end, "link 0", (0.0, 0.0, 0.0), turn[:, 2])
    state = rest_state(bodies)._replace(hinge=np.append(0.0, np.diff(heading)))
    state.position[0] = random.normal(size=3)
    state.attitude[0] = Rotation.from_rotvec(random.normal(size=3)).as_quat(scalar_first=True)
    state = DenseChain(bodies, [cut], state).project(state, random.normal(size=links + 5))
    loads = Loads(*(100.0 * random.normal(size=shape) for shape in ((links, 3), (links, 3), links)), np.zeros(links))
    return bodies, cut, state, loads


def ladders(seed, loops):
    """A bush: from one root, pairs of branches of two bodies (one slides) joined by a pin, each pair with its axis."""
    random = np.random.default_rng(seed)
    bodies, pins = [_random_body(random, 0, "root", np.eye(3), 1.0, None)], []
    hinges = [0.0]
    for k in range(loops):
        turn = Rotation.from_rotvec(random.normal(size=3)).as_matrix()
        foot = random.normal(size=3)
        # triangle of feet (0, 0) and (1, 0), tip near (0.4, 0.8); the left leg turns and slides, the right has a knee
        tip, knee = np.array([0.4, 0.8, 0.0]) + [*random.uniform(-0.1, 0.1, 2), 0.0], np.array([1.3, 0.6, 0.0])
        for name, parent, kind, place, axis in (
            (f"left {k}", "root", "revolute", foot, turn[:, 2]),
            (f"rod {k}", f"left {k}", "prismatic", turn @ (0.1, 0.1, 0.0), turn @ (0.4, 0.8, 0.0)),
            (f"right {k}", "root", "revolute", foot + turn[:, 0], turn[:, 2]),
            (f"shin {k}", f"right {k}", "revolute", turn @ (knee - (1.0, 0.0, 0.0)), turn[:, 2]),
        ):
            number = len(bodies)
            bodies.append(_random_body(random, number, name, turn, 0.8, Hinge(number, kind, parent, place, axis)))
            hinges.append(0.0)
        pins.append(CutPin(f"rod {k}", turn @ (tip - (0.1, 0.1, 0.0)), f"shin {k}", turn @ (tip - knee), turn[:, 2]))
    state, n = rest_state(bodies)._replace(hinge=np.array(hinges)), len(bodies)
    state.attitude[0] = Rotation.from_rotvec(random.normal(size=3)).as_quat(scalar_first=True)
    state = DenseChain(bodies, pins, state).project(state, random.normal(size=n + 5))
    loads = Loads(*(100.0 * random.normal(size=shape) for shape in ((n, 3), (n, 3), n)), np.zeros(n))
    return bodies, pins, state, loads


def parallelogram(angle, rate, rod=3.0):
    """Two equal cranks, one rod, on a body too heavy to move; axes y, cranks down at angle 0."""
    length, gap, heavy = 0.8, 1.5, 1e12
    bodies = [
        Body(0, "base", heavy, (0, 0, 0), heavy * np.eye(3)),
        Body(1, "left", 2.0, (0, 0, -0.3), 0.2 * np.eye(3), Hinge(1, "revolute", "base", (0, 0, 0), (0, 1, 0))),
        Body(2, "rod", rod, (0.7, 0, 0.1), 0.4 * np.eye(3),
             Hinge(2, "revolute", "left", (0, 0, -length), (0, 1, 0))),
        Body(3, "right", 1.0, (0, 0, -0.5), 0.1 * np.eye(3), Hinge(3, "revolute", "base", (gap, 0, 0), (0, 1, 0))),
    ]  # fmt: skip
    cut = CutPin("rod", (gap, 0, 0), "right", (0, 0, -length), (0, 1, 0))
    state, loads = rest_state(bodies), no_loads(bodies)
    state.hinge[1:], state.hinge_rate[1:] = (angle, -angle, angle), (rate, -rate, rate)
    loads.force[0, 2] = heavy * 9.81
    return bodies, cut, state, loads
