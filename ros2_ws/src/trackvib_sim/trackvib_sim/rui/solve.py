"""Riccati form on the plain records of `state`, for one evaluation at a time; steps in a loop use the kernels."""

from collections.abc import Sequence

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import add, cross, scale, subtract
from .state import Accelerations, Loads, TreeState
from .sweeps.articulated import apply_wrench, new_cuts, open_cuts, prescribe
from .sweeps.cells import columns
from .sweeps.elastic import apply_elastic_hinges, elastic_place, elastic_wrench
from .sweeps.kinematics import MotionOffset, motion_vector, new_motion, update_motion
from .sweeps.response import ResponseOffset, hinge_wrench, new_response
from .sweeps.riccati import solve_accelerations
from .sweeps.tree import BodyOffset, build_tree, new_rows, to_lanes
from .table import Body


def accelerations(
    bodies: Sequence[Body], state: TreeState, loads: Loads, gravity: Sequence[float] = (0.0, 0.0, -9.81)
) -> Accelerations:
    """Return the `Accelerations` of a table of bodies by the two sweeps of the Riccati form.

    Parameters
    ----------
    bodies : sequence of table.Body
    state : state.TreeState
    loads : state.Loads
    gravity : sequence of 3 floats
        Global axes, m/s^2.

    Raises
    ------
    ValueError
        The table is not a tree of possible bodies.

    Examples
    --------
    A torque of 5 N m turns an arm that hangs in free fall.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> loads = rui.no_loads(bodies)
    >>> loads.torque[1] = 5.0
    >>> found = rui.accelerations(bodies, rui.rest_state(bodies), loads)
    >>> round(float(found.hinge[1]), 6)  # rad/s^2
    23.75
    """
    tree = build_tree(bodies, gravity)
    motion, cuts, response = new_motion(tree), new_cuts(tree), new_response(tree)
    torques = new_rows(tree)
    torques[tree.row] = loads.torque
    _evaluate(tree, to_lanes(tree, state), torques, loads, motion, cuts, response)
    n = len(bodies)
    hinge = columns(response, ResponseOffset.HINGE, 1)[tree.row, 0]
    found = Accelerations(np.zeros((n, 3)), np.zeros((n, 3)), hinge, np.zeros((n, 6)))
    _collect(tree, motion, cuts, response, found)
    found.hinge[~tree.moves] = 0.0
    return found


@kernel
def _evaluate(tree, state, torques, loads, motion, cuts, response):
    w = len(tree.lanes)
    update_motion(tree, state, motion)
    open_cuts(tree, motion, torques, cuts)
    apply_elastic_hinges(tree, motion, cuts)
    for b in range(tree.row.size):
        row = tree.row[b]
        force, moment = loads.force[b], loads.moment[b]
        apply_wrench(cuts, row, (force[0], force[1], force[2]), (moment[0], moment[1], moment[2]))
        if tree.moves[b] and tree.body[row // w, BodyOffset.MOBILE * w + row % w] == 0.0:
            prescribe(cuts, row, loads.acceleration[b])
    solve_accelerations(tree, motion, cuts, response)


@kernel
def _collect(tree, motion, cuts, response, found):
    w = len(tree.lanes)
    for b in range(tree.row.size):
        row = tree.row[b]
        cells, i = response.cells[row // w], row % w
        drift, angular = (
            motion_vector(motion, MotionOffset.DRIFT, row),
            motion_vector(motion, MotionOffset.ANGULAR_DRIFT, row),
        )
        for k in range(3):
            found.linear[b, k] = cells[(ResponseOffset.LINEAR + k) * w + i] + drift[k] + tree.gravity[k]
            found.angular[b, k] = cells[(ResponseOffset.ANGULAR + k) * w + i] + angular[k]
    store_hinge_wrenches(tree, motion, cuts, response, found.wrench)
    for k in range(tree.elastic.child.size):
        force, moment = elastic_wrench(tree, motion, k)
        lever = subtract(
            motion_vector(motion, MotionOffset.ORIGIN, tree.elastic.child[k]), elastic_place(tree, motion, k)
        )
        on_parent = scale(-1.0, force), scale(-1.0, add(moment, cross(lever, force)))
        _store_wrench(found.wrench[tree.elastic.number[k]], *on_parent)


@kernel
def store_hinge_wrenches(tree, motion, cuts, response, wrench):
    """Fill `wrench` (n, 6) by `hinge_wrench` of every body with a hinge that constrains it, in the table's order."""
    w = len(tree.lanes)
    for b in range(tree.row.size):
        row = tree.row[b]
        if tree.parent[row // w] >= 0:
            _store_wrench(wrench[b], *hinge_wrench(tree, motion, cuts, response, row))


@kernel
def _store_wrench(wrench, force, moment):
    for k in range(3):
        wrench[k] = force[k]
        wrench[3 + k] = moment[k]
