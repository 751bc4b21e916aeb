"""An independent route to the linear equations of motion of a `LinearModel`.

Generalised forces by virtual work with every body's velocity per coordinate; their derivatives by complex steps, exact
to rounding. Nothing here is linearised by hand and no sweep is used: geometric stiffness comes out by itself.
"""

import numpy as np
from scipy.linalg import eig
from trackvib_sim.rui.state import free_bodies

STEP = 1e-30
ONE = np.eye(3)


def _cross(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _rotation(v):
    """Rotation matrix of a vector, complex allowed (Rodrigues; series near zero)."""
    square, V = np.sum(v * v), _cross(v)
    if abs(square) < 1e-8:
        return ONE + (1.0 - square / 6.0) * V + (0.5 - square / 24.0) * V @ V
    angle = np.sqrt(square)
    return ONE + np.sin(angle) / angle * V + (1.0 - np.cos(angle)) / square * V @ V


def _vector(R):
    """Rotation vector of a matrix, complex allowed."""
    twice = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    sine = 0.5 * np.sqrt(np.sum(twice * twice))
    if abs(sine) < 1e-3:
        return twice * (0.5 + sine**2 / 12.0 + 3.0 * sine**4 / 80.0 + 5.0 * sine**6 / 224.0)
    return twice * (0.5 * np.arctan(sine / (0.5 * (np.trace(R) - 1.0))) / sine)  # angles below a quarter turn


def _quaternion_matrix(w, x, y, z):
    v = np.array([x, y, z])
    return ONE + 2.0 * w * _cross(v) + 2.0 * _cross(v) @ _cross(v)


class Dense:
    """M, C, K of a model in its state: coordinates of free bodies (displacement, rotation), then of hinges."""

    def __init__(self, model):
        self.model, self.rows = model, {body.name: row for row, body in enumerate(model.bodies)}
        self.free = [row for row in free_bodies(model.bodies) if row or not model.fixed_root]
        self.hinges = [
            row
            for row, body in enumerate(model.bodies)
            if body.hinge is not None and body.hinge.kind in ("revolute", "prismatic") and not body.hinge.prescribed
        ]
        self.size = 6 * len(self.free) + len(self.hinges)
        rest = np.zeros(self.size)
        self.home = self.place(rest)
        self.K, self.C = np.zeros((self.size, self.size)), np.zeros((self.size, self.size))
        self.load = self.force(rest, rest).real
        for k in range(self.size):
            step = np.zeros(self.size, dtype=complex)
            step[k] = 1j * STEP
            self.K[:, k] = -self.force(step, rest).imag / STEP
            self.C[:, k] = -self.force(rest, step).imag / STEP
        _, rotation, _ = self.home
        self.M = np.zeros_like(self.K)
        for row, body in enumerate(model.bodies):
            linear, angular = self.jacobian(row, rotation[row] @ body.centre, self.home)
            turning = rotation[row].T @ angular
            self.M += body.mass * linear.T @ linear + turning.T @ body.inertia @ turning

    def eigenvalues(self):
        """omega^2 of the undamped system, ascending."""
        return np.sort(eig(self.K, self.M, right=False).real)

    def poles(self):
        """Poles with an imaginary part >= 0."""
        zero, one = np.zeros((self.size, self.size)), np.eye(self.size)
        lower = -np.linalg.solve(self.M, np.hstack((self.K, self.C)))
        poles = np.linalg.eigvals(np.vstack((np.hstack((zero, one)), lower)))
        return poles[poles.imag >= 0.0]

    def stiffness_at(self, s):
        """s^2 M + s C + K."""
        return s * s * self.M + s * self.C + self.K

    def coordinates(self, x, coordinate):
        """The coordinates (size,) of a motion x (n, 6) of the bodies and of the hinges (n,)."""
        return np.concatenate((x[self.free].ravel(), coordinate[self.hinges]))

    def direction(self, name, point, direction, turning=False):
        """Generalised force (size,) of a unit force (moment) on a point of a body."""
        row = self.rows[name]
        parts = self.jacobian(row, self.home[1][row] @ np.array(point), self.home)
        return parts[1 if turning else 0].T @ np.array(direction)

    def place(self, q):
        """Origins, rotations and, per body, the list of (coordinate, kind, axis, point) that move it."""
        model, origin, rotation, moved_by = self.model, {}, {}, {}
        of_free = {row: k for k, row in enumerate(free_bodies(model.bodies))}
        for row, body in enumerate(model.bodies):
            hinge = body.hinge
            if row in of_free:
                k = of_free[row]
                shift, turn, motions = np.zeros(3), ONE, []
                if row in self.free:
                    j = 6 * self.free.index(row)
                    shift, turn = q[j : j + 3], _rotation(q[j + 3 : j + 6])
                    motions = [(j, "free", None, None)]
                origin[row] = model.state.position[k] + shift
                rotation[row] = turn @ _quaternion_matrix(*model.state.attitude[k])
                moved_by[row] = [(c, kind, a, origin[row]) for c, kind, a, _ in motions]
                continue
            p = self.rows[hinge.parent]
            point, motions = origin[p] + rotation[p] @ np.array(hinge.place), list(moved_by[p])
            rotation[row], origin[row] = rotation[p], point
            if hinge.kind != "locked":
                axis = np.array(hinge.axis) / np.linalg.norm(hinge.axis)
                value = self.coordinate(row, q)
                if hinge.kind == "revolute":
                    rotation[row] = rotation[p] @ _rotation(value * axis)
                else:
                    origin[row] = point + rotation[p] @ axis * value
                if row in self.hinges:
                    j = 6 * len(self.free) + self.hinges.index(row)
                    motions.append((j, hinge.kind, rotation[p] @ axis, point))
            moved_by[row] = motions
        return origin, rotation, moved_by

    def coordinate(self, row, q):
        value = self.model.state.hinge[row]
        return value + q[6 * len(self.free) + self.hinges.index(row)] if row in self.hinges else value

    def jacobian(self, row, lever, placed):
        """Velocity (3, size) of the point at `lever` from the origin of a body, and its angular velocity."""
        origin, _, moved_by = placed
        linear, angular = np.zeros((3, self.size), dtype=complex), np.zeros((3, self.size), dtype=complex)
        for j, kind, axis, point in moved_by[row]:
            arm = origin[row] + lever - (point if point is not None else 0.0)
            if kind == "free":
                linear[:, j : j + 3], linear[:, j + 3 : j + 6] = ONE, -_cross(arm)
                angular[:, j + 3 : j + 6] = ONE
            elif kind == "revolute":
                linear[:, j], angular[:, j] = _cross(axis) @ arm, axis
            else:
                linear[:, j] = axis
        return (linear, angular) if np.iscomplexobj(origin[row]) else (linear.real, angular.real)

    def force(self, q, speed):
        """Generalised force (size,) at displacement q and speed of the coordinates."""
        model, placed, Q = self.model, self.place(q), np.zeros(self.size, dtype=complex)
        origin, rotation, _ = placed
        for row, body in enumerate(model.bodies):
            Q += self.jacobian(row, rotation[row] @ body.centre, placed)[0].T @ np.multiply(body.mass, model.gravity)
            linear, angular = self.jacobian(row, np.zeros(3), placed)
            Q += linear.T @ model.loads.force[row] + angular.T @ model.loads.moment[row]
            if row in self.hinges:
                j = 6 * len(self.free) + self.hinges.index(row)
                Q[j] += model.loads.torque[row] - model.damping[row] * speed[j]
                Q[j] -= model.stiffness[row] * (self.coordinate(row, q) - model.free[row])
            if body.hinge is not None and body.hinge.kind == "elastic":
                self.add_pair(Q, placed, row, np.zeros(3), *self.elastic(row, placed, speed))
        for spring in model.springs:
            row = self.rows[spring.body]
            r, home = rotation[row] @ spring.point, self.home if hasattr(self, "home") else placed
            rest = home[0][row] + home[1][row] @ spring.point if spring.place is None else np.array(spring.place)
            linear, angular = self.jacobian(row, r, placed)
            size = len(spring.stiffness)
            shift = np.concatenate((origin[row] + r - rest, _vector(rotation[row] @ home[1][row].T)))[:size]
            rate = np.concatenate((linear @ speed, angular @ speed))[:size]
            force = np.zeros(6, dtype=complex)
            force[: len(spring.force)] += spring.force
            force[:size] -= spring.stiffness @ shift + spring.damping @ rate
            Q += linear.T @ force[:3] + angular.T @ force[3:]
        for mount in model.mounts:
            row = self.rows[mount.body]
            p = self.rows[model.bodies[row].hinge.parent]
            r = rotation[row] @ mount.point
            l = rotation[p].T @ (origin[row] + r - origin[p])
            rest = self.mount_home(mount, row, p) if mount.place is None else np.array(mount.place)
            l_rate = rotation[p].T @ self.relative(row, r, p, placed, speed)
            force = rotation[p] @ (mount.force - mount.stiffness @ (l - rest) - mount.damping @ l_rate)
            self.add_pair(Q, placed, row, r, force, np.zeros(3))
        return Q

    def mount_home(self, mount, row, p):
        origin, rotation, _ = self.home if hasattr(self, "home") else self.place(np.zeros(self.size))
        return rotation[p].T @ (origin[row] + rotation[row] @ mount.point - origin[p])

    def relative(self, row, r, p, placed, speed):
        """Velocity of a body's point against the parent's own point at the same place."""
        at = placed[0][row] + r - placed[0][p]
        return (self.jacobian(row, r, placed)[0] - self.jacobian(p, at, placed)[0]) @ speed

    def elastic(self, row, placed, speed):
        """Force and moment on the child of an elastic hinge."""
        origin, rotation, _ = placed
        hinge = self.model.bodies[row].hinge
        p = self.rows[hinge.parent]
        A, zero = rotation[p], np.zeros(3)
        shift = A.T @ (origin[row] - origin[p]) - hinge.place
        rate = (self.jacobian(row, zero, placed)[1] - self.jacobian(p, zero, placed)[1]) @ speed
        velocity = self.relative(row, zero, p, placed, speed)
        K, C = np.array(hinge.stiffness), np.array(hinge.damping)
        force = -K[:3] * shift - C[:3] * (A.T @ velocity)
        moment = -K[3:] * _vector(A.T @ rotation[row]) - C[3:] * (A.T @ rate)
        return A @ force, A @ moment

    def add_pair(self, Q, placed, row, r, force, moment):
        """Add a force on a child at r from its origin and its reaction on the parent at the same place."""
        p = self.rows[self.model.bodies[row].hinge.parent]
        for body, lever, sign in ((row, r, 1.0), (p, placed[0][row] + r - placed[0][p], -1.0)):
            linear, angular = self.jacobian(body, lever, placed)
            Q += sign * (linear.T @ force + angular.T @ moment)
