"""Riccati form of the Rui method: the accelerations of a whole tree in two sweeps [Rui2020].

At every cut the internal force f = [q; m] is a linear function of the acceleration x = [a; al] of the same point,

    f = S x + s,        S = [[P, Q], [Q^T, R]] symmetric,

(q, m: what the tip side exerts on the root side). The forward sweep gathers S and s from the tips to the root, where
the free end (f = 0) gives the root's acceleration; the backward sweep hands accelerations out to the tips and gives the
wrench in every hinge. -S is the articulated-body inertia, -s the articulated bias force, so the cost is O(n) and the
pivot of a hinge, minus the inertia seen at its axis, is never zero for bodies with mass and inertia.
"""

from typing import NamedTuple

import numpy as np

from .compiled import kernel
from .spatial import (
    add,
    cross,
    dot,
    load3,
    load9,
    rotate,
    rotate_back,
    scale,
    store3,
    subtract,
    symmetric_product,
    turn_inertia,
)
from .tree import SLIDE


class Sweep(NamedTuple):
    """What the two sweeps leave behind, one row a body; the hinge quantities stand in the row of the child."""

    p: np.ndarray  # (n, 6) block P of S, symmetric
    q: np.ndarray  # (n, 9) block Q of S
    r: np.ndarray  # (n, 6) block R of S, symmetric
    s: np.ndarray  # (n, 6) free term of f
    u: np.ndarray  # (n, 6) S D
    pivot: np.ndarray  # (n,) D^T S D, negative
    gamma: np.ndarray  # (n,) D^T s' + tau
    linear: np.ndarray  # (n, 3) acceleration of the origin, m/s^2
    angular: np.ndarray  # (n, 3) angular acceleration, rad/s^2
    hinge_acceleration: np.ndarray  # (n,) rad/s^2 or m/s^2
    hinge_wrench: np.ndarray  # (n, 6) q, m of the child on the parent at the hinge point, N and N m
    root: np.ndarray  # (6, 6) room for -S of the root and its Cholesky factor (lower half)
    root_solution: np.ndarray  # (6,) the root's x


def new_sweep(n):
    """Return an empty record for n bodies."""
    shapes = ((n, 6), (n, 9), (n, 6), (n, 6), (n, 6), n, n, (n, 3), (n, 3), n, (n, 6), (6, 6), 6)
    return Sweep(*(np.zeros(shape) for shape in shapes))


@kernel
def solve_accelerations(tree, state, motion, loads, sweep):
    """Fill `sweep` with all accelerations and hinge wrenches for given motion and loads."""
    for b in range(tree.parent.size):
        _open_body(tree, motion, loads, sweep, b)
    for b in range(tree.parent.size - 1, 0, -1):
        _close_hinge(tree, state, motion, loads, sweep, b)
    _solve_root(sweep)
    for b in range(1, tree.parent.size):
        _hand_out(tree, state, motion, sweep, b)


@kernel
def _open_body(tree, motion, loads, sweep, b):
    """Start S, s of a body with its own inertia, velocity terms, gravity and loads, about its origin."""
    m = load9(motion.rotation, b)
    mass = tree.mass[b]
    c = rotate(m, add(load3(tree.centre, b), load3(motion.offset, b)))
    om = load3(motion.rate, b)
    i = tree.inertia
    j = turn_inertia(m, (i[b, 0], i[b, 1], i[b, 2], i[b, 3], i[b, 4], i[b, 5]))
    # -I_O = -[[M, -M c~], [M c~, J - M c~ c~]]
    sweep.p[b, 0] = sweep.p[b, 1] = sweep.p[b, 2] = -mass
    sweep.p[b, 3] = sweep.p[b, 4] = sweep.p[b, 5] = 0.0
    mx, my, mz = scale(mass, c)
    sweep.q[b, 0] = sweep.q[b, 4] = sweep.q[b, 8] = 0.0
    sweep.q[b, 1], sweep.q[b, 2] = -mz, my
    sweep.q[b, 3], sweep.q[b, 5] = mz, -mx
    sweep.q[b, 6], sweep.q[b, 7] = -my, mx
    sweep.r[b, 0] = -j[0] - my * c[1] - mz * c[2]
    sweep.r[b, 1] = -j[1] - mx * c[0] - mz * c[2]
    sweep.r[b, 2] = -j[2] - mx * c[0] - my * c[1]
    sweep.r[b, 3] = -j[3] + mx * c[1]
    sweep.r[b, 4] = -j[4] + mx * c[2]
    sweep.r[b, 5] = -j[5] + my * c[2]
    # gravity less centrifugal force at C, gyroscopic torque, loads at O
    gravity = (tree.gravity[0], tree.gravity[1], tree.gravity[2])
    centrifugal = cross(om, cross(om, c))
    f_c = scale(mass, subtract(gravity, centrifugal))
    gyro = cross(om, symmetric_product(j, om))
    f = add(f_c, load3(loads.force, b))
    t = add(subtract(cross(c, f_c), gyro), load3(loads.moment, b))
    for k in range(3):
        sweep.s[b, k] = f[k]
        sweep.s[b, 3 + k] = t[k]


