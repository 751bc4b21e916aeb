"""A damped mode, and who moves in it: shares of the bodies, the hinges and the whole tree in its kinetic energy."""

from dataclasses import dataclass

import numpy as np

from .tree import centre_of_mass, move

DIRECTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


@dataclass(frozen=True)
class Mode:
    """One damped mode, motion = Re(shape exp(pole t)).

    A pair of complex poles is one mode. A real pole (overdamped, or unstable without oscillation) is a separate mode
    with damping ratio 1 (or -1).

    Attributes
    ----------
    frequency : float
        |pole| / 2 pi [Hz]; oscillation is slower by sqrt(1 - damping_ratio^2).
    damping_ratio : float
        -Re(pole) / |pole|; negative grows.
    pole : complex
        [1/s], imaginary part >= 0.
    x : (n, 6) complex array
        Displacement [m] and rotation [rad] of every body's origin, global axes.
    coordinate : (n,) complex array
        Of the hinges [rad or m]. Shapes are scaled so that sum x^H M x over all bodies is 1, and turned so that the
        largest part of that sum is in phase with a real displacement.
    energy_share : (n,) array
        Share of each body in the kinetic energy; the sum is 1.
    root_share : (6,) array
        Share of the root, split into three displacements of its centre of mass and three rotations; the sum is
        energy_share[0].
    hinge_share : (n,) array
        Contribution of the motion in each hinge to the kinetic energy (its motion times its momentum), row 0 zero;
        can be negative.
    whole_share : (6,) array
        The same for the motion of the whole tree with the root, at the common centre of mass; with hinge_share the
        sum is 1.

    Examples
    --------
    >>> import numpy as np
    >>> from trackvib_sim import rui
    >>> rod = rui.Hinge(1, "revolute", "base", place=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    >>> bodies = [
    ...     rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3)),
    ...     rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), 0.1 * np.eye(3), rod),
    ... ]
    >>> model = rui.LinearModel(bodies, rui.rest_state(bodies), fixed_root=True)
    >>> (mode,) = rui.modes(model)
    >>> round(mode.frequency, 4), mode.overdamped
    (0.6435, False)
    """

    frequency: float
    damping_ratio: float
    pole: complex
    x: np.ndarray
    coordinate: np.ndarray
    energy_share: np.ndarray
    root_share: np.ndarray
    hinge_share: np.ndarray
    whole_share: np.ndarray

    @property
    def shape(self):
        """(n, 7) complex: displacement, rotation and hinge coordinate of every body."""
        return np.column_stack((self.x, self.coordinate))

    @property
    def overdamped(self):
        """Whether the pole is real."""
        return self.pole.imag == 0.0


def scaled_mode(tree, pole, x, coordinate):
    """Return the `Mode` with its shapes scaled and its energy shared out."""
    momentum = np.einsum("bij,bj->bi", tree.inertia, x)
    parts = np.real(np.sum(x.conj() * momentum, axis=1))
    main = np.unravel_index(np.argmax(np.abs(x * momentum)), x.shape)
    scale = np.conj(x[main]) / np.abs(x[main]) / np.sqrt(parts.sum())
    x, coordinate, momentum = x * scale, coordinate * scale, momentum * scale
    total = momentum.copy()  # of everything behind each cut, about the body's origin
    for row in reversed(range(1, len(total))):
        total[tree.parent[row]] += move(tree.lever[row]).T @ move(tree.offset[row]).T @ total[row]
    hinge_share = np.zeros(len(total))
    for row in range(1, len(total)):
        # of the body's end of the hinge against the parent's: along its axis, of an elastic hinge all of it
        relative = move(-tree.offset[row]) @ x[row] - move(tree.lever[row]) @ x[tree.parent[row]]
        hinge_share[row] = np.real(np.conj(relative) @ move(tree.offset[row]).T @ total[row])
    return Mode(
        float(np.abs(pole) / (2.0 * np.pi)),
        float(-pole.real / np.abs(pole)),
        complex(pole),
        x,
        coordinate,
        np.real(np.sum(x.conj() * momentum, axis=1)),
        _split(x[0], momentum[0], centre_of_mass(tree.inertia[0])),
        hinge_share,
        _split(x[0], total[0], centre_of_mass(_whole_inertia(tree))),
    )


def _whole_inertia(tree):
    """Return the inertia (6, 6) of the whole tree as one rigid body about the root's origin."""
    inertia = tree.inertia.copy()
    for row in reversed(range(1, len(inertia))):
        X = move(tree.offset[row]) @ move(tree.lever[row])
        inertia[tree.parent[row]] += X.T @ inertia[row] @ X
    return inertia[0]


def _split(x, momentum, point):
    """Return the six products of motion and momentum, both taken to a point (3,) from where they are."""
    there = move(point) @ x
    return np.real(np.conj(there) * (move(-point).T @ momentum))


def describe(model, mode, group=str, least=0.2):
    """Return a few words on a mode: the motions that bring the largest parts into its kinetic energy.

    Parameters
    ----------
    model : LinearModel
        In axes x forward, z up, for the names of the whole tree's motions.
    mode : Mode
    group : function
        From a body's name to the name under which the share of its hinge is summed up, such as "road arms".
    least : float
        Parts below this part of the largest are left out.
    """
    parts = {f"whole {name}": share for name, share in zip(DIRECTIONS, mode.whole_share, strict=True)}
    for body, share in zip(model.bodies[1:], mode.hinge_share[1:], strict=True):
        parts[group(body.name)] = parts.get(group(body.name), 0.0) + share
    main = sorted(parts, key=parts.get, reverse=True)
    return ", ".join(f"{name} {parts[name]:.0%}" for name in main[:4] if parts[name] >= least * parts[main[0]])
