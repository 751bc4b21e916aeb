"""Where every body is and how it moves, from the root outwards ([Rui2020]; parents before children)."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.angles import sine_cosine
from ...numerics.compiled import inlined
from ...numerics.spatial import (
    add,
    axis_rotation,
    cross,
    multiply,
    quaternion_matrix,
    rotate,
    rotate_back,
    scale,
    subtract,
    vector,
)
from .cells import get3, get9, new_cells, pick3, put3, put9
from .packing import HingeKind
from .tree import BodyOffset, new_rows


class MotionOffset(IntEnum):
    """Where the quantities of a body's motion begin in `Motion.cells`, global axes."""

    ROTATION = 0  # body axes -> global axes, row by row
    ORIGIN = 9  # m
    LEVER = 12  # from the parent's origin, m
    VELOCITY = 15  # of the origin, m/s
    ANGULAR_VELOCITY = 18  # rad/s
    HINGE_AXIS = 21
    DRIFT = 24  # acceleration of the origin while no hinge and not the root accelerates, m/s^2
    ANGULAR_DRIFT = 27  # rad/s^2
    SIZE = 30


class Motion(NamedTuple):
    """Pose, velocity and velocity-dependent acceleration of every body. A body's origin is its own hinge point."""

    lanes: tuple
    cells: np.ndarray  # (blocks, MOTION W)
    sine: np.ndarray  # (rows,) of the hinges' angles
    cosine: np.ndarray  # (rows,)
    parents: np.ndarray  # (MOTION W,) room for parents from two blocks


def new_motion(tree):
    """Return an empty record."""
    width = MotionOffset.SIZE * len(tree.lanes)
    cells, parents = new_cells(len(tree.parent), width), new_cells(1, width)[0]
    return Motion(tree.lanes, cells, new_rows(tree), new_rows(tree), parents)


@inlined
def _free_body(tree, state, free, cells):
    """A body without hinge: from the state, the same in all lanes."""
    w = len(tree.lanes)
    q = state.attitude[free]
    m = quaternion_matrix((q[0], q[1], q[2], q[3]))
    place, velocity, rate = (
        vector(state.position[free]),
        vector(state.velocity[free]),
        vector(state.angular_velocity[free]),
    )
    for i in range(tree.width[0]):
        put9(cells, MotionOffset.ROTATION, w, i, m)
        put3(cells, MotionOffset.ORIGIN, w, i, place)
        put3(cells, MotionOffset.VELOCITY, w, i, velocity)
        put3(cells, MotionOffset.ANGULAR_VELOCITY, w, i, rate)


@inlined
def _revolute(tree, alone, up, body, sine, cosine, hinge_rate, cells):
    """Children that turn: A_c = A_p Rot(e, th), Om_c = Om_p + e thd."""
    w = len(tree.lanes)
    first, first_sine, first_cosine = hinge_rate[0], sine[0], cosine[0]
    for i in range(tree.width[0]):
        s = first_sine if alone else sine[i]
        c = first_cosine if alone else cosine[i]
        speed = first if alone else hinge_rate[i]
        m_p, om_p, al_p = (
            get9(up, MotionOffset.ROTATION, w, i),
            get3(up, MotionOffset.ANGULAR_VELOCITY, w, i),
            get3(up, MotionOffset.ANGULAR_DRIFT, w, i),
        )
        axis = get3(body, BodyOffset.AXIS, w, i)
        lever = rotate(m_p, get3(body, BodyOffset.PLACE, w, i))
        e = rotate(m_p, axis)
        turning = cross(om_p, lever)
        relative = scale(speed, e)
        put9(cells, MotionOffset.ROTATION, w, i, multiply(m_p, axis_rotation(axis, s, c)))
        put3(cells, MotionOffset.ORIGIN, w, i, add(get3(up, MotionOffset.ORIGIN, w, i), lever))
        put3(cells, MotionOffset.LEVER, w, i, lever)
        put3(cells, MotionOffset.VELOCITY, w, i, add(get3(up, MotionOffset.VELOCITY, w, i), turning))
        put3(cells, MotionOffset.ANGULAR_VELOCITY, w, i, add(om_p, relative))
        put3(cells, MotionOffset.HINGE_AXIS, w, i, e)
        put3(
            cells,
            MotionOffset.DRIFT,
            w,
            i,
            add(get3(up, MotionOffset.DRIFT, w, i), add(cross(al_p, lever), cross(om_p, turning))),
        )
        put3(cells, MotionOffset.ANGULAR_DRIFT, w, i, add(al_p, cross(om_p, relative)))


