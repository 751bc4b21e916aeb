"""Where the numbers of a serialised message stand: from its definition, and from one message for its variable lengths.

CDR, as ROS 2 speaks it, has no tags: a number's place follows from the definition and from the lengths of the texts and
sequences before it. Messages of one topic mostly agree in these lengths, and then in every place.
"""

from struct import Struct, calcsize
from typing import NamedTuple

import numpy as np

from .field_kinds import TEXT, Fields, least_size

NANO = 1_000_000_000  # ns in a second
_ENCAPSULATION = 4  # bytes before the message; places in it are aligned from their end
_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}  # by its first two bytes: plain CDR, big and little end first
_MOST_LENGTHS = 1000  # that are remembered of a message
_STAMPS = {order: Struct(f"{order}iI") for order in _ORDERS.values()}


class LayoutError(ValueError):
    """A message that does not fit its definition, or a definition that cannot be read."""


class Layout(NamedTuple):
    """The places of some fields in all messages that agree in size and lengths."""

    numbers: np.dtype  # structured, one message an item: the fields asked for
    lengths: np.dtype  # structured likewise: first two bytes, and the lengths of all texts and sequences
    values: np.void  # of the lengths
    padding: list  # slices of bytes that mean nothing

    @property
    def size(self):
        """Bytes of a message."""
        return self.numbers.itemsize


def leading_stamp(message):
    """Return the time [ns] with which a message starts, one whose first field is a header or a time.

    Raises
    ------
    LayoutError
        It is not plain CDR, or shorter than a time.
    """
    stamp = _STAMPS[byte_order(message)]
    if len(message) < _ENCAPSULATION + stamp.size:
        raise LayoutError(f"message of {len(message)} bytes has no stamp")
    seconds, nanoseconds = stamp.unpack_from(message, _ENCAPSULATION)
    return seconds * NANO + nanoseconds


def byte_order(message):
    """Return "<" or ">", as a message's first bytes tell; `LayoutError` if it is not plain CDR."""
    order = _ORDERS.get(bytes(message[:2]))
    if order is None or len(message) < _ENCAPSULATION:
        raise LayoutError(f"message of {len(message)} bytes is not plain CDR")
    return order


def find_layout(kind, message, wanted):
    """Return the `Layout` of messages like the given bytes.

    Parameters
    ----------
    kind : Fields
    message : bytes
    wanted : dict
        Shape of each field by its name in the message, as `{"twist.twist.linear": (3,)}`; the numbers in it must follow
        each other without a gap. A first dimension of -1 is as long as the message has it.

    Raises
    ------
    LayoutError
        The message is not of that kind, is cut short, or has no such field.
    """
    walk = _Walk(message)
    walk.visit(kind, "")
    fields = {name: walk.place(name, shape) for name, shape in wanted.items()}
    # stored as they stand, so that equal bytes mean equal lengths whatever the order
    lengths = {"order": (0, "V2"), **{str(place): (place, "V4") for place in walk.lengths}}
    lengths = _record(lengths, len(message))
    return Layout(_record(fields, len(message)), lengths, np.frombuffer(message, lengths)[0], walk.padding)


def check(kind, message):
    """Make sure that a message is whole: every length in it is borne out by the bytes that are there.

    Raises
    ------
    LayoutError
        It is not.
    """
    _Walk(message).visit(kind, "")


class Checker:
    """Checks messages of one kind as `check` does, quickly where they are like the one before."""

    def __init__(self, kind):
        self._kind = kind
        self._size = -1  # of the message before, bytes

    def check(self, message):
        """Return the message if it is whole; raises `LayoutError` if not."""
        if len(message) != self._size or self._lengths.unpack_from(message) != self._values:
            self._fit(message)
        return message

    def _fit(self, message):
        """Look at a message that is unlike the one before."""
        self._size, walk = -1, _Walk(message)
        walk.visit(self._kind, "")
        if len(walk.lengths) > _MOST_LENGTHS:
            return
        ends = [2, *(place + 4 for place in walk.lengths)]
        gaps = (f"{place - end}x4s" for place, end in zip(walk.lengths, ends, strict=False))
        self._lengths = Struct(f"{walk.order}2s{''.join(gaps)}")
        self._values, self._size = self._lengths.unpack_from(message), len(message)


