"""The readable table of a tree of rigid bodies and hinges, and what a table must fulfil."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import hypot, isfinite

import numpy as np

KINDS = ("revolute", "prismatic", "locked", "elastic")
_SHORTEST, _LONGEST = 1e-6, 1e6  # axes


@dataclass(frozen=True)
class Hinge:
    """The hinge that connects a body to its parent.

    Attributes
    ----------
    number : int
    kind : str
        "revolute" (the paper's column hinge) turns about the axis, "prismatic" moves along it, "locked" does neither.
        "elastic" does not constrain the body at all: a bushing with stiffness and damping in all six directions.
    parent : str
        Name of the body on the root's side.
    place : sequence of 3 floats
        Hinge point in the parent's axes, from the parent's origin [m].
    axis : sequence of 3 floats
        Fixed in parent and child alike, of a length from 1e-6 to 1e6; not used by "locked" and "elastic".
    prescribed : bool
        The motion of a "revolute" or "prismatic" is given, its torque or force is a result.
    stiffness, damping : sequence of 6 floats
        Of an "elastic" hinge, parent's axes: three displacements [N/m, N s/m], three rotations [N m/rad, N m s/rad].

    The coordinate (rad, or m for a prismatic one) is that of the child relative to the parent.

    Examples
    --------
    >>> from trackvib_sim import rui
    >>> rui.Hinge(1, "prismatic", "base", place=(0.0, 0.5, 0.0), axis=(1.0, 0.0, 0.0)).prescribed
    False
    """

    number: int
    kind: str
    parent: str
    place: tuple
    axis: tuple = (0.0, 0.0, 1.0)
    prescribed: bool = False
    stiffness: tuple = (0.0,) * 6
    damping: tuple = (0.0,) * 6


@dataclass(frozen=True)
class Body:
    """A rigid body. Its origin is its own hinge point (the root's is free to choose).

    `centre` is the centre of mass from the origin [m], `inertia` the (3, 3) matrix about it [kg m^2], in body axes.
    The root body has no hinge.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rui.Body(0, "base", mass=10.0, centre=(0.1, 0.0, 0.0), inertia=np.eye(3)).hinge is None
    True
    """

    number: int
    name: str
    mass: float
    centre: tuple
    inertia: np.ndarray = field(repr=False)
    hinge: Hinge | None = None


def check_table(bodies: Sequence[Body]) -> None:
    """Refuse a table that does not describe a valid tree.

    Parameters
    ----------
    bodies : sequence of Body
        Exactly one without hinge (the root), which comes first; every parent comes before its children.

    Raises
    ------
    ValueError
        Names the body or hinge, the value and what is accepted.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rui.check_table([rui.Body(0, "base", -1.0, (0.0, 0.0, 0.0), np.eye(3))])
    Traceback (most recent call last):
    ValueError: body 0 (base): mass is -1.0 kg, must be finite and > 0
    """
    if not bodies:
        raise ValueError("the table has no body, must have at least the root")
    names = {}
    for row, body in enumerate(bodies):
        _check_body(body, names)
        if (body.hinge is None) != (row == 0):
            raise ValueError(f"{_name(body)}: the first body, and only that one, is the root and has no hinge")
        if body.hinge is not None:
            _check_hinge(body, names)
        names[body.name] = row
    _check_inertias(bodies)


def _name(body):
    return f"body {body.number} ({body.name})"


def _check_body(body, names):
    name = _name(body)
    if body.name in names:
        raise ValueError(f"{name}: the name is already used, must be unique")
    if not (isfinite(body.mass) and body.mass > 0.0):
        raise ValueError(f"{name}: mass is {body.mass} kg, must be finite and > 0")
    _check_numbers(f"{name}: centre", body.centre, 3)
    if np.shape(body.inertia) != (3, 3):
        raise ValueError(f"{name}: inertia must be a symmetric 3 x 3 matrix, is {np.asarray(body.inertia).tolist()}")


def _check_inertias(bodies):
    """All at once, for the sake of large tables."""
    inertia = np.array([body.inertia for body in bodies], dtype=float)
    size = np.abs(inertia).max((1, 2), keepdims=True)
    symmetric = np.all(np.abs(inertia - inertia.transpose(0, 2, 1)) <= 1e-9 * size, axis=(1, 2))  # false for nan
    for row in np.flatnonzero(~symmetric)[:1]:
        raise ValueError(f"{_name(bodies[row])}: inertia must be a symmetric 3 x 3 matrix, is {inertia[row].tolist()}")
    principal = np.linalg.eigvalsh(inertia)
    possible = (principal[:, 0] > 0.0) & (principal[:, 2] <= (principal[:, 0] + principal[:, 1]) * (1.0 + 1e-9))
    for row in np.flatnonzero(~possible)[:1]:
        raise ValueError(
            f"{_name(bodies[row])}: principal moments of inertia are {principal[row].tolist()} kg m^2, must be > 0 and "
            "none larger than the sum of the other two"
        )


def check_axis(item, axis):
    """Raise `ValueError` for the axis (3,) of a hinge from whose length no direction follows."""
    if not _SHORTEST <= hypot(*axis) <= _LONGEST:
        raise ValueError(f"{item} is {tuple(axis)}, must be {_SHORTEST:g} to {_LONGEST:g} long")


def _check_hinge(body, names):
    hinge = body.hinge
    where = f"hinge {hinge.number} of {_name(body)}"
    if hinge.kind not in KINDS:
        raise ValueError(f"{where}: kind is {hinge.kind!r}, must be one of {', '.join(KINDS)}")
    if hinge.parent not in names:
        raise ValueError(f"{where}: parent {hinge.parent!r} must stand before it; known are {', '.join(names)}")
    _check_numbers(f"{where}: place", hinge.place, 3)
    _check_numbers(f"{where}: axis", hinge.axis, 3)
    if hinge.kind in ("revolute", "prismatic"):
        check_axis(f"{where}: axis", hinge.axis)
    elif hinge.prescribed:
        raise ValueError(f"{where}: a {hinge.kind} hinge has no motion to prescribe, only revolute and prismatic have")
    for item in ("stiffness", "damping"):
        values = _check_numbers(f"{where}: {item}", getattr(hinge, item), 6)
        if min(values) < 0.0:
            raise ValueError(f"{where}: {item} is {values}, must not be negative")
        if any(values) and hinge.kind != "elastic":
            raise ValueError(f"{where}: {item} is for elastic hinges; on a {hinge.kind} hinge it is a load")


def _check_numbers(what, values, count):
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != count or not all(map(isfinite, numbers)):
        raise ValueError(f"{what} is {values!r}, must be {count} finite numbers")
    return numbers