@inlined
def _prismatic(tree, alone, up, body, hinge, hinge_rate, cells):
    """Children that slide: Q = P + e s, with the Coriolis acceleration 2 Om x e sd."""
    w = len(tree.lanes)
    first, first_rate = hinge[0], hinge_rate[0]
    for i in range(tree.width[0]):
        travel = first if alone else hinge[i]
        speed = first_rate if alone else hinge_rate[i]
        m_p, om_p, al_p = (
            get9(up, MotionOffset.ROTATION, w, i),
            get3(up, MotionOffset.ANGULAR_VELOCITY, w, i),
            get3(up, MotionOffset.ANGULAR_DRIFT, w, i),
        )
        axis = get3(body, BodyOffset.AXIS, w, i)
        lever = rotate(m_p, add(get3(body, BodyOffset.PLACE, w, i), scale(travel, axis)))
        e = rotate(m_p, axis)
        turning = cross(om_p, lever)
        relative = scale(speed, e)
        bent = cross(om_p, add(turning, add(relative, relative)))
        put9(cells, MotionOffset.ROTATION, w, i, m_p)
        put3(cells, MotionOffset.ORIGIN, w, i, add(get3(up, MotionOffset.ORIGIN, w, i), lever))
        put3(cells, MotionOffset.LEVER, w, i, lever)
        put3(cells, MotionOffset.VELOCITY, w, i, add(add(get3(up, MotionOffset.VELOCITY, w, i), turning), relative))
        put3(cells, MotionOffset.ANGULAR_VELOCITY, w, i, om_p)
        put3(cells, MotionOffset.HINGE_AXIS, w, i, e)
        put3(cells, MotionOffset.DRIFT, w, i, add(get3(up, MotionOffset.DRIFT, w, i), add(cross(al_p, lever), bent)))
        put3(cells, MotionOffset.ANGULAR_DRIFT, w, i, al_p)


@inlined
def _gather_parents(tree, body, foot, up, out):
    """Bring together what children need of their parents, where some stand on the foot."""
    w = len(tree.lanes)
    for i in range(tree.width[0]):
        second = body[BodyOffset.FOOT_SHARE * w + i] > 0.0
        pick3(second, foot, up, out, MotionOffset.ROTATION, w, i)
        pick3(second, foot, up, out, MotionOffset.ROTATION + 3, w, i)
        pick3(second, foot, up, out, MotionOffset.ROTATION + 6, w, i)
        pick3(second, foot, up, out, MotionOffset.ORIGIN, w, i)
        pick3(second, foot, up, out, MotionOffset.VELOCITY, w, i)
        pick3(second, foot, up, out, MotionOffset.ANGULAR_VELOCITY, w, i)
        pick3(second, foot, up, out, MotionOffset.DRIFT, w, i)
        pick3(second, foot, up, out, MotionOffset.ANGULAR_DRIFT, w, i)


@inlined
def update_motion(tree, state, motion):
    """Fill `motion` from `state` (A, Om, P, v from parent to child)."""
    w, cells = len(tree.lanes), motion.cells
    for row in range(state.hinge.size):
        motion.sine[row], motion.cosine[row] = sine_cosine(state.hinge[row])
    for j in range(tree.parent.size):
        p = tree.parent[j]
        if p < 0:
            _free_body(tree, state, tree.free[j], cells[j])
            continue
        up = cells[p]
        if tree.foot[j] >= 0:
            _gather_parents(tree, tree.body[j], cells[tree.foot[j]], cells[p], motion.parents)
            up = motion.parents
        first, end = j * w, (j + 1) * w
        hinge_rate = state.hinge_rate[first:end]
        if tree.kind[j] == HingeKind.PRISMATIC:
            _prismatic(tree, tree.alone[j], up, tree.body[j], state.hinge[first:end], hinge_rate, cells[j])
        else:
            sine, cosine = motion.sine[first:end], motion.cosine[first:end]
            _revolute(tree, tree.alone[j], up, tree.body[j], sine, cosine, hinge_rate, cells[j])


@inlined
def motion_vector(motion, quantity, row):
    """Return one vector of a body's motion, for example `ORIGIN`."""
    w = len(motion.lanes)
    return get3(motion.cells[row // w], quantity, w, row % w)


@inlined
def rotation(motion, row):
    """Return the matrix that turns a body's axes into global ones."""
    w = len(motion.lanes)
    return get9(motion.cells[row // w], MotionOffset.ROTATION, w, row % w)


@inlined
def point_place(motion, body, local):
    """Return the global place of a body-fixed point, given in body axes from the body's origin [m]."""
    return add(motion_vector(motion, MotionOffset.ORIGIN, body), rotate(rotation(motion, body), local))


@inlined
def point_velocity(motion, body, place):
    """Return the velocity of the body-fixed point at a global place [m/s]."""
    arm = subtract(place, motion_vector(motion, MotionOffset.ORIGIN, body))
    return add(
        motion_vector(motion, MotionOffset.VELOCITY, body),
        cross(motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, body), arm),
    )


@inlined
def body_axes(motion, body, a):
    """Return a global vector in the axes of a body."""
    return rotate_back(rotation(motion, body), a)