@kernel
def _close_hinge(tree, state, motion, loads, sweep, b):
    """Carry S, s of body b through its hinge (D_h, S_h, s_h) and add them to the parent's, at the parent's origin."""
    a = tree.parent[b]
    e = load3(motion.axis, b)
    om = load3(motion.rate, b)
    p = (sweep.p[b, 0], sweep.p[b, 1], sweep.p[b, 2], sweep.p[b, 3], sweep.p[b, 4], sweep.p[b, 5])
    q = load9(sweep.q, b)
    r = (sweep.r[b, 0], sweep.r[b, 1], sweep.r[b, 2], sweep.r[b, 3], sweep.r[b, 4], sweep.r[b, 5])
    s_q = (sweep.s[b, 0], sweep.s[b, 1], sweep.s[b, 2])
    s_m = (sweep.s[b, 3], sweep.s[b, 4], sweep.s[b, 5])
    # x_I = x_O + D thdd + cc with D = [0; e] and cc = [0; thd Om x e], or [e; 0] and [2 sd Om x e; 0] for a slide
    slide = 1.0 if tree.kind[b] == SLIDE else 0.0
    d_q, d_m = scale(slide, e), scale(1.0 - slide, e)
    coriolis = scale(state.hinge_rate[b], cross(om, e))
    c_q, c_m = scale(2.0 * slide, coriolis), scale(1.0 - slide, coriolis)
    s_q = add(s_q, add(symmetric_product(p, c_q), rotate(q, c_m)))
    s_m = add(s_m, add(rotate_back(q, c_q), symmetric_product(r, c_m)))
    u_q = add(symmetric_product(p, d_q), rotate(q, d_m))
    u_m = add(rotate_back(q, d_q), symmetric_product(r, d_m))
    pivot = dot(d_q, u_q) + dot(d_m, u_m)
    gamma = dot(d_q, s_q) + dot(d_m, s_m) + loads.torque[b]
    w = 1.0 / pivot
    # S_h = S - u u^T / D_h, s_h = s' - u gamma / D_h
    x, y, z = scale(w, u_q)
    p = (
        p[0] - x * u_q[0], p[1] - y * u_q[1], p[2] - z * u_q[2],
        p[3] - x * u_q[1], p[4] - x * u_q[2], p[5] - y * u_q[2],
    )  # fmt: skip
    q = (
        q[0] - x * u_m[0], q[1] - x * u_m[1], q[2] - x * u_m[2],
        q[3] - y * u_m[0], q[4] - y * u_m[1], q[5] - y * u_m[2],
        q[6] - z * u_m[0], q[7] - z * u_m[1], q[8] - z * u_m[2],
    )  # fmt: skip
    x, y, z = scale(w, u_m)
    r = (
        r[0] - x * u_m[0], r[1] - y * u_m[1], r[2] - z * u_m[2],
        r[3] - x * u_m[1], r[4] - x * u_m[2], r[5] - y * u_m[2],
    )  # fmt: skip
    s_q = subtract(s_q, scale(w * gamma, u_q))
    s_m = subtract(s_m, scale(w * gamma, u_m))
    _store_hinge(sweep, b, p, q, r, s_q, s_m, u_q, u_m)
    sweep.pivot[b] = pivot
    sweep.gamma[b] = gamma
    lever = subtract(load3(motion.origin, b), load3(motion.origin, a))
    _add_moved(sweep, a, p, q, r, s_q, s_m, lever, load3(motion.rate, a))


@kernel
def _store_hinge(sweep, b, p, q, r, s_q, s_m, u_q, u_m):
    """Keep S_h, s_h (for the wrench) and u (for the hinge acceleration)."""
    for k in range(6):
        sweep.p[b, k] = p[k]
        sweep.r[b, k] = r[k]
    for k in range(9):
        sweep.q[b, k] = q[k]
    for k in range(3):
        sweep.s[b, k] = s_q[k]
        sweep.s[b, 3 + k] = s_m[k]
        sweep.u[b, k] = u_q[k]
        sweep.u[b, 3 + k] = u_m[k]


