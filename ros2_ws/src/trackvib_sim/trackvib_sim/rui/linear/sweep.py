"""Riccati sweeps of a linearised tree for motions exp(s t): dynamic stiffness at the root, counting, forced motion.

At every cut f = S x + e: S (6, 6) from what lies behind the cut, e (6,) from the forces there. The tips-to-root sweep
of the Riccati transfer matrix method [Rui2020] with the order [q; m] against [a; al] that makes S symmetric up to the
static moment; terms of the static loads and the counting theorem are derived in docs/method.md.

All functions work on many values of s at a time: arrays start with an axis of length F.
"""

from typing import NamedTuple

import numpy as np

from ..reference.elements import cross_matrix
from .tree import LinearTree, move


class Sweep(NamedTuple):
    """Result of `tips_to_root`: what `forced_motion` needs of every body."""

    tree: LinearTree
    root: np.ndarray  # (F, 6, 6) S of the root about its origin, nothing acting on its free side
    body: list  # (F, 6, 6) S of every body about its origin
    pull: list  # moving hinges: (F, 6) axis load by the motion at P; others None
    push: list  # moving hinges: (F, 6) wrench at P by the coordinate; others None
    pivot: list  # moving hinges: (F,) D_h, coordinate to axis load; elastic hinges: (F, 6, 6); others None
    on_progress: list  # elastic hinges: (F, 6, 6) from x_P to x of the child; others None


def tips_to_root(tree, s_squared, s=None):
    """Carry S from the tips to the root.

    Parameters
    ----------
    tree : LinearTree
    s_squared : (F,) array
        s^2 [1/s^2]: -omega^2 of an undamped oscillation.
    s : (F,) array or None
        What damping is multiplied with [1/s]; None leaves damping out.
    """
    s_squared = np.asarray(s_squared)
    n, count = len(tree.parent), len(s_squared)
    rate = np.zeros(count) if s is None else np.asarray(s)
    S = np.zeros((n, count, 6, 6), dtype=np.result_type(s_squared, rate, float))
    pull, push, pivot, on_progress = ([None] * n for _ in range(4))
    for row in reversed(range(n)):
        S[row] -= _by_s(tree.inertia[row], s_squared) + tree.stiffness[row] + _by_s(tree.damping[row], rate)
        if row == 0:
            break
        X, D = move(tree.offset[row]), tree.axis[row]
        if tree.kind[row] == "elastic":
            bushing = tree.bushings[row]
            pivot[row] = S[row] - bushing.child - _by_s(bushing.child_rate, rate)
            on_progress[row] = np.linalg.solve(pivot[row], bushing.parent + _by_s(bushing.parent_rate, rate))
            at_hinge = X.T @ S[row] @ on_progress[row] - _carried_load(tree, row) @ (on_progress[row] - np.eye(6))
        else:
            at_hinge = X.T @ S[row] @ X
            at_hinge[:, 3:, 3:] += tree.shift[row]
        if tree.kind[row] == "moving":
            pull[row] = D @ at_hinge + tree.axis_turn[row]
            push[row] = at_hinge @ D + tree.lever_load[row]
            pivot[row] = at_hinge @ D @ D - tree.hinge_stiffness[row] - rate * tree.hinge_damping[row]
            at_hinge = at_hinge - push[row][:, :, None] * pull[row][:, None, :] / pivot[row][:, None, None]
        to_parent = move(tree.lever[row])
        S[tree.parent[row]] += to_parent.T @ at_hinge @ to_parent
    return Sweep(tree, S[0], list(S), pull, push, pivot, on_progress)


def count_below(tree, omega_squared):
    """Return how many eigenvalues omega_n^2 of the undamped tree lie below each value (counting theorem).

    A hinge whose pivot D_h is positive counts one; a body behind an elastic hinge and the root count the positive
    eigenvalues of their S. Eigenvalues that are zero (free motion) or negative (unstable) count like any other.

    Parameters
    ----------
    omega_squared : (F,) array
        [rad^2/s^2]; no eigenvalue itself.
    """
    sweep = tips_to_root(tree, -np.asarray(omega_squared, dtype=float))
    counts = np.zeros(len(omega_squared), dtype=int)
    for row, kind in enumerate(tree.kind):
        if kind == "moving":
            counts += sweep.pivot[row] > 0.0
        elif kind == "elastic":
            counts += _positive(sweep.pivot[row])
    return counts if tree.fixed_root else counts + _positive(sweep.root)


