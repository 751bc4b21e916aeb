"""Steady response of a tree about its equilibrium to harmonic forces and ground motion, one sweep a frequency.

Everything oscillates as Re(amplitude exp(i omega t)): a response that lags behind has a negative phase.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..reference.placement import place_bodies
from .equilibrium import check_equilibrium
from .model import LinearModel
from .sweep import forced_motion, tips_to_root
from .tree import move

AT_A_TIME = 256  # frequencies


@dataclass(frozen=True)
class At:
    """A point and direction of a body: force in and displacement out, or with `turning` moment in and rotation out.

    Examples
    --------
    >>> from trackvib_sim import rui
    >>> rui.At("arm", point=(0.0, 0.0, -1.0)).direction
    (0.0, 0.0, 1.0)
    """

    body: str
    point: tuple = (0.0, 0.0, 0.0)  # body axes, from its origin, m
    direction: tuple = (0.0, 0.0, 1.0)  # global axes, also of a length other than 1
    turning: bool = False


@dataclass(frozen=True)
class AtHinge:
    """A hinge, named by its child: torque (force) of the parent on the child in, coordinate out."""

    body: str


@dataclass(frozen=True)
class GroundMotion:
    """Displacement [m] of the ground under some of the model's springs, all alike; only in."""

    springs: tuple  # places in model.springs
    direction: tuple = (0.0, 0.0, 1.0)  # global axes


@dataclass(frozen=True)
class MountForce:
    """An extra force [N] of one of the model's mounts: on the child, and back on the parent at the same place; in."""

    mount: int  # place in model.mounts
    direction: tuple = field(default=(0.0, 0.0, 1.0))  # parent's axes


def frequency_response(
    model: LinearModel, frequencies: Sequence[float], inputs: Sequence, outputs: Sequence, derivative: int = 0
) -> np.ndarray:
    """Return amplitudes of outputs per unit of input.

    Parameters
    ----------
    model : LinearModel
        In equilibrium.
    frequencies : (F,) array
        > 0 [Hz].
    inputs : sequence of At, AtHinge, GroundMotion, MountForce
        Unit amplitude: 1 N, 1 N m, or 1 m of ground motion.
    outputs : sequence of At, AtHinge
    derivative : int
        0 displacement [m, rad], 1 speed, 2 acceleration, per unit of the input itself.

    Returns
    -------
    (F, outputs, inputs) complex array
        For a force in: receptance [m/N], mobility [m/(N s)], accelerance [m/(N s^2)].

    Raises
    ------
    ValueError
        The model is not at rest, a frequency is not above 0, or there is no such body.

    Examples
    --------
    A horizontal force moves the arm's end; well below resonance by 1 / (M g l) per newton.

    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> model = rui.LinearModel(bodies, rui.rest_state(bodies), fixed_root=True)
    >>> end = rui.At("arm", point=(0.0, 0.0, -1.0), direction=(1.0, 0.0, 0.0))
    >>> receptance = rui.frequency_response(model, [0.001], [end], [end])
    >>> round(float(abs(receptance[0, 0, 0])), 4)  # m/N
    0.1019
    """
    tree, where = check_equilibrium(model), place_bodies(model.bodies, model.state)
    rows = {body.name: row for row, body in enumerate(model.bodies)}
    s = 2j * np.pi * np.asarray(frequencies, dtype=float)
    if s.ndim != 1 or not np.all(s.imag > 0.0):
        raise ValueError(f"frequencies are {np.asarray(frequencies).tolist()}, must be a list of values > 0 Hz")
    readings = [_reading(output, rows, where) for output in outputs]
    n, response = len(model.bodies), np.zeros((len(s), len(outputs), len(inputs)), dtype=complex)
    for start in range(0, len(s), AT_A_TIME):
        part = slice(start, start + AT_A_TIME)
        wrench = np.zeros((len(s[part]), n, 6, len(inputs)), dtype=complex)
        torque = np.zeros((len(s[part]), n, len(inputs)), dtype=complex)
        for k, item in enumerate(inputs):
            _apply(item, model, rows, where, s[part], wrench[..., k], torque[..., k])
        x, coordinate = forced_motion(tips_to_root(tree, s[part] ** 2, s[part]), wrench, torque)
        for k, (row, vector) in enumerate(readings):
            response[part, k] = coordinate[:, row] if vector is None else vector @ x[:, row]
    return response * s[:, None, None] ** derivative


def transmissibility(model, frequencies, drive, output, reference):
    """Return the ratio (F,) of the amplitudes of `output` and `reference` (At, AtHinge) under one input `drive`.

    With a GroundMotion as drive and `reference` None, the ratio is to the ground's displacement.
    """
    if reference is None:
        if not isinstance(drive, GroundMotion):
            raise ValueError("transmissibility without a reference point must be driven by a GroundMotion")
        return frequency_response(model, frequencies, [drive], [output])[:, 0, 0]
    both = frequency_response(model, frequencies, [drive], [output, reference])[:, :, 0]
    return both[:, 0] / both[:, 1]


def _row(name, rows):
    if name not in rows:
        raise ValueError(f"there is no body {name!r}; known are {', '.join(rows)}")
    return rows[name]


def _at(item, rows, where):
    """Return row and vector (6,) that reads the motion of a body's origin and, as a wrench, drives it."""
    row, r = _row(item.body, rows), None
    if item.turning:
        return row, np.concatenate((np.zeros(3), np.asarray(item.direction, dtype=float)))
    r = where.rotation[row] @ item.point
    return row, move(r)[:3].T @ np.asarray(item.direction, dtype=float)


def _reading(item, rows, where):
    if isinstance(item, AtHinge):
        return _row(item.body, rows), None
    if isinstance(item, At):
        return _at(item, rows, where)
    raise ValueError(f"{item!r} is no output, only At and AtHinge are")


def _apply(item, model, rows, where, s, wrench, torque):
    """Add one input to wrench (F, n, 6) and torque (F, n)."""
    if isinstance(item, AtHinge):
        torque[:, _row(item.body, rows)] = 1.0
    elif isinstance(item, At):
        row, vector = _at(item, rows, where)
        wrench[:, row] += vector
    elif isinstance(item, GroundMotion):
        for spring in (model.springs[k] for k in item.springs):
            row, size = rows[spring.body], len(spring.stiffness)
            at_point = move(where.rotation[row] @ spring.point)[:size].T
            by_stiffness = at_point @ np.asarray(spring.stiffness)[:, :3] @ item.direction
            by_damping = at_point @ np.asarray(spring.damping)[:, :3] @ item.direction
            wrench[:, row] += by_stiffness + s[:, None] * by_damping
    elif isinstance(item, MountForce):
        mount = model.mounts[item.mount]
        row = rows[mount.body]
        parent = rows[model.bodies[row].hinge.parent]
        force, r = where.rotation[parent] @ item.direction, where.rotation[row] @ mount.point
        wrench[:, row] += move(r)[:3].T @ force
        wrench[:, parent] -= move(where.origin[row] + r - where.origin[parent])[:3].T @ force
    else:
        raise ValueError(f"{item!r} is no input, must be At, AtHinge, GroundMotion or MountForce")
