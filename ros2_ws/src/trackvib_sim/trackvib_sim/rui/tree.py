"""A tree of rigid bodies and hinges: from a readable table to the arrays that the sweeps work on."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

REVOLUTE, SLIDE = 0, 1
KINDS = {"revolute": REVOLUTE, "slide": SLIDE}


@dataclass(frozen=True)
class Hinge:
    """The hinge that ties a body to its parent.

    `place` is the hinge point in the parent's axes, from the parent's origin [m]; `axis` is fixed in parent and child
    alike; the coordinate (rad, or m for a slide) is that of the child relative to the parent.
    """

    number: int
    kind: str
    parent: str
    place: tuple
    axis: tuple


@dataclass(frozen=True)
class Body:
    """A rigid body. Its origin is its hinge point (the root's is free to choose).

    `centre` is the centre of mass from the origin [m], `inertia` the (3, 3) matrix about it [kg m^2], in body axes.
    The root body has no hinge.
    """

    number: int
    name: str
    mass: float
    centre: tuple
    inertia: np.ndarray
    hinge: Hinge | None = None


class Tree(NamedTuple):
    """System record of the body tree: what never changes. Row 0 is the root, parents stand before children."""

    parent: np.ndarray  # (n,) row of the parent, -1 for the root
    kind: np.ndarray  # (n,) REVOLUTE or SLIDE
    axis: np.ndarray  # (n, 3) unit vector
    place: np.ndarray  # (n, 3) m
    mass: np.ndarray  # (n,) kg
    centre: np.ndarray  # (n, 3) m
    inertia: np.ndarray  # (n, 6) kg m^2: xx, yy, zz, xy, xz, yz
    gravity: np.ndarray  # (3,) m/s^2


class TreeState(NamedTuple):
    """State record of the body tree, changed in place. Global axes; rows of the hinges are those of their bodies."""

    position: np.ndarray  # (3,) root origin, m
    attitude: np.ndarray  # (4,) unit quaternion w, x, y, z
    velocity: np.ndarray  # (3,) of the root origin, m/s
    rate: np.ndarray  # (3,) angular velocity of the root, rad/s
    hinge: np.ndarray  # (n,) rad or m; row 0 unused
    hinge_rate: np.ndarray  # (n,) rad/s or m/s


def build_tree(bodies, gravity=(0.0, 0.0, -9.81)):
    """Turn a table of bodies into a `Tree`.

    Parameters
    ----------
    bodies : sequence of Body
        Exactly one without hinge (the root), which comes first; every parent stands before its children.
    gravity : sequence of 3 floats
        Global axes, m/s^2.

    Raises
    ------
    ValueError
        Names the body or hinge, the value and what is accepted.
    """
    rows = {}
    for row, body in enumerate(bodies):
        _check(body, row, rows)
        rows[body.name] = row
    n = len(bodies)
    tree = Tree(
        parent=np.full(n, -1),
        kind=np.zeros(n, dtype=np.int64),
        axis=np.zeros((n, 3)),
        place=np.zeros((n, 3)),
        mass=np.array([float(body.mass) for body in bodies]),
        centre=np.array([body.centre for body in bodies], dtype=float),
        inertia=np.array([_six(body.inertia) for body in bodies]),
        gravity=np.array(gravity, dtype=float),
    )
    for row, body in enumerate(bodies[1:], start=1):
        tree.parent[row] = rows[body.hinge.parent]
        tree.kind[row] = KINDS[body.hinge.kind]
        tree.axis[row] = np.asarray(body.hinge.axis, dtype=float) / np.linalg.norm(body.hinge.axis)
        tree.place[row] = body.hinge.place
    return tree


def rest_state(tree):
    """Return the state with every coordinate and speed zero."""
    n = len(tree.mass)
    return TreeState(
        np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3), np.zeros(3), np.zeros(n), np.zeros(n)
    )


def _six(inertia):
    m = np.asarray(inertia, dtype=float)
    return m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]


def _check(body, row, rows):
    name = f"body {body.number} ({body.name})"
    if body.name in rows:
        raise ValueError(f"{name}: the name is taken already, names must differ")
    if not (np.isfinite(body.mass) and body.mass > 0.0):
        raise ValueError(f"{name}: mass is {body.mass} kg, must be finite and > 0")
    inertia = np.asarray(body.inertia, dtype=float)
    if inertia.shape != (3, 3) or not np.allclose(inertia, inertia.T):
        raise ValueError(f"{name}: inertia must be a symmetric 3 x 3 matrix, is {inertia.tolist()}")
    principal = np.linalg.eigvalsh(inertia)
    if not (principal[0] > 0.0 and principal[2] <= (principal[0] + principal[1]) * (1.0 + 1e-9)):
        raise ValueError(
            f"{name}: principal moments of inertia are {principal.tolist()} kg m^2, must be > 0 and none larger than "
            "the sum of the other two"
        )
    if (body.hinge is None) != (row == 0):
        raise ValueError(f"{name}: the first body, and only that one, is the root and has no hinge")
    if body.hinge is not None:
        hinge = body.hinge
        where = f"hinge {hinge.number} of {name}"
        if hinge.kind not in KINDS:
            raise ValueError(f"{where}: kind is {hinge.kind!r}, must be one of {', '.join(KINDS)}")
        if hinge.parent not in rows:
            raise ValueError(f"{where}: parent {hinge.parent!r} must stand before it; known are {', '.join(rows)}")
        if not np.linalg.norm(hinge.axis) > 0.0:
            raise ValueError(f"{where}: axis is {tuple(hinge.axis)}, must not be zero")