def forced_motion(sweep, wrench, torque):
    """Return the motion under given forces, for m load cases at a time.

    Parameters
    ----------
    sweep : Sweep
    wrench : (F or 1, n, 6, m) array
        On every body: force, moment about its origin.
    torque : (F or 1, n, m) array
        On the child by the parent along the axis of every hinge.

    Returns
    -------
    x : (F, n, 6, m) array
        Displacement and rotation of every body's origin.
    coordinate : (F, n, m) array
        Of the hinges.
    """
    tree, count, n = sweep.tree, len(sweep.root), len(sweep.body)
    dtype = np.result_type(sweep.root, wrench, torque)
    e = np.array(np.broadcast_to(wrench, (count, *np.shape(wrench)[1:])), dtype=dtype)
    torque = np.broadcast_to(torque, (count, *np.shape(torque)[1:]))
    axis_load = np.zeros(torque.shape, dtype=dtype)
    own = {}  # elastic hinges: motion of the child while the parent rests
    for row in reversed(range(1, n)):
        X = move(tree.offset[row])
        if tree.kind[row] == "elastic":
            own[row] = -np.linalg.solve(sweep.pivot[row], e[:, row])
            at_hinge = X.T @ (sweep.body[row] @ own[row] + e[:, row]) - _carried_load(tree, row) @ own[row]
        else:
            at_hinge = X.T @ e[:, row]
        if tree.kind[row] == "moving":
            axis_load[:, row] = tree.axis[row] @ at_hinge + torque[:, row]
            share = axis_load[:, row] / sweep.pivot[row][:, None]
            at_hinge = at_hinge - sweep.push[row][:, :, None] * share[:, None, :]
        e[:, tree.parent[row]] += move(tree.lever[row]).T @ at_hinge

    x, coordinate = np.zeros_like(e), np.zeros_like(axis_load)
    if not tree.fixed_root:
        x[:, 0] = -np.linalg.solve(sweep.root, e[:, 0])
    for row in range(1, n):
        at_hinge = move(tree.lever[row]) @ x[:, tree.parent[row]]
        if tree.kind[row] == "elastic":
            x[:, row] = sweep.on_progress[row] @ at_hinge + own[row]
            continue
        if tree.kind[row] == "moving":
            by_motion = (sweep.pull[row][:, None, :] @ at_hinge)[:, 0]
            coordinate[:, row] = -(by_motion + axis_load[:, row]) / sweep.pivot[row][:, None]
            at_hinge = at_hinge + tree.axis[row][:, None] * coordinate[:, row][:, None, :]
        x[:, row] = move(tree.offset[row]) @ at_hinge
    return x, coordinate


def inertia_only(tree):
    """Return `tree` with no stiffness, damping or static load: its `forced_motion` at s^2 = 1 are accelerations."""
    empty = {"stiffness", "damping", "hinge_stiffness", "hinge_damping", "shift", "axis_turn", "lever_load", "static"}
    nothing = np.zeros((6, 6))
    bushings = {row: type(bushing)(*(nothing,) * 4) for row, bushing in tree.bushings.items()}
    return tree._replace(bushings=bushings, **{name: np.zeros_like(getattr(tree, name)) for name in empty})


def unbalanced_accelerations(tree):
    """Return accelerations x (n, 6) [m/s^2, rad/s^2] and of the hinges (n,): zero in equilibrium."""
    sweep = tips_to_root(inertia_only(tree), np.ones(1))
    x, coordinate = forced_motion(sweep, tree.unbalanced[None, :, :, None], tree.unbalanced_torque[None, :, None])
    return x[0, :, :, 0], coordinate[0, :, 0]


def _by_s(matrix, s):
    return s[:, None, None] * matrix


def _carried_load(tree, row):
    """Moment about P (6, 6) by displacement of the child against P: its static force acts at the child."""
    load = np.zeros((6, 6))
    load[3:, :3] = cross_matrix(tree.static[row, :3])
    return load


def _positive(S):
    """Number of positive eigenvalues of the symmetric part of each S (F, 6, 6)."""
    symmetric = 0.5 * (S + np.swapaxes(S, 1, 2))
    return np.sum(np.linalg.eigvalsh(symmetric) > 0.0, axis=1)
