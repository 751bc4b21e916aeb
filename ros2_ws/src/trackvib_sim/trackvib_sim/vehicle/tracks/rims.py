"""Rims on links: the contacts of all wheels of a side, first listed, then evaluated side by side.

The rim's rubber is a radial spring and damper; friction, regularised by a small creep speed, turns the wheel with the
track; guide horns hold the shoes sideways, those that do not yet touch the rim as well. A contact by itself is a chain
of roots and quotients that wait for each other. So each wheel only lists where it touches, and one loop over the list
makes vector instructions of them.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined
from ...numerics.spatial import cross
from ...rui.sweeps.cells import new_cells
from .guides import REACH, hold
from .nodes import STRIDE, NodeWorkOffset

CREEP = 0.25  # m/s, slip at which friction has 71 % of its limit; less is stiff against a shoe in steps of 1e-4 s
# Room for two contacts a link of 24 wheels that reach over 7 links each, and of an idler that half a track wraps. An
# odd number of cache lines, as STRIDE.
ROOM = 872
_VECTOR = 8  # contacts at a time: all are done in whole vectors


class ContactOffset(IntEnum):
    """Quantities of a contact, hull axes; quantity q of contact c stands in cell q ROOM + c."""

    PLACE = 0  # from the hub, m
    SPEED = 3  # against the hub, m/s
    SPIN = 6  # of the wheel about its axle, rad/s
    SHARE = 7  # of the link's length from the node behind to the contact
    WEIGHT = 8
    RADIUS = 9  # of the pin line, m
    STIFFNESS = 10  # N/m
    DAMPING = 11  # N s/m
    FRICTION = 12
    GUIDE_STIFFNESS = 13  # N/m
    GUIDE_DAMPING = 14  # N s/m
    FORCE = 15  # on the link, N
    DISSIPATION = 18  # W
    STORED = 19  # J
    SIZE = 20


class Contacts(NamedTuple):
    """The list of one side's contacts, wheel by wheel."""

    cells: np.ndarray  # (CONTACT ROOM,)
    link: np.ndarray  # (ROOM,) number of the link
    end: np.ndarray  # (c,) number of the contact behind the last one of each wheel


class WheelLoadOffset(IntEnum):
    """What a track does to a wheel, hull axes."""

    FORCE = 0  # N
    MOMENT = 3  # about the hub, N m
    DISSIPATION = 6  # W
    STORED = 7  # energy in the contact, J
    SIZE = 8


def new_contacts(wheels):
    """Return room for the contacts of so many wheels a side."""
    return Contacts(new_cells(1, ContactOffset.SIZE * ROOM)[0], np.zeros(ROOM, int), np.zeros(wheels, int))


@inlined
def list_contact(contacts, c, hub, share, weight, i, j, work):
    """List contact number c: `weight` times that of a rim at a part `share` of the link from node i to node j."""
    cells, rest = contacts.cells, 1.0 - share
    x = rest * work[i] + share * work[j] - hub.x
    z = rest * work[2 * STRIDE + i] + share * work[2 * STRIDE + j] - hub.z
    cells[c] = x
    cells[ROOM + c] = rest * work[STRIDE + i] + share * work[STRIDE + j] - hub.y
    cells[2 * ROOM + c] = z
    cells[3 * ROOM + c] = rest * work[3 * STRIDE + i] + share * work[3 * STRIDE + j] - hub.vx
    vy = rest * work[4 * STRIDE + i] + share * work[4 * STRIDE + j] - hub.vy
    cells[4 * ROOM + c] = vy - hub.yaw * x + hub.roll * z
    cells[5 * ROOM + c] = rest * work[5 * STRIDE + i] + share * work[5 * STRIDE + j] - hub.vz
    cells[ContactOffset.SPIN * ROOM + c] = hub.spin
    cells[ContactOffset.SHARE * ROOM + c] = share
    cells[ContactOffset.WEIGHT * ROOM + c] = weight
    contacts.link[c] = i


