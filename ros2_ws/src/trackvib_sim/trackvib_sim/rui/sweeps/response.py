"""What the sweeps find, and what follows from it: accelerations of bodies, of points on them, wrenches in hinges."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ...numerics.spatial import add, cross, rotate, rotate_back, subtract, symmetric_product
from .articulated import CutOffset
from .cells import get3, get6, get9, new_cells
from .kinematics import MotionOffset, motion_vector
from .tree import BodyOffset


class ResponseOffset(IntEnum):
    """Where the quantities of a body's response begin in `Response.cells`, global axes."""

    LINEAR = 0  # of the origin, m/s^2
    ANGULAR = 3  # rad/s^2
    HINGE = 6  # rad/s^2 or m/s^2
    SIZE = 7


class Response(NamedTuple):
    """What the sweeps find: how bodies accelerate, counted as in `Cuts` (add drift and gravity for the whole)."""

    lanes: tuple
    cells: np.ndarray  # (blocks, RESPONSE W)
    parents: np.ndarray  # (RESPONSE W,) room for parents from two blocks


def new_response(tree):
    """Return an empty record."""
    width = ResponseOffset.SIZE * len(tree.lanes)
    return Response(tree.lanes, new_cells(len(tree.parent), width), new_cells(1, width)[0])


@inlined
def point_specific_force(motion, response, body, place):
    """Return acceleration less gravity of the body-fixed point at a global place [m/s^2], global axes."""
    w = len(response.lanes)
    cells, i = response.cells[body // w], body % w
    arm = subtract(place, motion_vector(motion, MotionOffset.ORIGIN, body))
    om = motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, body)
    al = add(get3(cells, ResponseOffset.ANGULAR, w, i), motion_vector(motion, MotionOffset.ANGULAR_DRIFT, body))
    origin = add(get3(cells, ResponseOffset.LINEAR, w, i), motion_vector(motion, MotionOffset.DRIFT, body))
    return add(origin, add(cross(al, arm), cross(om, cross(om, arm))))


@kernel
def hinge_wrench(tree, motion, cuts, response, body):
    """Return q [N] and m [N m] of a body on its parent, about the hinge point on the parent: f = S_h x + s_h."""
    w = len(tree.lanes)
    j, i = body // w, body % w
    on_foot = tree.foot[j] >= 0 and tree.body[j, BodyOffset.FOOT_SHARE * w + i] > 0.0
    parent = tree.foot[j] if on_foot else tree.parent[j]
    cut, m, up = cuts.cells[j], motion.cells[j], response.cells[parent]
    lever = get3(m, MotionOffset.LEVER, w, i)
    al = get3(up, ResponseOffset.ANGULAR, w, i)
    a = add(get3(up, ResponseOffset.LINEAR, w, i), cross(al, lever))
    q = get9(cut, CutOffset.Q, w, i)
    force = add(
        add(symmetric_product(get6(cut, CutOffset.P, w, i), a), rotate(q, al)), get3(cut, CutOffset.FORCE, w, i)
    )
    moment = add(
        add(rotate_back(q, a), symmetric_product(get6(cut, CutOffset.R, w, i), al)), get3(cut, CutOffset.MOMENT, w, i)
    )
    # a prismatic hinge has moved on from the hinge point on the parent
    lever_now = subtract(
        lever,
        rotate(get9(motion.cells[parent], MotionOffset.ROTATION, w, i), get3(tree.body[j], BodyOffset.PLACE, w, i)),
    )
    return force, add(moment, cross(lever_now, force))
