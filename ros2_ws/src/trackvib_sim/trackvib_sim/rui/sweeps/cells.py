"""How numbers of bodies lie in memory: in blocks of lanes, so that one vector instruction serves several bodies.

A block holds W bodies side by side. Quantity k of lane i stands in cell k W + i of the block's row, so that a loop
over the lanes of one quantity runs over neighbours. A body's *row* is block * W + lane. W is the length of the tuple
`lanes` that every record carries: as part of the type it is known to the compiler. Loops over lanes, in contrast, run
to a number that it does not know, because it does not vectorise loops that it knows to be short.
"""

import numpy as np

from ...numerics.compiled import inlined

CACHE_LINE = 64  # bytes; a vector that straddles two lines takes twice as long to load and to store


def new_cells(blocks, width, first=0):
    """Return zeros of shape (blocks, width); cell `first` of block 0 is where a cache line begins."""
    raw = np.zeros(blocks * width + CACHE_LINE // 8)
    ahead = (-raw.ctypes.data - 8 * first) % CACHE_LINE // 8
    return raw[ahead : ahead + blocks * width].reshape(blocks, width)


def copy_cells(record):
    """Return a deep copy of a record (named tuple) of arrays, each of which lies on the cache lines as it did."""
    if not isinstance(record, np.ndarray):
        return type(record)(*map(copy_cells, record)) if isinstance(record, tuple) else record
    raw = np.empty(record.nbytes + CACHE_LINE, np.uint8)
    ahead = (record.ctypes.data - raw.ctypes.data) % CACHE_LINE
    copy = raw[ahead : ahead + record.nbytes].view(record.dtype).reshape(record.shape)
    copy[...] = record
    return copy


@inlined
def get3(c, k, w, i):
    """Return the vector that begins at quantity k of lane i."""
    return (c[k * w + i], c[(k + 1) * w + i], c[(k + 2) * w + i])


@inlined
def get6(c, k, w, i):
    """Return six quantities from k on of lane i: a symmetric matrix."""
    a, b = get3(c, k, w, i), get3(c, k + 3, w, i)
    return (a[0], a[1], a[2], b[0], b[1], b[2])


@inlined
def get9(c, k, w, i):
    """Return nine quantities from k on of lane i: a matrix."""
    a, b, d = get3(c, k, w, i), get3(c, k + 3, w, i), get3(c, k + 6, w, i)
    return (a[0], a[1], a[2], b[0], b[1], b[2], d[0], d[1], d[2])


@inlined
def put3(c, k, w, i, a):
    """Write a vector."""
    c[k * w + i] = a[0]
    c[(k + 1) * w + i] = a[1]
    c[(k + 2) * w + i] = a[2]


@inlined
def pick3(first, a, b, out, k, w, i):
    """Copy a vector from block a, or else from block b, to block `out`."""
    x, y = get3(a, k, w, i), get3(b, k, w, i)
    put3(out, k, w, i, (x[0] if first else y[0], x[1] if first else y[1], x[2] if first else y[2]))


@inlined
def put6(c, k, w, i, a):
    """Write a symmetric matrix."""
    put3(c, k, w, i, (a[0], a[1], a[2]))
    put3(c, k + 3, w, i, (a[3], a[4], a[5]))


@inlined
def put9(c, k, w, i, a):
    """Write a matrix."""
    put3(c, k, w, i, (a[0], a[1], a[2]))
    put3(c, k + 3, w, i, (a[3], a[4], a[5]))
    put3(c, k + 6, w, i, (a[6], a[7], a[8]))


@inlined
def add3(c, k, w, i, factor, a):
    """Add factor times a vector."""
    c[k * w + i] += factor * a[0]
    c[(k + 1) * w + i] += factor * a[1]
    c[(k + 2) * w + i] += factor * a[2]


@inlined
def add6(c, k, w, i, factor, a):
    """Add factor times a symmetric matrix."""
    add3(c, k, w, i, factor, (a[0], a[1], a[2]))
    add3(c, k + 3, w, i, factor, (a[3], a[4], a[5]))


@inlined
def add9(c, k, w, i, factor, a):
    """Add factor times a matrix."""
    add3(c, k, w, i, factor, (a[0], a[1], a[2]))
    add3(c, k + 3, w, i, factor, (a[3], a[4], a[5]))
    add3(c, k + 6, w, i, factor, (a[6], a[7], a[8]))


@inlined
def sum_lanes(lanes, c, end):
    """Write the sum over its lanes into the first lane of every quantity of a block up to cell `end`."""
    w = len(lanes)
    for first in range(0, end, w):
        total = 0.0
        for i in range(w):
            total += c[first + i]
        c[first] = total


def columns(record, first, count):
    """Return `count` quantities from `first` on of every row of a record: (rows, count), a copy to look at."""
    blocks, w = len(record.cells), len(record.lanes)
    by_lane = record.cells.reshape(blocks, -1, w)[:, first : first + count]
    return by_lane.transpose(0, 2, 1).reshape(blocks * w, count)
