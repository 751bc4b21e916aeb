"""Definitions of messages without ROS: what kinds of fields there are, and how many bytes they take at least.

A field is of the kind `Fields` (a message within the message), `Repeated` (an array or a sequence), `TEXT`, or a
number, told by its letter in `struct`, which is numpy's as well.
"""

from struct import calcsize

TEXT = "text"
NUMBERS = {  # by their names in .msg and .idl files
    "bool": "?", "boolean": "?", "byte": "B", "octet": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h",
    "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float": "f",
    "float64": "d", "double": "d",
}  # fmt: skip


class Fields:
    """Kind of a message: its fields, pairs of name and kind.

    Attributes
    ----------
    least : int
        Bytes that it takes at least.
    """

    def __init__(self, fields):
        # a message without fields still takes a byte
        self.fields = tuple(fields) or (("structure_needs_at_least_one_member", "B"),)
        self.least = sum(least_size(kind) for _, kind in self.fields)

    def __eq__(self, other):
        return isinstance(other, Fields) and self.fields == other.fields

    __hash__ = None


class Repeated:
    """Kind of an array of `count` elements, or of a sequence (`count` None), which tells its length itself.

    A sequence has `most` elements at most, where that is given.
    """

    def __init__(self, kind, count=None, most=None):
        self.kind, self.count, self.most = kind, count, most
        self.least = 4 if count is None else count * least_size(kind)

    def __eq__(self, other):
        """Whether elements stand at the same places; how many there may be at most does not tell."""
        return isinstance(other, Repeated) and (self.kind, self.count) == (other.kind, other.count)

    __hash__ = None


def least_size(kind):
    """Return how many bytes a field of a kind takes at least."""
    if kind is TEXT:
        return 4
    return calcsize(f"={kind}") if isinstance(kind, str) else kind.least
