"""Which body stands in which block and lane: branches of the tree side by side.

Bodies that hang on the same body by hinges of the same kind are independent of each other until their loads meet in
it, so the sweeps treat up to eight of them at once, each in a lane of its own, and what hangs behind a body stays in
its lane. A body with branches in several lanes fills all lanes of its block: it stands *alone*, and is the *foot* of
these branches.
"""

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from ..state import free_bodies


class HingeKind(IntEnum):
    """Kinds of hinges that move."""

    REVOLUTE = 0
    PRISMATIC = 1


@dataclass
class Block:
    """Bodies side by side, by their places in the table; None where a lane is empty. A single one stands alone."""

    members: list
    parent: int  # block of the parents, lane by lane; -1 for a free body
    kind: int  # of the hinges
    second: set = field(default_factory=set)  # members whose parent is the foot instead

    @property
    def alone(self):
        """Whether one body fills all lanes."""
        return len(self.members) == 1


def pack(bodies, w):
    """Return the blocks of a table of bodies for w lanes, parents before children, free bodies first."""
    children, size = _branches(bodies)

    def of_kind(row, kind):
        """Largest branches first, so that those of about the same size come to stand side by side."""
        alike = [] if row is None else [child for child in children[row] if _kind(bodies[child]) == kind]
        return sorted(alike, key=lambda child: (-size[child], child))

    blocks = [Block([row], -1, HingeKind.REVOLUTE) for row in sorted(free_bodies(bodies))]
    for at, block in enumerate(blocks):  # grows while it is gone through
        for kind in (HingeKind.REVOLUTE, HingeKind.PRISMATIC):
            if block.alone:
                branches = of_kind(block.members[0], kind)
                blocks += [Block(branches[k : k + w], at, kind) for k in range(0, len(branches), w)]
            else:
                lanes = [of_kind(row, kind) for row in block.members]
                for k in range(max(map(len, lanes))):
                    blocks.append(Block([lane[k] if k < len(lane) else None for lane in lanes], at, kind))
    return _second_branches(blocks, children, w)


def _branches(bodies):
    """Children of each body, by places in the table, and how many bodies its branch has."""
    rows = {body.name: row for row, body in enumerate(bodies)}
    children = [[] for _ in bodies]
    size = np.ones(len(bodies), dtype=int)
    free = set(free_bodies(bodies))
    for row in range(len(bodies) - 1, 0, -1):
        if row not in free:
            parent = rows[bodies[row].hinge.parent]
            size[parent] += size[row]
            children[parent].append(row)
    return children, size


def _kind(body):
    return HingeKind.PRISMATIC if body.hinge.kind == "prismatic" else HingeKind.REVOLUTE


def _second_branches(blocks, children, w):
    """Move branches of one body from a block that they do not fill to lanes in which another branch has ended.

    The lanes must be of a block whose parents stand on the same foot; for these lanes the foot is the parent.
    """
    behind = {}
    for at, block in enumerate(blocks):
        behind.setdefault(block.parent, []).append(at)
    gone = set()
    for at, block in enumerate(blocks):
        short = len(block.members) < w and not any(children[row] for row in block.members if row is not None)
        if block.parent < 0 or not blocks[block.parent].alone or not short:
            continue
        for host in (blocks[k] for beside in behind[block.parent] for k in behind.get(beside, [])):
            host.members += [None] * (w - len(host.members)) if not host.alone else []
            free = [lane for lane, row in enumerate(host.members) if row is None]
            if host.kind == block.kind and len(free) >= len(block.members):
                for lane, row in zip(free, block.members, strict=False):
                    host.members[lane] = row
                host.second.update(block.members)
                gone.add(at)
                break
    kept = [at for at in range(len(blocks)) if at not in gone]
    place = {at: k for k, at in enumerate(kept)} | {-1: -1}
    for at in kept:
        blocks[at].parent = place[blocks[at].parent]
    return [blocks[at] for at in kept]
