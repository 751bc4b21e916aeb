"""Closed chains: loops of bodies whose axes are parallel, closed by cutting one pin of each [Rui2020].

The table is the tree that is left when one pin of every loop is cut; `cut_pin.CutPin` says which two bodies it joins.
Its force is unknown. In a loop of parallel axes the pins keep the bodies in parallel planes already, so of the pin's
five equations three hold by themselves and only two count: the ends must not part in the two directions T across the
axis,

    T^T (a_B - a_A) = -2 alpha T^T (v_B - v_A) - beta^2 T^T (p_B - p_A),

with two components of force to fulfil them. Accelerations are affine in the force: one evaluation with the loads and
no force, and one of a tree at rest for each unit of force alone, give the 2 x 2 system (2 k x 2 k for k pins), and what
they have found is superposed (derived in docs/method.md). The right-hand side, with alpha and beta > 0, draws back the
drift that an integration leaves in the closure (Baumgarte); it is zero by default.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..numerics.compiled import kernel
from ..numerics.spatial import load3, scale, vector
from .cut_pin import CutPin, check_pin, pin_name
from .solve import accelerations, store_hinge_wrenches
from .state import Accelerations, Loads, TreeState
from .sweeps.articulated import apply_force, new_cuts, open_cuts
from .sweeps.cells import columns
from .sweeps.kinematics import MotionOffset, new_motion, update_motion
from .sweeps.response import ResponseOffset, new_response
from .sweeps.riccati import solve_accelerations
from .sweeps.tree import build_tree, new_rows, to_lanes
from .table import Body

DEPENDENT = 1e-12  # smallest eigenvalue, relative to the two bodies without any hinge


class ClosureError(NamedTuple):
    """By how much the ends of k cut pins miss each other, B less A, global axes."""

    position: np.ndarray  # (k, 3) m
    velocity: np.ndarray  # (k, 3) m/s


class _Ends(NamedTuple):
    """Both ends of k cut pins, a's first; global axes."""

    body: np.ndarray  # (2, k) place in the table
    arm: np.ndarray  # (2, k, 3) from the body's origin, m
    place: np.ndarray  # (2, k, 3) m
    velocity: np.ndarray  # (2, k, 3) m/s
    centripetal: np.ndarray  # (2, k, 3) Om x (Om x arm), m/s^2
    across: np.ndarray  # (k, 2, 3) T: two unit vectors perpendicular to the axis


def closed_accelerations(
    bodies: Sequence[Body],
    pins: Sequence[CutPin],
    state: TreeState,
    loads: Loads,
    gravity: Sequence[float] = (0.0, 0.0, -9.81),
) -> tuple[Accelerations, np.ndarray]:
    """Return the accelerations of a tree of bodies whose loops are closed by pins, and the forces in these pins.

    Parameters
    ----------
    bodies : sequence of table.Body
    pins : sequence of cut_pin.CutPin
        k pins, one per loop.
    state : state.TreeState
        It should fulfil the closure (`closure_error`); the pins keep a remaining error, or reduce it.
    loads : state.Loads
    gravity : sequence of 3 floats
        Global axes, m/s^2.

    Returns
    -------
    Accelerations
        Wrenches hold for cut pins that carry only a force across their axis. Rigid bodies do not determine how a loop
        of parallel axes distributes forces along the axis and moments across it.
    force : (k, 3) array
        Of body b on body a in each pin, global axes [N].

    Raises
    ------
    ValueError
        The table is not a tree of possible bodies, a pin is not possible in it, or the closure equations depend on
        each other, as in a stretched-out loop or one of fewer than three bodies.

    Examples
    --------
    Four links in a square, one pin cut: free, and at rest, the loop falls as a whole and the pin carries nothing.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> link = lambda k, hinge=None: rui.Body(k, f"link {k}", 1.0, (0.5, 0.0, 0.0), 0.1 * np.eye(3), hinge)
    >>> turn = lambda k: rui.Hinge(k, "revolute", f"link {k - 1}", (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    >>> bodies = [link(0), *(link(k, turn(k)) for k in (1, 2, 3))]
    >>> state = rui.rest_state(bodies)
    >>> state.hinge[1:] = np.pi / 2
    >>> pin = rui.CutPin("link 3", (1.0, 0.0, 0.0), "link 0", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    >>> found, force = rui.closed_accelerations(bodies, [pin], state, rui.no_loads(bodies))
    >>> bool(np.abs(found.hinge).max() < 1e-9), bool(np.abs(force).max() < 1e-9)
    (True, True)
    """
    tree, lanes, ends = _prepare(bodies, pins, state, gravity)
    found = accelerations(bodies, state, loads, gravity)
    first, second = _end_accelerations(ends, found) + ends.centripetal
    miss = _miss(ends)
    alpha, beta = np.array([(pin.alpha, pin.beta) for pin in pins]).reshape(-1, 2, 1).transpose(1, 0, 2)
    wanted = first - second - 2.0 * alpha * miss.velocity - beta**2 * miss.position
    units = _unit_responses(tree, lanes, ends)
    size = _solve(bodies, pins, ends, units, wanted)
    force = np.einsum("kc,kci->ki", size.reshape(-1, 2), ends.across)
    for unit, each in zip(units, size, strict=True):
        for total, part in zip(found, unit, strict=True):
            total += each * part
    return found, force


