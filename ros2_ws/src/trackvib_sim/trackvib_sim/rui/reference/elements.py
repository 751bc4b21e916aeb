"""Transfer equations of the elements: 13 x 13 matrices in plain NumPy, written as they stand on paper.

The state vector of a connection point P is z = [a; al; m; q; 1]: acceleration of P (gravity not subtracted) and angular
acceleration, internal moment and internal force (what the tip's side exerts on the root's side), and a one that
carries everything known along in column 13. All vectors in global axes, SI units.

Every element is passed from the tips to the root of the table, so the input side of every hinge is the child. The
equations are those of [Rui2020], as [Tao2025] applies them; hinge matrices and geometric rows, which those papers do
not print, are derived in docs/method.md. r_XY is the vector from X to Y.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

A, AL, M, Q, ONE = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 12), 12  # places in the state vector


class HingeMatrices(NamedTuple):
    """A hinge as z_O = U z_I + b thdd together with E z_I = 0; b and E are None where thdd is no unknown."""

    U: np.ndarray  # (13, 13) the paper's U_H
    b: np.ndarray | None = None  # (13,) what the unknown hinge acceleration does to z_O
    E: np.ndarray | None = None  # (13,) the known moment or force along the axis


def cross_matrix(v):
    """Return the (3, 3) matrix [v]x with [v]x w = v x w (the paper's tilde)."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rigid_body(mass, inertia, rate, r_io, r_ic, force, moment):
    """Return U (13, 13) of a rigid body from its (first) input I to its output O [Rui2020].

    The acceleration rows are rigid-body kinematics, the moment and force rows Euler's and Newton's equations.

    Parameters
    ----------
    mass : float
        M [kg].
    inertia : (3, 3) array
        J, about the centre of mass C, global axes [kg m^2].
    rate : (3,) array
        Om, angular velocity [rad/s].
    r_io, r_ic : (3,) arrays
        From the input to the output and to the centre of mass [m].
    force, moment : (3,) arrays
        F, external force including the weight, at C [N], and l, external moment about C [N m].
    """
    r_co = np.subtract(r_io, r_ic)
    io, ic, co = cross_matrix(r_io), cross_matrix(r_ic), cross_matrix(r_co)
    w2 = cross_matrix(rate) @ cross_matrix(rate)
    U = np.eye(13)
    U[A, AL] = -io
    U[A, ONE] = w2 @ r_io
    U[M, A] = mass * co
    U[M, AL] = -(inertia + mass * co @ ic)
    U[M, Q] = -io
    U[M, ONE] = mass * co @ w2 @ r_ic - co @ force + moment - np.cross(rate, inertia @ rate)
    U[Q, A] = -mass * np.eye(3)
    U[Q, AL] = mass * ic
    U[Q, ONE] = force - mass * w2 @ r_ic
    return U


def further_input(r_ko):
    """Return U_Ik (13, 13) of a body's further input Ik, at r_ko [m] from the output: force transmission only.

    Also its last row is zero: each z_Ik carries a one, and only that of the first input may be handed on.
    """
    U = np.zeros((13, 13))
    U[M, M] = U[Q, Q] = np.eye(3)
    U[M, Q] = -cross_matrix(r_ko)
    return U


def geometric_rows(rate, r_1k):
    """Return H_1k (6, 13) of a body: H_1k z_I1 = [a; al] of its further input Ik.

    `rate` is the body's angular velocity [rad/s], `r_1k` the vector from the first input to input k [m].
    """
    H = np.zeros((6, 13))
    H[A, A] = H[AL, AL] = np.eye(3)
    H[A, AL] = -cross_matrix(r_1k)
    H[A, ONE] = cross_matrix(rate) @ cross_matrix(rate) @ r_1k
    return H


def revolute_hinge(axis, rate, hinge_rate, torque):
    """Return the matrices of the paper's column hinge, which turns about a unit `axis` fixed in both bodies.

    Parameters
    ----------
    axis : (3,) array
        e.
    rate : (3,) array
        Om_I, angular velocity of the child [rad/s].
    hinge_rate : float
        thd, rate of turn of the child relative to the parent [rad/s].
    torque : float
        tau, of parent on child about the axis [N m]; E says e . m = -tau.
    """
    U, b, E = np.eye(13), np.zeros(13), np.zeros(13)
    U[AL, ONE] = -hinge_rate * np.cross(rate, axis)
    b[AL] = -np.asarray(axis)
    E[M], E[ONE] = axis, torque
    return HingeMatrices(U, b, E)


def prismatic_hinge(axis, rate, slide, slide_rate, force):
    """Return the matrices of a hinge that slides along a unit `axis`.

    Input I is the child's origin, output O the hinge point on the parent: r_IO = d = -e s.

    Parameters
    ----------
    axis : (3,) array
        e.
    rate : (3,) array
        Om, angular velocity of both bodies [rad/s].
    slide, slide_rate : float
        s [m] and its rate [m/s], of the child relative to the parent.
    force : float
        tau, of parent on child along the axis [N]; E says e . q = -tau.
    """
    d = -slide * np.asarray(axis)
    U, b, E = np.eye(13), np.zeros(13), np.zeros(13)
    U[A, AL] = U[M, Q] = -cross_matrix(d)
    # the parent's point is passed by the child: centripetal and Coriolis acceleration, seen from the child
    U[A, ONE] = np.cross(rate, np.cross(rate, d)) - 2.0 * slide_rate * np.cross(rate, axis)
    b[A] = -np.asarray(axis)
    E[Q], E[ONE] = axis, force
    return HingeMatrices(U, b, E)


def locked_hinge():
    """Return the matrices of a hinge that does not move: everything passes."""
    return HingeMatrices(np.eye(13))


def prescribed_hinge(hinge, acceleration):
    """Return the matrices of a revolute or prismatic hinge whose acceleration [rad/s^2 or m/s^2] is known.

    b thdd moves into column 13, and the row E is dropped because the torque of the drive is now a result: -e . m
    (revolute) or -e . q (prismatic) of the state that is passed.
    """
    U = hinge.U.copy()
    U[:, ONE] += hinge.b * acceleration
    return HingeMatrices(U)


def elastic_hinge(stiffness, damping, parent_axes, child_axes, displacement, velocity, rate):
    """Return the wrench q, m of the child on the parent in a bushing, m about the child's origin.

    The wrench is known from the state, so an elastic hinge cuts the tree. Action and reaction have the child's origin
    as their one point: were the parent loaded at its own point, the pair would be a couple that creates angular
    momentum, and the force would do other work than its potential loses (derived in docs/method.md).

    Parameters
    ----------
    stiffness, damping : (6,) arrays
        Three displacements, three rotations, in the parent's axes [N/m, N m/rad; N s/m, N m s/rad].
    parent_axes, child_axes : (3, 3) arrays
        Rotation of body axes to global axes.
    displacement : (3,) array
        From the hinge point on the parent to the child's origin, global [m].
    velocity : (3,) array
        Rate of `displacement` as the turning parent sees it, in global axes [m/s].
    rate : (3,) array
        Angular velocity of the child relative to the parent, global [rad/s].
    """
    to_parent = parent_axes.T
    turn = Rotation.from_matrix(to_parent @ child_axes).as_rotvec()
    deflection = np.concatenate((to_parent @ displacement, turn))
    speed = np.concatenate((to_parent @ velocity, to_parent @ rate))
    pull = np.asarray(stiffness) * deflection + np.asarray(damping) * speed
    return parent_axes @ pull[:3], parent_axes @ pull[3:]
