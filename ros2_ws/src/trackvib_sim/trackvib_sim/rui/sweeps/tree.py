"""From the table of bodies to the arrays that the compiled sweeps work on: bodies side by side in lanes (`packing`).

A body with branches in several lanes stands alone in its block and fills all of its lanes; what its branches hand on is
summed over them.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from ..state import TreeState, free_bodies
from ..table import check_table
from .cells import new_cells
from .packing import pack

LANES = 8  # doubles in the widest vector register of present processors


class BodyOffset(IntEnum):
    """Where the quantities of a body that never change begin in `Tree.body`, body axes."""

    PLACE = 0  # hinge point on the parent, m
    AXIS = 3  # of the hinge
    MASS = 6  # M, kg
    MASS_MOMENT = 7  # M r_OC, kg m
    INERTIA = 10  # about the origin, kg m^2
    SHARE = 16  # what its lane counts in the sums of the block above
    FOOT_SHARE = 17  # and of the foot
    MOBILE = 18  # 1 where its hinge moves freely, else 0
    SIZE = 19


class ElasticHinges(NamedTuple):
    """The hinges without constraint (m of them), in the parent's axes."""

    parent: np.ndarray  # (m,) row
    child: np.ndarray  # (m,) row
    number: np.ndarray  # (m,) of the child in the table
    place: np.ndarray  # (m, 3) m
    stiffness: np.ndarray  # (m, 6) N/m, N m/rad
    damping: np.ndarray  # (m, 6) N s/m, N m s/rad


class Tree(NamedTuple):
    """System record of the body tree: what never changes. Parents' blocks stand before their children's."""

    lanes: tuple  # 0, 1, ... W - 1
    width: np.ndarray  # (1,) W, where a loop must not know it
    parent: np.ndarray  # (blocks,) block of the parents, lane by lane; -1 for a free body
    foot: np.ndarray  # (blocks,) block of the other parents, where lanes have a second branch; else -1
    free: np.ndarray  # (blocks,) index of a free body in the state, -1 for the others
    kind: np.ndarray  # (blocks,) REVOLUTE or SLIDE
    alone: np.ndarray  # (blocks,) whether one body fills all lanes
    body: np.ndarray  # (blocks, BODY W) constants of the bodies
    elastic: ElasticHinges
    gravity: np.ndarray  # (3,) m/s^2
    row: np.ndarray  # (n,) row of each body of the table
    moves: np.ndarray  # (n,) whether its hinge has a coordinate


def build_tree(bodies, gravity=(0.0, 0.0, -9.81)):
    """Turn a table of bodies into a `Tree`.

    Parameters
    ----------
    bodies : sequence of table.Body
    gravity : sequence of 3 floats
        Global axes, m/s^2.

    Raises
    ------
    ValueError
        The table is not a tree of possible bodies (`table.check_table`).
    """
    check_table(bodies)
    gravity = np.array(gravity, dtype=float)
    if gravity.shape != (3,) or not np.all(np.isfinite(gravity)):
        raise ValueError(f"gravity is {gravity.tolist()}, must be three finite numbers [m/s^2]")
    packed = pack(bodies, LANES)
    # lanes pay, also in memory, where on average at least three bodies share a block; a chain has none to share
    w = LANES if 3 * len(packed) <= len(bodies) else 1
    return _fill(bodies, packed if w == LANES else pack(bodies, 1), w, gravity)


def rest_lanes(tree):
    """Return the state with every coordinate and speed zero, every free body at the origin, in rows."""
    free = np.count_nonzero(tree.parent < 0)
    attitude = np.zeros((free, 4))
    attitude[:, 0] = 1.0
    still = (np.zeros((free, 3)) for _ in range(2))
    return TreeState(np.zeros((free, 3)), attitude, *still, new_rows(tree), new_rows(tree))


def new_rows(tree):
    """Return zeros (rows,), for example for hinge torques."""
    rows = len(tree.parent) * len(tree.lanes)
    return new_cells(1, rows)[0]


def to_lanes(tree, state):
    """Return a state whose hinges stand in rows, from one in the order of the table."""
    lanes = rest_lanes(tree)
    for ours, theirs in zip(lanes[:4], state[:4], strict=True):
        ours[:] = theirs
    rows = tree.row[tree.moves]
    lanes.hinge[rows] = np.asarray(state.hinge)[tree.moves]
    lanes.hinge_rate[rows] = np.asarray(state.hinge_rate)[tree.moves]
    return lanes


