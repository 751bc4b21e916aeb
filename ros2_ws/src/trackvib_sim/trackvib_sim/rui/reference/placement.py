"""Where every body of a table is and how it moves, in plain NumPy (reference for the compiled kinematics)."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..state import free_bodies


class Placement(NamedTuple):
    """Pose and velocity of the n bodies of a table, one row a body, global axes.

    The root has no hinge: its rows of `hinge_point` and `axis` are zero, as are the axes of locked and elastic hinges.
    """

    rotation: np.ndarray  # (n, 3, 3) A, body axes -> global axes
    origin: np.ndarray  # (n, 3) the body's own hinge point Q, m
    velocity: np.ndarray  # (n, 3) of the origin, m/s
    angular_velocity: np.ndarray  # (n, 3) Om, rad/s
    hinge_point: np.ndarray  # (n, 3) P, on the parent, m
    axis: np.ndarray  # (n, 3) e, unit vector


def parent_rows(bodies):
    """Return the row of every body's parent as a list; -1 for the root."""
    rows = {body.name: row for row, body in enumerate(bodies)}
    return [-1 if body.hinge is None else rows[body.hinge.parent] for body in bodies]


def place_bodies(bodies, state):
    """Return the `Placement` of a table in a `TreeState`, parents before children.

    Revolute: A = A_p Rot(e, th), Om = Om_p + e thd, Q = P. Slide: A = A_p, Om = Om_p, Q = P + e s, whose velocity
    gets e sd on top of the parent's at that place. The body behind an elastic hinge has its own free coordinates.
    """
    n = len(bodies)
    rotation, origin, velocity, rate, point, axis = (np.zeros((n, *shape)) for shape in ((3, 3), *((3,),) * 5))
    parents = parent_rows(bodies)
    free = {row: k for k, row in enumerate(free_bodies(bodies))}
    for row, body in enumerate(bodies):
        p, hinge = parents[row], body.hinge
        if hinge is not None:
            point[row] = origin[p] + rotation[p] @ np.asarray(hinge.place, dtype=float)
        if row in free:
            k = free[row]
            rotation[row] = Rotation.from_quat(state.attitude[k], scalar_first=True).as_matrix()
            origin[row], velocity[row], rate[row] = state.position[k], state.velocity[k], state.angular_velocity[k]
            continue
        turn, slide, turn_rate, slide_rate = np.eye(3), 0.0, 0.0, 0.0
        if hinge.kind != "locked":
            local = np.asarray(hinge.axis, dtype=float) / np.linalg.norm(hinge.axis)
            axis[row] = rotation[p] @ local
        if hinge.kind == "revolute":
            turn = Rotation.from_rotvec(state.hinge[row] * local).as_matrix()
            turn_rate = state.hinge_rate[row]
        elif hinge.kind == "prismatic":
            slide, slide_rate = state.hinge[row], state.hinge_rate[row]
        rotation[row] = rotation[p] @ turn
        rate[row] = rate[p] + turn_rate * axis[row]
        origin[row] = point[row] + slide * axis[row]
        velocity[row] = velocity[p] + np.cross(rate[p], origin[row] - origin[p]) + slide_rate * axis[row]
    return Placement(rotation, origin, velocity, rate, point, axis)
