"""Inverse dynamics by Newton and Euler: the manufactured solution that `scaling.py` measures accuracy with."""

import numpy as np
from trackvib_sim.numerics.compiled import kernel
from trackvib_sim.numerics.spatial import add, cross, dot, load3, rotate, scale
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import MotionOffset


def required_torques(bodies, motion, hinge_rate, hinge_acceleration, gravity):
    """Return (torques (n,), force (3,), moment (3,)): for them hinges accelerate as given and the root not at all.

    For a chain of revolute hinges in the order of its table, one body a row. Force and moment act at the root's origin.
    """
    turn = columns(motion, MotionOffset.ROTATION, 9).reshape(-1, 3, 3)
    centre = np.einsum("nij,nj->ni", turn, np.array([body.centre for body in bodies], dtype=float))
    inertia = turn @ np.array([body.inertia for body in bodies], dtype=float) @ turn.transpose(0, 2, 1)
    mass = np.array([body.mass for body in bodies], dtype=float)
    lever, axis, rate = (
        columns(motion, quantity, 3)
        for quantity in (MotionOffset.LEVER, MotionOffset.HINGE_AXIS, MotionOffset.ANGULAR_VELOCITY)
    )
    n = len(bodies)
    force, moment, torques = np.zeros((n + 1, 3)), np.zeros((n + 1, 3)), np.zeros(n)
    a, al = np.zeros((n, 3)), np.zeros((n, 3))
    a[0] = -np.array(gravity, dtype=float)
    _outwards(lever, axis, rate, hinge_rate, hinge_acceleration, a, al)
    _inwards(mass, centre, inertia.reshape(n, 9), lever, axis, rate, a, al, force, moment, torques)
    return torques, force[0], moment[0]


@kernel
def _store(array, row, v):
    array[row, 0], array[row, 1], array[row, 2] = v[0], v[1], v[2]


@kernel
def _outwards(lever, axis, rate, hinge_rate, hinge_acceleration, a, al):
    """Accelerations of all origins, less gravity."""
    for b in range(1, len(a)):
        om, al_p, l, e = load3(rate, b - 1), load3(al, b - 1), load3(lever, b), load3(axis, b)
        _store(a, b, add(load3(a, b - 1), add(cross(al_p, l), cross(om, cross(om, l)))))
        own = add(scale(hinge_acceleration[b], e), scale(hinge_rate[b], cross(om, e)))
        _store(al, b, add(al_p, own))


@kernel
def _inwards(mass, centre, inertia, lever, axis, rate, a, al, force, moment, torques):
    """Forces and moments that each body needs at its origin for itself and all behind it."""
    for b in range(len(a) - 1, -1, -1):
        c, om, al_b = load3(centre, b), load3(rate, b), load3(al, b)
        j = inertia[b]
        m = (j[0], j[1], j[2], j[3], j[4], j[5], j[6], j[7], j[8])
        f = scale(mass[b], add(load3(a, b), add(cross(al_b, c), cross(om, cross(om, c)))))
        t = add(add(rotate(m, al_b), cross(om, rotate(m, om))), cross(c, f))
        if b + 1 < len(a):
            behind = load3(force, b + 1)
            t = add(t, add(load3(moment, b + 1), cross(load3(lever, b + 1), behind)))
            f = add(f, behind)
        _store(force, b, f)
        _store(moment, b, t)
        torques[b] = dot(load3(axis, b), t)