@inlined
def close_list(contacts, k, first, end, wheels, side):
    """Let the list of wheel k be that from `first` up to `end`, and give its contacts what is the wheel's own."""
    contacts.end[k] = end
    cells = contacts.cells
    for c in range(first, end):
        cells[ContactOffset.RADIUS * ROOM + c] = wheels.radius[side, k]
        cells[ContactOffset.STIFFNESS * ROOM + c] = wheels.stiffness[side, k]
        cells[ContactOffset.DAMPING * ROOM + c] = wheels.damping[side, k]
        cells[ContactOffset.FRICTION * ROOM + c] = wheels.friction[side, k]
        cells[ContactOffset.GUIDE_STIFFNESS * ROOM + c] = wheels.guide_stiffness[side, k]
        cells[ContactOffset.GUIDE_DAMPING * ROOM + c] = wheels.guide_damping[side, k]


@inlined
def press_contacts(contacts, count):
    """Fill force, heat and energy of the first `count` contacts."""
    cells = contacts.cells
    # up to a whole vector: what stands behind the last contact is not read
    for c in range((count + _VECTOR - 1) // _VECTOR * _VECTOR):
        dx, sideways, dz = cells[c], cells[ROOM + c], cells[2 * ROOM + c]
        vx, vy, vz = cells[3 * ROOM + c], cells[4 * ROOM + c], cells[5 * ROOM + c]
        stiffness, damping = cells[ContactOffset.STIFFNESS * ROOM + c], cells[ContactOffset.DAMPING * ROOM + c]
        weight = cells[ContactOffset.WEIGHT * ROOM + c]
        distance = np.sqrt(dx * dx + dz * dz)
        nx, nz = dx / distance, dz / distance
        depth, leaving = cells[ContactOffset.RADIUS * ROOM + c] - distance, vx * nx + vz * nz
        on = max(weight, 0.0)  # the pin that counts less takes no damping off
        spring = stiffness * max(depth, 0.0)
        normal = max(0.0, spring - on * damping * leaving) if depth > 0.0 else 0.0
        # the rim moves along (nz, -nx) when the wheel rolls forward
        slip = vx * nz - vz * nx - cells[ContactOffset.SPIN * ROOM + c] * distance
        limit = on * cells[ContactOffset.FRICTION * ROOM + c] * normal
        drag = limit * slip / np.sqrt(slip * slip + CREEP * CREEP)
        guide_stiffness = cells[ContactOffset.GUIDE_STIFFNESS * ROOM + c]
        guide_damping = on * cells[ContactOffset.GUIDE_DAMPING * ROOM + c]
        outwards, guide, heat, stored = hold(guide_stiffness, guide_damping, REACH, depth, sideways, vy)
        push = normal + outwards
        cells[ContactOffset.FORCE * ROOM + c] = weight * (push * nx - drag * nz)
        cells[(ContactOffset.FORCE + 1) * ROOM + c] = weight * guide
        cells[(ContactOffset.FORCE + 2) * ROOM + c] = weight * (push * nz + drag * nx)
        cells[ContactOffset.DISSIPATION * ROOM + c] = weight * (leaving * (spring - normal) + drag * slip + heat)
        cells[ContactOffset.STORED * ROOM + c] = weight * (0.5 * spring * depth + stored)


@inlined
def take_contacts(contacts, first, end, n, work, load):
    """Add the forces of contacts from `first` up to `end` to the chain's nodes, and their sums to `load` (LOAD,)."""
    cells = contacts.cells
    for c in range(first, end):
        i, share = contacts.link[c], cells[ContactOffset.SHARE * ROOM + c]
        j = i + 1 if i < n else 1
        force = (
            cells[ContactOffset.FORCE * ROOM + c],
            cells[(ContactOffset.FORCE + 1) * ROOM + c],
            cells[(ContactOffset.FORCE + 2) * ROOM + c],
        )
        for axis in range(3):
            work[(NodeWorkOffset.CONTACT + axis) * STRIDE + i] += (1.0 - share) * force[axis]
            work[(NodeWorkOffset.CONTACT + axis) * STRIDE + j] += share * force[axis]
        add_reaction(load, (cells[c], cells[ROOM + c], cells[2 * ROOM + c]), force)
        load[WheelLoadOffset.DISSIPATION] += cells[ContactOffset.DISSIPATION * ROOM + c]
        load[WheelLoadOffset.STORED] += cells[ContactOffset.STORED * ROOM + c]


@inlined
def add_reaction(load, lever, force):
    """Add to `load` what a force [N] on a node does to the wheel, `lever` [m] being the node's place from the hub."""
    moment = cross(lever, force)
    for axis in range(3):
        load[WheelLoadOffset.FORCE + axis] -= force[axis]
        load[WheelLoadOffset.MOMENT + axis] -= moment[axis]
