"""Natural frequencies and undamped modes of a linearised tree, by sweeps of the transfer matrix method.

Frequencies come from bisection on the counting theorem (`sweep.count_below`), so that none is missed and
multiple ones are found as often as they occur. Modes come from inverse iteration, which takes one sweep a step and also
finds modes in which the root rests (derived in docs/method.md).
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

from .sweep import count_below, forced_motion, tips_to_root

BISECTED_TO = 1e-9  # relative width of the interval in which an eigenvalue is known
TOGETHER = 1e-5  # relative distance of eigenvalues that are iterated together
ITERATIONS = 5


class ModeShapes(NamedTuple):
    """Undamped modes of a `LinearTree`, lowest first; generalised mass 1."""

    omega_squared: np.ndarray  # (k,) rad^2/s^2, zero or negative for free and unstable motions
    x: np.ndarray  # (n, 6, k) displacement and rotation of every body's origin
    coordinate: np.ndarray  # (n, k) of the hinges


def number_of_freedoms(tree):
    """Return the number of eigenvalues: 6 of the root and of every body behind an elastic hinge, 1 a hinge."""
    freedoms = {"root": 0 if tree.fixed_root else 6, "elastic": 6, "moving": 1, "rigid": 0}
    return sum(freedoms[kind] for kind in tree.kind)


def natural_values(tree, highest=None):
    """Return all eigenvalues omega_n^2 below a limit, each as often as it occurs, by bisection.

    Parameters
    ----------
    tree : LinearTree
    highest : float or None
        Limit of omega^2 [rad^2/s^2]; None is no limit.

    Returns
    -------
    (k,) array
        Ascending [rad^2/s^2], to a relative 1e-9; free motions are zero but for rounding, unstable ones negative.
    """
    low, high = -1.0, 1.0 if highest is None else highest
    while count_below(tree, [low])[0] > 0:
        low = _further(low)
    if highest is None:
        while count_below(tree, [high])[0] < number_of_freedoms(tree):
            high = _further(high)
    low = min(low, high - 1.0)
    intervals = np.array([[low, high]])
    counts = count_below(tree, intervals[0])[None, :]
    while True:
        middle = intervals.mean(axis=1)
        width = intervals[:, 1] - intervals[:, 0]
        smallest = BISECTED_TO * np.maximum(np.abs(middle), 1e-6 * high)
        if np.all(width <= smallest):
            return np.repeat(middle, counts[:, 1] - counts[:, 0])
        at_middle = count_below(tree, middle)
        intervals = np.concatenate((np.c_[intervals[:, 0], middle], np.c_[middle, intervals[:, 1]]))
        counts = np.concatenate((np.c_[counts[:, 0], at_middle], np.c_[at_middle, counts[:, 1]]))
        # rounding next to an eigenvalue can make the count fall; such an interval is empty
        kept = counts[:, 1] > counts[:, 0]
        order = np.argsort(intervals[kept, 0])
        intervals, counts = intervals[kept][order], counts[kept][order]


def _further(limit):
    if not abs(limit) < 1e30:
        raise ValueError("the eigenvalues have no bounds: are all stiffnesses finite numbers?")
    return 4.0 * limit


def mode_shapes(tree, highest=None):
    """Return the `ModeShapes` below a limit `highest` of omega^2 [rad^2/s^2] (None: all)."""
    values = natural_values(tree, highest)
    n, count = len(tree.parent), len(values)
    shapes = ModeShapes(np.zeros(count), np.zeros((n, 6, count)), np.zeros((n, count)))
    if count == 0:
        return shapes
    scale = np.maximum(np.abs(values), 1e-6 * np.abs(values).max())
    first = np.flatnonzero(np.r_[True, np.diff(values) > TOGETHER * scale[1:]])
    sizes = np.diff(np.r_[first, count])
    for size in np.unique(sizes):
        starts = first[sizes == size]
        shift = values[starts] - 10.0 * BISECTED_TO * scale[starts]
        found = _inverse_iteration(tree, shift, size)
        places = starts[:, None] + np.arange(size)
        shapes.omega_squared[places] = found[0]
        shapes.x[:, :, places] = np.moveaxis(found[1], 0, 2)
        shapes.coordinate[:, places] = np.moveaxis(found[2], 0, 1)
    return shapes


def _inverse_iteration(tree, shift, size):
    """Return eigenvalues (F, size) next to each shift (F,) and their modes (F, n, 6, size), (F, n, size).

    Each step puts the inertia forces of the last vectors on the tree: (K - shift M) x' = M x.
    """
    sweep = tips_to_root(tree, -shift)
    random = np.random.default_rng(0)
    n = len(tree.parent)
    force, torque = random.standard_normal((1, n, 6, size)), random.standard_normal((1, n, size))
    x, coordinate = forced_motion(sweep, tree.inertia @ force, torque * tree.inertia[:, 5, 5, None])
    nothing = np.zeros((1, n, size))
    for _ in range(ITERATIONS):
        force = tree.inertia @ x
        scale = np.sqrt(np.einsum("fbim,fbim->fm", x, force))[:, None, None, :]
        force, before = force / scale, x / scale
        x, coordinate = forced_motion(sweep, force, nothing)
        stiffness = np.einsum("fbik,fbim->fkm", x, tree.inertia @ before)
        mass = np.einsum("fbik,fbim->fkm", x, tree.inertia @ x)
        values = np.zeros((len(shift), size))
        for k in range(len(shift)):
            values[k], mix = eigh(0.5 * (stiffness[k] + stiffness[k].T), mass[k])
            x[k], coordinate[k] = x[k] @ mix, coordinate[k] @ mix
    return shift[:, None] + values, x, coordinate
