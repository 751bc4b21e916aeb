"""The messages among the records of an MCAP file as arrays: no Python a message."""

from typing import NamedTuple

import numpy as np
from mcap.opcode import Opcode

from ..numerics.compiled import kernel

FRAME = 9  # bytes before each record: one that says what it is, eight with the number of bytes that follow
HEAD = np.dtype([("channel", "<u2"), ("sequence", "<u4"), ("log_time", "<u8"), ("publish_time", "<u8")])


class Messages(NamedTuple):
    """The messages among some bytes."""

    head: np.ndarray  # (k,) of `HEAD`
    start: np.ndarray  # (k,) where in the bytes the message proper begins
    size: np.ndarray  # (k,) of the message proper, bytes


class Records(NamedTuple):
    """The whole records in some bytes, one after the other."""

    opcode: np.ndarray  # (n,) what each is
    start: np.ndarray  # (n,) where its content begins
    length: np.ndarray  # (n,) of its content, bytes
    end: int  # where the last one ends


def find_records(data):
    """Return the `Records` in some bytes (n,) uint8, as far as they are whole."""
    arrays = tuple(np.empty(len(data) // FRAME, kind) for kind in (np.uint8, np.int64, np.int64))
    count, end = _find(data, *arrays)
    return Records(*(each[:count] for each in arrays), end)


def messages_of(data, records):
    """Return the `Messages` among the records of some bytes (n,) uint8."""
    found = (records.opcode == Opcode.MESSAGE) & (records.length >= HEAD.itemsize)
    start, length = records.start[found], records.length[found]
    return Messages(at(data, HEAD, start), start + HEAD.itemsize, length - HEAD.itemsize)


def at(data, kind, start):
    """Return items (k,) of a dtype that stand at places (k,) of some bytes, all of them within."""
    # one item at every byte, overlapping
    anywhere = np.ndarray(max(len(data) - kind.itemsize + 1, 0), kind, data, strides=(1,))
    return anywhere[start]


@kernel
def _find(data, opcode, start, length):
    """Find the whole records in some bytes: what each is, where its content begins, how long it is."""
    place, count = 0, 0
    while place + 9 <= data.size:
        size = np.uint64(0)
        for index in range(8):
            size |= np.uint64(data[place + 1 + index]) << np.uint64(8 * index)
        if size > np.uint64(data.size - place - 9):
            break
        opcode[count], start[count], length[count] = data[place], place + 9, size
        place += 9 + np.int64(size)
        count += 1
    return count, place
