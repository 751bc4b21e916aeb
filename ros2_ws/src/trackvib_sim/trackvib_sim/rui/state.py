"""State, known loads and accelerations of a tree as plain arrays, one row a body in the order of its table.

The forms of `reference` and `linear` work on these; the compiled sweeps keep the same numbers in lanes (`sweeps.tree`).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .table import Body


class TreeState(NamedTuple):
    """Coordinates and speeds, global axes; r free bodies (the root, then the body behind each elastic hinge).

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> state = rui.rest_state(bodies)
    >>> state.hinge[1] = 0.3  # the arm stands at 0.3 rad
    >>> state.position, state.hinge
    (array([[0., 0., 0.]]), array([0. , 0.3]))
    """

    position: np.ndarray  # (r, 3) origin, m
    attitude: np.ndarray  # (r, 4) unit quaternion w, x, y, z
    velocity: np.ndarray  # (r, 3) of the origin, m/s
    angular_velocity: np.ndarray  # (r, 3) rad/s
    hinge: np.ndarray  # (n,) rad or m, in the row of the child; those of free bodies and locked hinges are not used
    hinge_rate: np.ndarray  # (n,) rad/s or m/s


class Loads(NamedTuple):
    """Known loads, global axes. Gravity is not among them.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> loads = rui.no_loads(bodies)
    >>> loads.torque[1] = 5.0  # N m on the arm
    >>> loads.force.shape
    (2, 3)
    """

    force: np.ndarray  # (n, 3) N
    moment: np.ndarray  # (n, 3) about the body's origin, N m
    torque: np.ndarray  # (n,) of the hinge on the child along the axis, N m (N for a prismatic one)
    acceleration: np.ndarray  # (n,) of prescribed hinges, rad/s^2 or m/s^2


class Accelerations(NamedTuple):
    """The result of every form of the method, in global axes, gravity not subtracted.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> found = rui.accelerations(bodies, rui.rest_state(bodies), rui.no_loads(bodies))
    >>> found.linear[0]  # everything falls
    array([ 0.  ,  0.  , -9.81])
    """

    linear: np.ndarray  # (n, 3) of the body's origin, m/s^2
    angular: np.ndarray  # (n, 3) rad/s^2
    hinge: np.ndarray  # (n,) rad/s^2 or m/s^2
    wrench: np.ndarray  # (n, 6) q, m of the child on the parent, about the hinge point on the parent, N and N m


def free_bodies(bodies: Sequence[Body]) -> list[int]:
    """Return the rows of the bodies that no hinge constrains: the root and those behind elastic hinges."""
    return [row for row, body in enumerate(bodies) if body.hinge is None or body.hinge.kind == "elastic"]


def rest_state(bodies: Sequence[Body]) -> TreeState:
    """Return the `TreeState` of a table with every coordinate and speed zero, elastic hinges undeformed.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> rui.rest_state(bodies).attitude  # unit quaternion w, x, y, z
    array([[1., 0., 0., 0.]])
    """
    n, free = len(bodies), free_bodies(bodies)
    origin = {}
    for body in bodies:
        hinge = body.hinge
        origin[body.name] = np.zeros(3) if hinge is None else origin[hinge.parent] + np.asarray(hinge.place, float)
    attitude = np.zeros((len(free), 4))
    attitude[:, 0] = 1.0
    return TreeState(
        np.array([origin[bodies[row].name] for row in free]),
        attitude,
        np.zeros((len(free), 3)),
        np.zeros((len(free), 3)),
        np.zeros(n),
        np.zeros(n),
    )


def no_loads(bodies: Sequence[Body]) -> Loads:
    """Return `Loads` of zero for a table.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> rui.no_loads(bodies).torque
    array([0., 0.])
    """
    n = len(bodies)
    return Loads(np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), np.zeros(n))
