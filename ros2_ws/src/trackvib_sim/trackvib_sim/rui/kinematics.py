"""Where every body is and how it moves, from the root outwards ([Rui2020]; parents before children)."""

from typing import NamedTuple

import numpy as np

from .compiled import kernel
from .spatial import (
    add,
    axis_rotation,
    cross,
    load3,
    load9,
    multiply,
    quaternion_matrix,
    rotate,
    rotate_back,
    scale,
    store3,
    subtract,
    turn_quaternion,
)
from .tree import SLIDE


class Motion(NamedTuple):
    """Pose and velocity of every body, global axes.

    A body's origin is its hinge point *on the parent*: the body-fixed point that passes through it. Under a slide
    that point wanders along the body, so `offset` says where the body's own origin is seen from it.
    """

    rotation: np.ndarray  # (n, 9) body axes -> global axes, row by row
    origin: np.ndarray  # (n, 3) m
    offset: np.ndarray  # (n, 3) m, body axes; zero except under a slide
    velocity: np.ndarray  # (n, 3) of the body-fixed point at the origin, m/s
    rate: np.ndarray  # (n, 3) angular velocity, rad/s
    axis: np.ndarray  # (n, 3) hinge axis


def new_motion(n):
    """Return an empty record for n bodies."""
    return Motion(*(np.zeros((n, columns)) for columns in (9, 3, 3, 3, 3, 3)))


@kernel
def update_motion(tree, state, motion):
    """Fill `motion` from `state` (section "kinematics" of the method: A, Om, P, v from parent to child)."""
    m = quaternion_matrix((state.attitude[0], state.attitude[1], state.attitude[2], state.attitude[3]))
    for j in range(9):
        motion.rotation[0, j] = m[j]
    for j in range(3):
        motion.origin[0, j] = state.position[j]
        motion.velocity[0, j] = state.velocity[j]
        motion.rate[0, j] = state.rate[j]
    for b in range(1, tree.parent.size):
        p = tree.parent[b]
        m_p = load9(motion.rotation, p)
        lever = rotate(m_p, add(load3(tree.place, b), load3(motion.offset, p)))
        om_p = load3(motion.rate, p)
        e_local = load3(tree.axis, b)
        e = rotate(m_p, e_local)
        v = add(load3(motion.velocity, p), cross(om_p, lever))
        if tree.kind[b] == SLIDE:
            m_b = m_p
            om_b = om_p
            v = add(v, scale(state.hinge_rate[b], e))
            store3(motion.offset, b, scale(state.hinge[b], e_local))
        else:
            m_b = multiply(m_p, axis_rotation(e_local, state.hinge[b]))
            om_b = add(om_p, scale(state.hinge_rate[b], e))
        for j in range(9):
            motion.rotation[b, j] = m_b[j]
        store3(motion.origin, b, add(load3(motion.origin, p), lever))
        store3(motion.velocity, b, v)
        store3(motion.rate, b, om_b)
        store3(motion.axis, b, e)


@kernel
def point_place(motion, body, local):
    """Return the global place of a body-fixed point, given in body axes from the body's own origin [m]."""
    arm = rotate(load9(motion.rotation, body), add(local, load3(motion.offset, body)))
    return add(load3(motion.origin, body), arm)


@kernel
def point_velocity(motion, body, place):
    """Return the velocity of the body-fixed point at a global place [m/s]."""
    arm = subtract(place, load3(motion.origin, body))
    return add(load3(motion.velocity, body), cross(load3(motion.rate, body), arm))


@kernel
def body_axes(motion, body, vector):
    """Return a global vector in the axes of a body."""
    return rotate_back(load9(motion.rotation, body), vector)


@kernel
def integrate(state, root_linear, root_angular, hinge_acceleration, dt):
    """Advance the state by dt with symplectic Euler: speeds by the accelerations, then places by the new speeds."""
    for j in range(3):
        state.velocity[j] += dt * root_linear[j]
        state.rate[j] += dt * root_angular[j]
        state.position[j] += dt * state.velocity[j]
    q = (state.attitude[0], state.attitude[1], state.attitude[2], state.attitude[3])
    q = turn_quaternion(q, (state.rate[0], state.rate[1], state.rate[2]), dt)
    for j in range(4):
        state.attitude[j] = q[j]
    for b in range(1, state.hinge.size):
        state.hinge_rate[b] += dt * hinge_acceleration[b]
        state.hinge[b] += dt * state.hinge_rate[b]