@kernel
def _add_moved(sweep, a, p, q, r, s_q, s_m, lever, om):
    """Add X^T S_h X and X^T (S_h d + s_h) to body a, where X moves accelerations from its origin by `lever`."""
    x, y, z = lever
    # Q' = Q - P [l]x
    q_moved = (
        q[0] - (p[3] * z - p[4] * y), q[1] - (p[4] * x - p[0] * z), q[2] - (p[0] * y - p[3] * x),
        q[3] - (p[1] * z - p[5] * y), q[4] - (p[5] * x - p[3] * z), q[5] - (p[3] * y - p[1] * x),
        q[6] - (p[5] * z - p[2] * y), q[7] - (p[2] * x - p[4] * z), q[8] - (p[4] * y - p[5] * x),
    )  # fmt: skip
    # R' = R + [l]x Q' + ([l]x Q)^T
    n = q_moved
    r_moved = (
        r[0] + (y * n[6] - z * n[3]) + (y * q[6] - z * q[3]),
        r[1] + (z * n[1] - x * n[7]) + (z * q[1] - x * q[7]),
        r[2] + (x * n[5] - y * n[2]) + (x * q[5] - y * q[2]),
        r[3] + (y * n[7] - z * n[4]) + (z * q[0] - x * q[6]),
        r[4] + (y * n[8] - z * n[5]) + (x * q[3] - y * q[0]),
        r[5] + (z * n[2] - x * n[8]) + (x * q[4] - y * q[1]),
    )
    d = cross(om, cross(om, lever))
    t_q = add(symmetric_product(p, d), s_q)
    t_m = add(add(rotate_back(q, d), s_m), cross(lever, t_q))
    for k in range(6):
        sweep.p[a, k] += p[k]
        sweep.r[a, k] += r_moved[k]
    for k in range(9):
        sweep.q[a, k] += q_moved[k]
    for k in range(3):
        sweep.s[a, k] += t_q[k]
        sweep.s[a, 3 + k] += t_m[k]


@kernel
def _solve_root(sweep):
    """Solve S x + s = 0 at the root's free end by the Cholesky factor of -S."""
    n, x = sweep.root, sweep.root_solution
    for i in range(3):
        for j in range(3):
            n[i, 3 + j] = n[3 + j, i] = -sweep.q[0, 3 * i + j]
        n[i, i] = -sweep.p[0, i]
        n[3 + i, 3 + i] = -sweep.r[0, i]
    n[1, 0], n[2, 0], n[2, 1] = -sweep.p[0, 3], -sweep.p[0, 4], -sweep.p[0, 5]
    n[4, 3], n[5, 3], n[5, 4] = -sweep.r[0, 3], -sweep.r[0, 4], -sweep.r[0, 5]
    for i in range(6):
        for k in range(i):
            n[i, i] -= n[i, k] * n[i, k]
        n[i, i] = np.sqrt(n[i, i])
        for j in range(i + 1, 6):
            for k in range(i):
                n[j, i] -= n[j, k] * n[i, k]
            n[j, i] /= n[i, i]
    for i in range(6):
        x[i] = sweep.s[0, i]
        for k in range(i):
            x[i] -= n[i, k] * x[k]
        x[i] /= n[i, i]
    for i in range(5, -1, -1):
        for k in range(i + 1, 6):
            x[i] -= n[k, i] * x[k]
        x[i] /= n[i, i]
    for j in range(3):
        sweep.linear[0, j] = x[j]
        sweep.angular[0, j] = x[3 + j]


@kernel
def _hand_out(tree, state, motion, sweep, b):
    """From the parent's acceleration: the wrench in the hinge of b, its coordinate's and the body's acceleration."""
    a = tree.parent[b]
    e = load3(motion.axis, b)
    om_a = load3(motion.rate, a)
    om_b = load3(motion.rate, b)
    lever = subtract(load3(motion.origin, b), load3(motion.origin, a))
    al = load3(sweep.angular, a)
    lin = add(load3(sweep.linear, a), add(cross(al, lever), cross(om_a, cross(om_a, lever))))
    p = (sweep.p[b, 0], sweep.p[b, 1], sweep.p[b, 2], sweep.p[b, 3], sweep.p[b, 4], sweep.p[b, 5])
    r = (sweep.r[b, 0], sweep.r[b, 1], sweep.r[b, 2], sweep.r[b, 3], sweep.r[b, 4], sweep.r[b, 5])
    q = load9(sweep.q, b)
    f_q = add(symmetric_product(p, lin), rotate(q, al))
    f_m = add(rotate_back(q, lin), symmetric_product(r, al))
    along = sweep.gamma[b]
    for k in range(3):
        sweep.hinge_wrench[b, k] = f_q[k] + sweep.s[b, k]
        sweep.hinge_wrench[b, 3 + k] = f_m[k] + sweep.s[b, 3 + k]
        along += sweep.u[b, k] * lin[k] + sweep.u[b, 3 + k] * al[k]
    thdd = -along / sweep.pivot[b]
    sweep.hinge_acceleration[b] = thdd
    if tree.kind[b] == SLIDE:
        lin = add(lin, add(scale(thdd, e), scale(2.0 * state.hinge_rate[b], cross(om_b, e))))
    else:
        al = add(al, add(scale(thdd, e), scale(state.hinge_rate[b], cross(om_b, e))))
    store3(sweep.linear, b, lin)
    store3(sweep.angular, b, al)


@kernel
def point_acceleration(motion, sweep, body, place):
    """Return the acceleration of the body-fixed point at a global place [m/s^2], gravity not subtracted."""
    arm = subtract(place, load3(motion.origin, body))
    om = load3(motion.rate, body)
    turning = add(cross(load3(sweep.angular, body), arm), cross(om, cross(om, arm)))
    return add(load3(sweep.linear, body), turning)
