"""A track as a closed chain of pins: how its numbers lie in memory, and how it moves.

Each pin is a node that carries the mass of one shoe; link i runs from node i to node i + 1. The order is that of the
lower run from rear to front, the idler, the upper run from front to rear, the sprocket. The road wheels run over the
chain, so a wheel's link has a growing number while the vehicle drives forward.

Nodes have numbers 1 to n. Cells 0 and n + 1 repeat nodes n and 1, so that neighbours are found without a search for
the ends of the chain. Quantity q of node i stands in cell q STRIDE + i: STRIDE is known to the compiler, which
therefore knows that quantities do not overlap and makes vector instructions of the loops over nodes. It is an odd
number of cache lines, because quantities an even number apart would evict each other from the cache. Node 1 is where
such a line begins.

The loops are unrolled by hand, component by component: a tidy `add_links` over small vectors was measured 2.7 times
slower.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...rui.sweeps.cells import new_cells
from ...rui.sweeps.kinematics import MotionOffset, motion_vector, rotation

STRIDE = 264
FEWEST_LINKS, MOST_LINKS = 30, 250


class NodeOffset(IntEnum):
    """Quantities of a node's state, global axes."""

    PLACE = 0  # m
    VELOCITY = 3  # m/s
    SHEAR = 6  # of the ground under the shoe, along the road and to the left, m
    SIZE = 8


class NodeWorkOffset(IntEnum):
    """Quantities of a node's working room, hull axes but for GROUND."""

    NEAR = 0  # place from the hull's origin, m
    SPEED = 3  # velocity, not relative to the hull, m/s
    CONTACT = 6  # force of wheels and teeth on the node, N
    GROUND = 9  # force of the ground, global axes, N
    DIRECTION = 12  # of link i, unit vector
    TURNING = 15  # angular velocity of link i, rad/s
    TENSION = 18  # of link i, N
    SHORTNESS = 19  # 1 / length of link i, 1/m
    PIN_MOMENT = 20  # of link i on link i - 1, N m
    LINK_FORCE = 23  # of link i on node i, N
    SAMPLE = 26  # number of the road's sample behind the node
    LOW = 27  # its height, m
    RISE = 28  # from it to the next, m
    ALONG = 29  # distance along the path, m
    TANGENT = 30  # of the path, x and y, global axes
    CLOSENESS = 32  # by which the road under the node is shorter than its distances say
    PART = 33  # of the way from the road's sample to the next
    SIZE = 34


class Chain(NamedTuple):
    """Both tracks, left first."""

    links: np.ndarray  # (2,)
    hull: int  # row in the tree
    shoe_mass: float  # kg
    stiffness: float  # N/m of one link
    damping: float  # N s/m
    free_length: np.ndarray  # (2,) m of a link without tension
    pin_stiffness: float  # N m/rad about the pin
    sideways_stiffness: float  # N m/rad about the other axes
    pin_damping: float  # N m s/rad


def build_chain(vehicle, rows):
    """Return the record for the vehicle."""
    t = vehicle.tracks
    return Chain(
        links=np.array(t.links, dtype=np.int64),
        hull=rows["hull"],
        shoe_mass=t.shoe_mass,
        stiffness=t.link_stiffness,
        damping=t.link_damping,
        free_length=t.pitch - np.array(t.pretension) / t.link_stiffness,
        pin_stiffness=t.pin_stiffness,
        sideways_stiffness=t.sideways_stiffness,
        pin_damping=t.pin_damping,
    )


def new_nodes():
    """Return the state of both tracks, (2, NODE_STATE STRIDE)."""
    return new_cells(2, NodeOffset.SIZE * STRIDE, first=1)


def new_node_work(tracks=2):
    """Return room for the intermediate results of so many tracks, (tracks, NODE_WORK STRIDE)."""
    return new_cells(tracks, NodeWorkOffset.SIZE * STRIDE, first=1)


@inlined
def close_chain(cells, first, count, n):
    """Repeat the ends of `count` quantities from `first` on in the cells before and behind."""
    for q in range(first, first + count):
        cells[q * STRIDE] = cells[q * STRIDE + n]
        cells[q * STRIDE + n + 1] = cells[q * STRIDE + 1]


