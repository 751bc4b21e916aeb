"""The pin at which a loop of bodies is cut open, and what it must fulfil."""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from .reference.placement import parent_rows
from .table import check_axis

PARALLEL = 1e-9  # rounding allowed of axes and lengths, relative


@dataclass(frozen=True)
class CutPin:
    """A pin that joins point A of body a to point B of body b and lets them turn about its axis.

    Attributes
    ----------
    body_a, body_b : str
        Names of two bodies of the table. All hinges on the way between them, through the tree, must be revolutes
        parallel to the pin, slides perpendicular to it, or locked.
    point_a, point_b : sequence of 3 floats
        In the axes of a and b, from their origins [m].
    axis : sequence of 3 floats
        In a's axes, of a length from 1e-6 to 1e6. (In b's axes it has the same components.)
    alpha, beta : float
        Baumgarte's parameters [1/s]. A closure error decays like a vibration of natural frequency beta [rad/s] and
        damping ratio alpha / beta; alpha = beta draws it back fastest.

    Examples
    --------
    >>> from trackvib_sim import rui
    >>> rui.CutPin("rod", (1.0, 0.0, 0.0), "base", (0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0)).alpha
    0.0
    """

    body_a: str
    point_a: tuple
    body_b: str
    point_b: tuple
    axis: tuple
    alpha: float = 0.0
    beta: float = 0.0


def pin_name(pin):
    """Return how errors name a pin."""
    return f"cut pin between {pin.body_a!r} and {pin.body_b!r}"


def check_pin(bodies, pin):
    """Refuse a pin that cannot close a loop of the table; a ValueError names it, the value and what is accepted."""
    name, rows = pin_name(pin), {body.name: row for row, body in enumerate(bodies)}
    for body in (pin.body_a, pin.body_b):
        if body not in rows:
            raise ValueError(f"{name}: there is no body {body!r}; known are {', '.join(rows)}")
    if pin.body_a == pin.body_b:
        raise ValueError(f"{name}: must join two different bodies")
    for item in ("point_a", "point_b", "axis"):
        values = getattr(pin, item)
        if np.shape(values) != (3,) or not all(map(isfinite, values)):
            raise ValueError(f"{name}: {item} is {values!r}, must be 3 finite numbers")
    check_axis(f"{name}: axis", pin.axis)
    for item in ("alpha", "beta"):
        value = getattr(pin, item)
        if not (isfinite(value) and value >= 0.0):
            raise ValueError(f"{name}: {item} is {value} 1/s, must be finite and >= 0")
    _check_loop(bodies, pin, rows)


def _check_loop(bodies, pin, rows):
    """The loop must stay in its planes: parallel axes, and both ends in the same plane across the pin's axis."""
    parents, axis = parent_rows(bodies), np.asarray(pin.axis, dtype=float) / np.linalg.norm(pin.axis)
    a, b = rows[pin.body_a], rows[pin.body_b]
    along, size = [np.dot(pin.point_b, axis) - np.dot(pin.point_a, axis)], np.abs([pin.point_a, pin.point_b]).max()
    while a != b:
        # parents stand before their children, so the later of the two is not the common ancestor
        row, sign = (a, -1.0) if a > b else (b, 1.0)
        hinge = bodies[row].hinge
        own = np.asarray(hinge.axis, dtype=float) / max(np.linalg.norm(hinge.axis), 1e-300)
        if not (
            hinge.kind == "locked"
            or (hinge.kind == "revolute" and np.linalg.norm(np.cross(own, axis)) <= PARALLEL)
            or (hinge.kind == "prismatic" and abs(own @ axis) <= PARALLEL)
        ):
            raise ValueError(
                f"{pin_name(pin)}: in its loop, hinge {hinge.number} of body {bodies[row].name!r} is {hinge.kind} with "
                f"axis {tuple(hinge.axis)}; accepted: revolute parallel to {tuple(pin.axis)}, prismatic "
                "perpendicular to it and locked"
            )
        along.append(sign * np.dot(hinge.place, axis))
        size = max(size, np.abs(hinge.place).max())
        a, b = (parents[a], b) if a > b else (a, parents[b])
    apart = abs(sum(along))
    if apart > PARALLEL * len(along) * size:
        raise ValueError(f"{pin_name(pin)}: its points are {apart} m apart along {tuple(pin.axis)}, must be 0 m")
