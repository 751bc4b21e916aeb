"""Where the numbers of a serialised message stand: from its definition, and from one message for its variable lengths.

CDR, as ROS 2 speaks it, has no tags: a number's place follows from the definition and from the lengths of the texts and
sequences before it. Messages of one topic mostly agree in these lengths, and then in every place.
"""

from struct import Struct
from typing import NamedTuple

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.base import TypesysError

_ENCAPSULATION = 4  # bytes before the message; places in it are aligned from their end
_ORDERS = {b"\x00\x00": ">", b"\x00\x01": "<"}  # by its first two bytes: plain CDR, big and little end first
_PARSERS = {"ros2msg": get_types_from_msg, "ros2idl": lambda text, _: get_types_from_idl(text)}
_FORMATS = {"bool": "?", "byte": "u1", "char": "u1", "int8": "i1", "uint8": "u1", "float32": "f4", "float64": "f8"} | {
    f"{sign}int{bits}": f"{sign or 'i'}{bits // 8}" for sign in ("", "u") for bits in (16, 32, 64)
}


class LayoutError(ValueError):
    """A message that does not fit its definition, or a definition that cannot be read."""


class Layout(NamedTuple):
    """The places of some fields in all messages that agree in size and lengths."""

    numbers: np.dtype  # structured, one message an item: the fields asked for
    lengths: np.dtype  # structured likewise: first two bytes, and the lengths of all texts and sequences
    values: np.void  # of the lengths

    @property
    def size(self):
        """Bytes of a message."""
        return self.numbers.itemsize


def type_store(type_name, encoding, text):
    """Return rosbags' store of a message type (`package/msg/Type`) and all it is made of.

    Raises
    ------
    LayoutError
        The schema's encoding is unknown, or its text is no definition.
    """
    try:
        parse = _PARSERS[encoding]
    except KeyError:
        raise LayoutError(f"schema of {type_name} is in {encoding!r}, accepted are {', '.join(_PARSERS)}") from None
    store = get_typestore(Stores.EMPTY)
    try:
        store.register(parse(text.decode(), type_name))
    except (TypesysError, ValueError, LookupError) as error:
        raise LayoutError(f"definition of {type_name} cannot be read: {error}") from None
    return store


def find_layout(store, type_name, message, wanted):
    """Return the `Layout` of messages like the given bytes.

    Parameters
    ----------
    store : rosbags.typesys.store.Typestore
    type_name : str
    message : bytes
    wanted : dict
        Shape of each field by its name in the message, as `{"twist.twist.linear": (3,)}`; the numbers in it must follow
        each other without a gap.

    Raises
    ------
    LayoutError
        The message is not of that type, is cut short, or has no such field, or the definition is incomplete.
    """
    order = _ORDERS.get(bytes(message[:2]))
    if order is None:
        raise LayoutError(f"message of {type_name} is not plain CDR")
    walk = _Walk(store, message, order)
    walk.visit((Nodetype.NAME, type_name), "")
    fields = {name: walk.place(name, shape) for name, shape in wanted.items()}
    # stored as they stand, so that equal bytes mean equal lengths whatever the order
    lengths = {"order": (0, "V2"), **{str(place): (place, "V4") for place in walk.lengths}}
    lengths = _record(lengths, len(message))
    return Layout(_record(fields, len(message)), lengths, np.frombuffer(message, lengths)[0])


def _record(fields, size):
    offsets, formats = zip(*fields.values(), strict=True)
    return np.dtype(dict(names=list(fields), offsets=offsets, formats=formats, itemsize=size))


class _Walk:
    """Goes through a message field by field."""

    def __init__(self, store, message, order):
        self._store, self._message, self._order = store, message, order
        self._length = Struct(f"{order}I")
        self._end = _ENCAPSULATION
        self._numbers = {}  # name -> place and format
        self.lengths = []  # their places

    def visit(self, description, name):
        """Step over a field: note its numbers, look up its lengths."""
        node, detail = description
        if node == Nodetype.NAME:
            if detail not in self._store.fielddefs:
                raise LayoutError(f"field {name} is a {detail}, which the definition does not define")
            for field, inner in self._store.fielddefs[detail][1]:
                self.visit(inner, f"{name}.{field}" if name else field)
        elif node == Nodetype.BASE and detail[0] == "string":
            self._step(self._take_length(), 1)
        elif node == Nodetype.BASE:
            if detail[0] not in _FORMATS:
                raise LayoutError(f"field {name} is a {detail[0]}, which has no layout")
            format_ = _FORMATS[detail[0]]
            size = int(format_[1:] or 1)
            self._numbers[name] = (self._step(size, size), self._order + format_)
        else:
            inner, count = detail
            for index in range(count if node == Nodetype.ARRAY else self._take_length()):
                self.visit(inner, f"{name}.{index}")

    def place(self, name, shape):
        """Return place and format of a field."""
        found = [each for path, each in self._numbers.items() if f"{path}.".startswith(f"{name}.")]
        if len(found) != np.prod(shape, dtype=int):
            raise LayoutError(f"field {name} has {len(found)} numbers, must be {np.prod(shape, dtype=int)}")
        first, format_ = found[0]
        size = np.dtype(format_).itemsize
        if found != [(first + index * size, format_) for index in range(len(found))]:
            raise LayoutError(f"the numbers of field {name} are not of one kind, one after the other")
        return first, (format_, shape)

    def _take_length(self):
        place = self._step(4, 4)
        self.lengths.append(place)
        return self._length.unpack_from(self._message, place)[0]

    def _step(self, size, alignment):
        start = _ENCAPSULATION + -(-(self._end - _ENCAPSULATION) // alignment) * alignment
        self._end = start + size
        if self._end > len(self._message):
            raise LayoutError("message is shorter than its definition says")
        return start