@inlined
def see_from_hull(chain, n, nodes, motion, work):
    """Express places and velocities of a track's n nodes in hull axes, and clear the forces on them."""
    r = rotation(motion, chain.hull)
    o = motion_vector(motion, MotionOffset.ORIGIN, chain.hull)
    for i in range(1, n + 1):
        x, y, z = nodes[i] - o[0], nodes[STRIDE + i] - o[1], nodes[2 * STRIDE + i] - o[2]
        work[i] = r[0] * x + r[3] * y + r[6] * z
        work[STRIDE + i] = r[1] * x + r[4] * y + r[7] * z
        work[2 * STRIDE + i] = r[2] * x + r[5] * y + r[8] * z
        x, y, z = nodes[3 * STRIDE + i], nodes[4 * STRIDE + i], nodes[5 * STRIDE + i]
        work[3 * STRIDE + i] = r[0] * x + r[3] * y + r[6] * z
        work[4 * STRIDE + i] = r[1] * x + r[4] * y + r[7] * z
        work[5 * STRIDE + i] = r[2] * x + r[5] * y + r[8] * z
        for q in range(NodeWorkOffset.CONTACT, NodeWorkOffset.GROUND + 3):
            work[q * STRIDE + i] = 0.0
    close_chain(work, NodeWorkOffset.NEAR, 6, n)


@inlined
def add_links(chain, side, work):
    """Fill the forces of a side's links and pins; returns the power that becomes heat [W] and what they store [J].

    A link is a spring and damper along itself. A pin resists the turning of one link against the next by
    stiffness (that of its rubber about its own axis, that of the band of shoes about the others) and damping; the
    moments reach the nodes as couples, so that forces and, but for twist, moments are in balance.
    """
    n, free_length = chain.links[side], chain.free_length[side]
    dissipation, stored = 0.0, 0.0
    for i in range(1, n + 1):
        x = work[i + 1] - work[i]
        y = work[STRIDE + i + 1] - work[STRIDE + i]
        z = work[2 * STRIDE + i + 1] - work[2 * STRIDE + i]
        vx = work[3 * STRIDE + i + 1] - work[3 * STRIDE + i]
        vy = work[4 * STRIDE + i + 1] - work[4 * STRIDE + i]
        vz = work[5 * STRIDE + i + 1] - work[5 * STRIDE + i]
        square = x * x + y * y + z * z
        length = np.sqrt(square)
        short = 1.0 / length
        x, y, z = x * short, y * short, z * short
        rate = x * vx + y * vy + z * vz
        stretch = length - free_length
        work[NodeWorkOffset.DIRECTION * STRIDE + i] = x
        work[(NodeWorkOffset.DIRECTION + 1) * STRIDE + i] = y
        work[(NodeWorkOffset.DIRECTION + 2) * STRIDE + i] = z
        work[NodeWorkOffset.TURNING * STRIDE + i] = (y * vz - z * vy) * short
        work[(NodeWorkOffset.TURNING + 1) * STRIDE + i] = (z * vx - x * vz) * short
        work[(NodeWorkOffset.TURNING + 2) * STRIDE + i] = (x * vy - y * vx) * short
        work[NodeWorkOffset.TENSION * STRIDE + i] = chain.stiffness * stretch + chain.damping * rate
        work[NodeWorkOffset.SHORTNESS * STRIDE + i] = short
        dissipation += chain.damping * rate * rate
        stored += 0.5 * chain.stiffness * stretch * stretch
    close_chain(work, NodeWorkOffset.DIRECTION, 6, n)
    for i in range(1, n + 1):
        ax, ay, az = (
            work[NodeWorkOffset.DIRECTION * STRIDE + i - 1],
            work[(NodeWorkOffset.DIRECTION + 1) * STRIDE + i - 1],
            work[(NodeWorkOffset.DIRECTION + 2) * STRIDE + i - 1],
        )
        bx, by, bz = (
            work[NodeWorkOffset.DIRECTION * STRIDE + i],
            work[(NodeWorkOffset.DIRECTION + 1) * STRIDE + i],
            work[(NodeWorkOffset.DIRECTION + 2) * STRIDE + i],
        )
        tx, ty, tz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        wx = work[NodeWorkOffset.TURNING * STRIDE + i] - work[NodeWorkOffset.TURNING * STRIDE + i - 1]
        wy = work[(NodeWorkOffset.TURNING + 1) * STRIDE + i] - work[(NodeWorkOffset.TURNING + 1) * STRIDE + i - 1]
        wz = work[(NodeWorkOffset.TURNING + 2) * STRIDE + i] - work[(NodeWorkOffset.TURNING + 2) * STRIDE + i - 1]
        # pins lie along the hull's y axis
        work[NodeWorkOffset.PIN_MOMENT * STRIDE + i] = chain.sideways_stiffness * tx + chain.pin_damping * wx
        work[(NodeWorkOffset.PIN_MOMENT + 1) * STRIDE + i] = chain.pin_stiffness * ty + chain.pin_damping * wy
        work[(NodeWorkOffset.PIN_MOMENT + 2) * STRIDE + i] = chain.sideways_stiffness * tz + chain.pin_damping * wz
        dissipation += chain.pin_damping * (wx * wx + wy * wy + wz * wz)
        stored += 0.5 * (chain.sideways_stiffness * (tx * tx + tz * tz) + chain.pin_stiffness * ty * ty)
    close_chain(work, NodeWorkOffset.PIN_MOMENT, 3, n)
    for i in range(1, n + 1):
        mx = work[NodeWorkOffset.PIN_MOMENT * STRIDE + i + 1] - work[NodeWorkOffset.PIN_MOMENT * STRIDE + i]
        my = work[(NodeWorkOffset.PIN_MOMENT + 1) * STRIDE + i + 1] - work[(NodeWorkOffset.PIN_MOMENT + 1) * STRIDE + i]
        mz = work[(NodeWorkOffset.PIN_MOMENT + 2) * STRIDE + i + 1] - work[(NodeWorkOffset.PIN_MOMENT + 2) * STRIDE + i]
        x, y, z = (
            work[NodeWorkOffset.DIRECTION * STRIDE + i],
            work[(NodeWorkOffset.DIRECTION + 1) * STRIDE + i],
            work[(NodeWorkOffset.DIRECTION + 2) * STRIDE + i],
        )
        tension, short = work[NodeWorkOffset.TENSION * STRIDE + i], work[NodeWorkOffset.SHORTNESS * STRIDE + i]
        work[NodeWorkOffset.LINK_FORCE * STRIDE + i] = tension * x - short * (my * z - mz * y)
        work[(NodeWorkOffset.LINK_FORCE + 1) * STRIDE + i] = tension * y - short * (mz * x - mx * z)
        work[(NodeWorkOffset.LINK_FORCE + 2) * STRIDE + i] = tension * z - short * (mx * y - my * x)
    close_chain(work, NodeWorkOffset.LINK_FORCE, 3, n)
    return dissipation, stored