def _record(fields, size):
    offsets, formats = zip(*fields.values(), strict=True)
    return np.dtype(dict(names=list(fields), offsets=offsets, formats=formats, itemsize=size))


class _Walk:
    """Goes through a message field by field. No length is used before the bytes that are left bear it out."""

    def __init__(self, message):
        self._message, self.order = message, byte_order(message)
        self._length = Struct(f"{self.order}I")
        self._end = _ENCAPSULATION
        self._numbers = []  # name, place, letter and count of numbers of one kind, one after the other
        self.lengths = []  # their places
        self.padding = []

    def visit(self, kind, name):
        """Step over a field: note its numbers, look up its lengths."""
        if kind is TEXT:
            count = self._take_length(name, 1)
            if not count:  # ROS reads it as an empty text, readers of bags do not read it at all
                raise LayoutError(f"field {name} has no length, must count the terminating zero of the text")
            self._step(count, 1, name)
        elif isinstance(kind, str):
            self._take_numbers(name, kind, 1)
        elif isinstance(kind, Fields):
            for field, inner in kind.fields:
                self.visit(inner, f"{name}.{field}" if name else field)
        else:
            count = kind.count
            if count is None:
                count = self._take_length(name, least_size(kind.kind))
                if kind.most is not None and count > kind.most:
                    raise LayoutError(f"field {name} has {count} elements, accepted: at most {kind.most}")
            if isinstance(kind.kind, str) and kind.kind is not TEXT:
                self._take_numbers(name, kind.kind, count)
                return
            self._check_left(count * least_size(kind.kind), name)
            if not count:
                self._numbers.append((name, self._end, "B", 0))
            for index in range(count):
                self.visit(kind.kind, f"{name}.{index}")

    def place(self, name, shape):
        """Return place and format of a field."""
        found = [run for run in self._numbers if f"{run[0]}.".startswith(f"{name}.")]
        if not found:
            raise LayoutError(f"field {name} has no numbers")
        there = sum(count for *_, count in found)
        if -1 in shape:
            shape = (there // int(np.prod(shape[1:], dtype=int)), *shape[1:])
        asked = int(np.prod(shape, dtype=int))
        if there != asked:
            raise LayoutError(f"field {name} has {there} numbers, must be {asked}")
        runs = [run for run in found if run[-1]] or found[:1]  # of nothing it does not matter where it stands
        _, first, letter, _ = runs[0]
        end = first
        for _, place, other, count in runs:
            if (place, other) != (end, letter):
                raise LayoutError(f"the numbers of field {name} are not of one kind, one after the other")
            end += count * calcsize(f"={letter}")
        return first, (f"{self.order}{letter}", shape)

    def _take_numbers(self, name, letter, count):
        size = calcsize(f"={letter}")
        place = self._step(count * size, size, name) if count else self._end  # nothing is aligned for nothing
        self._numbers.append((name, place, letter, count))

    def _take_length(self, name, least):
        place = self._step(4, 4, name)
        self.lengths.append(place)
        count = self._length.unpack_from(self._message, place)[0]
        self._check_left(count * least, name)
        return count

    def _step(self, size, alignment, name):
        before, start = self._end, _ENCAPSULATION + -(-(self._end - _ENCAPSULATION) // alignment) * alignment
        if start > before:
            self.padding.append(slice(before, start))
        self._end = start
        self._check_left(size, name)
        self._end += size
        return start

    def _check_left(self, size, name):
        left = len(self._message) - self._end
        if size > left:
            raise LayoutError(
                f"message is shorter than its definition says: {name} takes {size} bytes, {max(left, 0)} are left"
            )
