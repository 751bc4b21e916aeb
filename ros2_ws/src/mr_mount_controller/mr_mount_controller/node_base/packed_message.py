"""Messages in serialised form, for those that travel every period.

rclpy translates every field of a message each time it is published or taken, the covariances and names that never
change or that nobody reads with the numbers that matter. Here only these numbers are written and read, where they
stand in the bytes (CDR).
"""

from copy import deepcopy
from functools import cache
from struct import Struct

import numpy as np
from rclpy.serialization import serialize_message

from .cdr import NANO

_STAMP = 4  # bytes of the encapsulation before the header's stamp
_NAME = _STAMP + 12  # where the frame's name stands, behind its length
_MARK = 7.2973525693e-3  # in no field of ours by itself, as little as the next
_MARKED_SECOND = 1_987_654_321


class PackedMessage:
    """A message with a header and some fields of a fixed number of floats.

    Parameters
    ----------
    message : ROS message
        With everything set that does not change.
    fields : dict
        How many float64 each changing field has, by name: vectors (x, y, z), arrays of floats or arrays of vectors.
    """

    def __init__(self, message, fields):
        places = {"sec": ("<i4", _STAMP), "nanosec": ("<u4", _STAMP + 4)}
        for name, count in fields.items():
            places[name] = (f"({count},)<f8", _place(message, name))
        self._bytes = bytearray(serialize_message(message))
        # the serialiser leaves what lies between the frame's name and the numbers as it finds it; equal runs need
        # equal bytes
        end = _NAME + len(message.header.frame_id) + 1
        gap = (_STAMP - end) % 8
        self._bytes[end : end + gap] = bytes(gap)
        formats, offsets = zip(*places.values(), strict=True)
        layout = dict(names=list(places), formats=formats, offsets=offsets, itemsize=len(self._bytes))
        self._record = np.frombuffer(self._bytes, np.dtype(layout))[0]

    def fill(self, stamp, **values):
        """Return the bytes to publish, with a stamp [ns] and the values of all changing fields."""
        self._record["sec"], self._record["nanosec"] = divmod(stamp, NANO)
        for name, value in values.items():
            self._record[name] = np.ravel(value)
        return bytes(self._bytes)


class MessageReader:
    """Reads some fields of serialised messages of one type, which has a header and no other field of variable size.

    Parameters
    ----------
    message_type : type
        Of the ROS messages.
    fields : dict
        How each field is packed (`struct`'s format), by name, in the order of the message: "3d" is a vector or an
        array of three floats, "iI" a time or that of the header.
    """

    def __init__(self, message_type, fields):
        self._type, self._fields = message_type, fields
        self._numbers = cache(self._layout)

    def read(self, data):
        """Return the numbers of all fields, one after the other, as a tuple."""
        order = "<" if data[1] & 1 else ">"
        # whoever sends may call the frame as he likes, which shifts everything behind the name
        return self._numbers(order, data[_NAME - 4 : _NAME]).unpack_from(data)

    def _layout(self, order, length):
        message = self._type()
        message.header.frame_id = "_" * (int.from_bytes(length, "little" if order == "<" else "big") - 1)
        layout, end = order, 0
        for name, numbers in self._fields.items():
            place = _place(message, name)
            layout += f"{place - end}x{numbers}"
            end = place + Struct(order + numbers).size
        return Struct(layout)


def _place(message, name):
    """Where in the serialised message the first number of a field stands (of a header: of its stamp)."""
    marked, mark = deepcopy(message), Struct("<d").pack(_MARK)
    field = getattr(marked, name)
    field = getattr(field, "stamp", field)
    if hasattr(field, "sec"):
        field.sec, mark = _MARKED_SECOND, Struct("<i").pack(_MARKED_SECOND)
    elif hasattr(field, "x"):
        field.x = _MARK
    elif hasattr(field[0], "x"):
        field[0].x = _MARK
    else:
        field[0] = _MARK
    return serialize_message(marked).index(mark)