@inlined
def move_nodes(chain, n, nodes, motion, gravity, work, dt):
    """Advance a track of n nodes by dt with symplectic Euler."""
    r = rotation(motion, chain.hull)
    step = dt / chain.shoe_mass
    fall_x, fall_y, fall_z = dt * gravity[0], dt * gravity[1], dt * gravity[2]
    for i in range(1, n + 1):
        behind = i - 1
        x = work[NodeWorkOffset.LINK_FORCE * STRIDE + i] - work[NodeWorkOffset.LINK_FORCE * STRIDE + behind]
        y = work[(NodeWorkOffset.LINK_FORCE + 1) * STRIDE + i] - work[(NodeWorkOffset.LINK_FORCE + 1) * STRIDE + behind]
        z = work[(NodeWorkOffset.LINK_FORCE + 2) * STRIDE + i] - work[(NodeWorkOffset.LINK_FORCE + 2) * STRIDE + behind]
        x += work[NodeWorkOffset.CONTACT * STRIDE + i]
        y += work[(NodeWorkOffset.CONTACT + 1) * STRIDE + i]
        z += work[(NodeWorkOffset.CONTACT + 2) * STRIDE + i]
        forward = r[0] * x + r[1] * y + r[2] * z + work[NodeWorkOffset.GROUND * STRIDE + i]
        left = r[3] * x + r[4] * y + r[5] * z + work[(NodeWorkOffset.GROUND + 1) * STRIDE + i]
        up = r[6] * x + r[7] * y + r[8] * z + work[(NodeWorkOffset.GROUND + 2) * STRIDE + i]
        vx = nodes[NodeOffset.VELOCITY * STRIDE + i] + step * forward + fall_x
        vy = nodes[(NodeOffset.VELOCITY + 1) * STRIDE + i] + step * left + fall_y
        vz = nodes[(NodeOffset.VELOCITY + 2) * STRIDE + i] + step * up + fall_z
        nodes[NodeOffset.VELOCITY * STRIDE + i] = vx
        nodes[(NodeOffset.VELOCITY + 1) * STRIDE + i] = vy
        nodes[(NodeOffset.VELOCITY + 2) * STRIDE + i] = vz
        nodes[i] += dt * vx
        nodes[STRIDE + i] += dt * vy
        nodes[2 * STRIDE + i] += dt * vz
