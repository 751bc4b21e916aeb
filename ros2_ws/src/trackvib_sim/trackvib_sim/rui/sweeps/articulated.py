"""What is known at the cut inside of each body's hinge: first its own inertia and loads, then its whole branch.

At every cut the internal force f = [q; m] is a linear function of the acceleration x = [a; al] of the same point,

    f = S x + s,        S = [[P, Q], [Q^T, R]] symmetric,

(q, m: what the tip side exerts on the root side). `open_cuts` starts S and s of every body with its own inertia,
velocity-dependent terms and hinge torque. Springs, dampers, contacts and drives then add their wrenches to s, and the
tip-to-root sweep (`riccati`) adds what each branch hands on. So loads hold for one evaluation: the sweep uses them up.

x counts from free fall along the present motion: the acceleration that the body would have if neither the root nor any
hinge accelerated (`MotionOffset.DRIFT`), and that of gravity, are taken off. Nothing but s depends on velocities then.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ...numerics.spatial import (
    add,
    add_symmetric,
    cross,
    multiply,
    rotate,
    scale,
    scale_symmetric,
    subtract,
    symmetric_product,
    turn_inertia,
)
from .cells import add3, add6, add9, get3, get6, get9, new_cells, put3, put6, put9
from .kinematics import MotionOffset, motion_vector, point_velocity
from .tree import BodyOffset


class CutOffset(IntEnum):
    """Where the quantities of a cut begin in `Cuts.cells`."""

    P = 0  # blocks of S: kg, kg m, kg m^2
    Q = 6
    R = 15
    FORCE = 21  # s: N, N m about the origin
    MOMENT = 24
    TORQUE = 27  # of the hinge on the child along the axis, N m (N for a prismatic one)
    IMPEDANCE = 28  # of the hinge, what an implicit step adds to the inertia at the axis
    DRIVE = 29  # acceleration of a prescribed hinge, rad/s^2 (m/s^2)
    U_FORCE = 30  # u = S D
    U_MOMENT = 33
    MOBILITY = 36  # 1 / (D^T S D - impedance), 0 for a prescribed hinge
    GAMMA = 37  # D^T s + torque
    SIZE = 38
    POOLED = 30  # all before it are summed where a body stands alone


class Cuts(NamedTuple):
    """The cuts of a whole tree."""

    lanes: tuple
    cells: np.ndarray  # (blocks, CUT W)


def new_cuts(tree):
    """Return an empty record."""
    return Cuts(tree.lanes, new_cells(len(tree.parent), CutOffset.SIZE * len(tree.lanes)))


@inlined
def open_cuts(tree, motion, torques, cuts):
    """Start S and s of every body with what is its own, and every hinge with its torque.

    `torques` (rows,) are those of the hinges on the children along the axes [N m] (forces [N] for prismatic ones).
    """
    w = len(tree.lanes)
    for j in range(tree.parent.size):
        body, m, cut, torque = tree.body[j], motion.cells[j], cuts.cells[j], torques[j * w : (j + 1) * w]
        for i in range(tree.width[0]):
            _open(body, m, cut, w, i)
            put3(cut, CutOffset.TORQUE, w, i, (torque[i], 0.0, 0.0))  # no impedance, no drive


@inlined
def _open(body, m, cut, w, i):
    """S = -I_O = -[[M, -M c~], [M c~, J_O]], s = -[M a + al x M c + Om x (Om x M c); J_O al + Om x J_O Om + M c x a].

    a and al are those of the drift.
    """
    rotation = get9(m, MotionOffset.ROTATION, w, i)
    mass = body[BodyOffset.MASS * w + i]
    mc = rotate(rotation, get3(body, BodyOffset.MASS_MOMENT, w, i))
    j = turn_inertia(rotation, get6(body, BodyOffset.INERTIA, w, i))
    om, al, a = (
        get3(m, MotionOffset.ANGULAR_VELOCITY, w, i),
        get3(m, MotionOffset.ANGULAR_DRIFT, w, i),
        get3(m, MotionOffset.DRIFT, w, i),
    )
    put6(cut, CutOffset.P, w, i, (-mass, -mass, -mass, 0.0, 0.0, 0.0))
    put9(cut, CutOffset.Q, w, i, (0.0, -mc[2], mc[1], mc[2], 0.0, -mc[0], -mc[1], mc[0], 0.0))
    put6(cut, CutOffset.R, w, i, (-j[0], -j[1], -j[2], -j[3], -j[4], -j[5]))
    force = add(scale(mass, a), add(cross(al, mc), cross(om, cross(om, mc))))
    moment = add(add(symmetric_product(j, al), cross(om, symmetric_product(j, om))), cross(mc, a))
    put3(cut, CutOffset.FORCE, w, i, scale(-1.0, force))
    put3(cut, CutOffset.MOMENT, w, i, scale(-1.0, moment))


@inlined
def apply_force(cuts, motion, body, place, force):
    """Add a force [N] that acts on a body at a global place."""
    apply_wrench(cuts, body, force, cross(subtract(place, motion_vector(motion, MotionOffset.ORIGIN, body)), force))


@inlined
def apply_wrench(cuts, body, force, moment):
    """Add a force [N] and a moment about the body's origin [N m]."""
    w = len(cuts.lanes)
    cut = cuts.cells[body // w]
    add3(cut, CutOffset.FORCE, w, body % w, 1.0, force)
    add3(cut, CutOffset.MOMENT, w, body % w, 1.0, moment)


@kernel
def prescribe(cuts, body, acceleration):
    """Set the acceleration of a prescribed hinge [rad/s^2, m/s^2 for a prismatic one]."""
    w = len(cuts.lanes)
    cuts.cells[body // w, CutOffset.DRIVE * w + body % w] = acceleration


@kernel
def apply_implicit_spring(cuts, state, body, stiffness, damping, dt):
    """Make a spring and damper in a hinge linearly implicit over a step dt; its torque itself is added as ever.

    At the end of the step the torque has changed by -k dt thd - (c dt + k dt^2) thdd, derived in docs/method.md.
    """
    w = len(cuts.lanes)
    cut, i = cuts.cells[body // w], body % w
    cut[CutOffset.TORQUE * w + i] -= stiffness * dt * state.hinge_rate[body]
    cut[CutOffset.IMPEDANCE * w + i] += damping * dt + stiffness * dt * dt


@kernel
def apply_implicit_bush(cuts, motion, gravity, body, place, stiffness, damping, dt):
    """The same for a spring and damper between ground and the body-fixed point at a global place.

    `stiffness` [N/m] and `damping` [N s/m] are symmetric matrices (xx, yy, zz, xy, xz, yz), global axes.
    """
    w = len(cuts.lanes)
    cut, i = cuts.cells[body // w], body % w
    r = subtract(place, motion_vector(motion, MotionOffset.ORIGIN, body))
    om = motion_vector(motion, MotionOffset.ANGULAR_VELOCITY, body)
    z = add_symmetric(scale_symmetric(dt, damping), scale_symmetric(dt * dt, stiffness))
    fall = add(motion_vector(motion, MotionOffset.DRIFT, body), (gravity[0], gravity[1], gravity[2]))
    fall = add(fall, add(cross(motion_vector(motion, MotionOffset.ANGULAR_DRIFT, body), r), cross(om, cross(om, r))))
    velocity = point_velocity(motion, body, place)
    force = scale(-1.0, add(scale(dt, symmetric_product(stiffness, velocity)), symmetric_product(z, fall)))
    add3(cut, CutOffset.FORCE, w, i, 1.0, force)
    add3(cut, CutOffset.MOMENT, w, i, 1.0, cross(r, force))
    # S gains -X^T Z X with X = [I, -r~]
    full = (z[0], z[3], z[4], z[3], z[1], z[5], z[4], z[5], z[2])
    tilde = (0.0, -r[2], r[1], r[2], 0.0, -r[0], -r[1], r[0], 0.0)
    zr = multiply(full, tilde)
    rzr = multiply(tilde, zr)
    add6(cut, CutOffset.P, w, i, -1.0, z)
    add9(cut, CutOffset.Q, w, i, 1.0, zr)
    add6(cut, CutOffset.R, w, i, 1.0, (rzr[0], rzr[4], rzr[8], rzr[1], rzr[2], rzr[5]))