def to_table(tree, state):
    """Return a copy of a state with its hinges in the order of the table."""
    return TreeState(*(part.copy() for part in state[:4]), state.hinge[tree.row], state.hinge_rate[tree.row])


def _fill(bodies, blocks, w, gravity):
    n_blocks = len(blocks)
    cells = new_cells(n_blocks, BodyOffset.SIZE * w)
    body = cells.reshape(n_blocks, BodyOffset.SIZE, w)
    # An empty lane holds a ghost: a body of mass 1 that is locked and whose share is 0.
    body[:, [BodyOffset.AXIS, BodyOffset.MASS, BodyOffset.INERTIA, BodyOffset.INERTIA + 1, BodyOffset.INERTIA + 2]] = (
        1.0
    )
    row = np.zeros(len(bodies), dtype=np.int64)
    for at, block in enumerate(blocks):
        for lane in range(w if block.alone else len(block.members)):
            member = block.members[0 if block.alone else lane]
            if member is not None:
                # a body that stands alone has its mass in equal parts in all lanes
                body[at, :, lane] = _constants(bodies[member], 1.0 / w if block.alone else 1.0)
                row[member] = at * w + (0 if block.alone else lane)
                if member in block.second:
                    body[at, [BodyOffset.SHARE, BodyOffset.FOOT_SHARE], lane] = 0.0, 1.0
    names = {each.name: at for each, at in zip(bodies, row, strict=True)}
    return Tree(
        lanes=tuple(range(w)),
        width=np.array([w]),
        parent=np.array([block.parent for block in blocks]),
        foot=np.array([blocks[block.parent].parent if block.second else -1 for block in blocks]),
        # they stand first, in the order of the table
        free=np.array([at if block.parent < 0 else -1 for at, block in enumerate(blocks)]),
        kind=np.array([block.kind for block in blocks]),
        alone=np.array([block.alone for block in blocks]),
        body=cells,
        elastic=_elastic(bodies, names),
        gravity=gravity,
        row=row,
        moves=np.array([body.hinge is not None and body.hinge.kind in ("revolute", "prismatic") for body in bodies]),
    )


def _constants(body, part):
    values = np.zeros(BodyOffset.SIZE)
    c = np.array(body.centre, dtype=float)
    i = np.asarray(body.inertia, dtype=float) + body.mass * (c @ c * np.eye(3) - np.outer(c, c))
    values[BodyOffset.MASS] = part * body.mass
    values[BodyOffset.MASS_MOMENT : BodyOffset.MASS_MOMENT + 3] = part * body.mass * c
    values[BodyOffset.INERTIA : BodyOffset.INERTIA + 6] = part * np.array(
        [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
    )
    values[BodyOffset.SHARE] = part
    hinge = body.hinge
    if hinge is not None:
        values[BodyOffset.PLACE : BodyOffset.PLACE + 3] = hinge.place
        movable = hinge.kind in ("revolute", "prismatic")
        values[BodyOffset.AXIS : BodyOffset.AXIS + 3] = (
            np.array(hinge.axis) / np.linalg.norm(hinge.axis) if movable else (0.0, 0.0, 1.0)
        )
        values[BodyOffset.MOBILE] = float(movable and not hinge.prescribed)
    return values


def _elastic(bodies, rows):
    numbers = [number for number in free_bodies(bodies) if bodies[number].hinge is not None]
    hinges = [(bodies[number].name, bodies[number].hinge) for number in numbers]
    return ElasticHinges(
        np.array([rows[hinge.parent] for _, hinge in hinges], dtype=np.int64),
        np.array([rows[name] for name, _ in hinges], dtype=np.int64),
        np.array(numbers, dtype=np.int64),
        np.array([hinge.place for _, hinge in hinges], dtype=float).reshape(-1, 3),
        np.array([hinge.stiffness for _, hinge in hinges], dtype=float).reshape(-1, 6),
        np.array([hinge.damping for _, hinge in hinges], dtype=float).reshape(-1, 6),
    )