def closure_error(bodies, pins, state):
    """Return the `ClosureError` of cut pins in a state; parameters and errors as of `closed_accelerations`."""
    return _miss(_prepare(bodies, pins, state, (0.0, 0.0, 0.0))[2])


def _prepare(bodies, pins, state, gravity):
    """Return the tree, the state in its rows and the `_Ends`."""
    tree = build_tree(bodies, gravity)
    for pin in pins:
        check_pin(bodies, pin)
    lanes, motion = to_lanes(tree, state), new_motion(tree)
    update_motion(tree, lanes, motion)
    rows = {body.name: row for row, body in enumerate(bodies)}
    body = np.array([[rows[pin.body_a] for pin in pins], [rows[pin.body_b] for pin in pins]], dtype=int)
    at = tree.row[body]
    local = np.array([[pin.point_a for pin in pins], [pin.point_b for pin in pins]], dtype=float).reshape(2, -1, 3)
    rotation = columns(motion, MotionOffset.ROTATION, 9)[at].reshape(2, -1, 3, 3)
    rate = columns(motion, MotionOffset.ANGULAR_VELOCITY, 3)[at]
    arm = np.einsum("skij,skj->ski", rotation, local)
    turning = np.cross(rate, arm)
    across = np.array([_across(pin.axis) for pin in pins]).reshape(-1, 2, 3)
    return (
        tree,
        lanes,
        _Ends(
            body=body,
            arm=arm,
            place=columns(motion, MotionOffset.ORIGIN, 3)[at] + arm,
            velocity=columns(motion, MotionOffset.VELOCITY, 3)[at] + turning,
            centripetal=np.cross(rate, turning),
            across=np.einsum("kij,kcj->kci", rotation[0], across),
        ),
    )


def _across(axis):
    """Two unit vectors perpendicular to an axis and to each other: (2, 3)."""
    axis = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    first = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first)])


def _miss(ends):
    return ClosureError(ends.place[1] - ends.place[0], ends.velocity[1] - ends.velocity[0])


def _end_accelerations(ends, found):
    """Return the accelerations of both ends without what their bodies' speeds add: (2, k, 3) m/s^2."""
    return found.linear[ends.body] + np.cross(found.angular[ends.body], ends.arm)


def _unit_responses(tree, lanes, ends):
    """Return the `Accelerations` by a pair of forces of 1 N on the ends, on a toward T, alone: two a pin."""
    still = lanes._replace(
        velocity=0.0 * lanes.velocity, angular_velocity=0.0 * lanes.angular_velocity, hinge_rate=new_rows(tree)
    )
    motion, cuts, response, no_torque = new_motion(tree), new_cuts(tree), new_response(tree), new_rows(tree)
    update_motion(tree, still, motion)
    units = []
    for k, across in enumerate(ends.across):
        for force in across:
            wrench = np.zeros((len(tree.row), 6))
            pair = tree.row[ends.body[:, k]]
            _respond(tree, motion, no_torque, pair, ends.place[:, k], force, cuts, response, wrench)
            linear, angular = (
                columns(response, ResponseOffset.LINEAR, 3)[tree.row],
                columns(response, ResponseOffset.ANGULAR, 3)[tree.row],
            )
            units.append(
                Accelerations(linear, angular, columns(response, ResponseOffset.HINGE, 1)[tree.row, 0], wrench)
            )
    return units


@kernel
def _respond(tree, motion, no_torque, pair, place, force, cuts, response, wrench):
    """Sweep with a force on the first body of a pair and its opposite on the second; nothing else moves the tree."""
    open_cuts(tree, motion, no_torque, cuts)
    push = vector(force)
    apply_force(cuts, motion, pair[0], load3(place, 0), push)
    apply_force(cuts, motion, pair[1], load3(place, 1), scale(-1.0, push))
    solve_accelerations(tree, motion, cuts, response)
    store_hinge_wrenches(tree, motion, cuts, response, wrench)


def _solve(bodies, pins, ends, units, wanted):
    """Return the (2 k,) sizes of the unit forces with which the ends accelerate apart by T^T wanted."""
    matrix = np.empty((len(units),) * 2)
    for column, each in enumerate(units):
        first, second = _end_accelerations(ends, each)
        matrix[:, column] = np.einsum("kci,ki->kc", ends.across, second - first).ravel()
    # minus the matrix is symmetric and, unless equations depend on each other, positive definite; to compare it with,
    # what forces of 1 N make of the two bodies by themselves
    mobility = np.array([sum(1.0 / bodies[row].mass for row in pair) for pair in ends.body.T])
    unit = np.repeat(1.0 / np.sqrt(mobility), 2)
    scaled = -matrix * unit * unit[:, None]
    if np.any(np.linalg.eigvalsh(scaled) <= DEPENDENT):
        raise ValueError(
            f"{', '.join(map(pin_name, pins))}: the closure equations depend on each other in this state; each needs "
            "a loop of at least three bodies that is not stretched out, and freedom that no other pin takes"
        )
    return -unit * np.linalg.solve(scaled, unit * np.einsum("kci,ki->kc", ends.across, wanted).ravel())
