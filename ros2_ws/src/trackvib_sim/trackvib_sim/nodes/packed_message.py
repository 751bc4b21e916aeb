"""Messages kept in serialised form, for those that are published every period.

rclpy translates every field of a message each time it is published, the covariances and names that never change with
the numbers that do. Here that happens once; then only the numbers are written, where they stand in the bytes.
"""

import numpy as np
from rclpy.serialization import serialize_message

from ..simulation.settings import NANO

_STAMP = 4  # bytes of the encapsulation before the header's stamp (CDR)
_MARK = 7.2973525693e-3  # in no field of ours by itself


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
        end = _STAMP + 12 + len(message.header.frame_id) + 1
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


def _place(message, name):
    """Where in the serialised message the first number of a field stands."""
    field = getattr(message, name)
    vector = field if hasattr(field, "x") else field[0] if hasattr(field[0], "x") else None
    if vector is None:
        field[0] = _MARK
    else:
        vector.x = _MARK
    place = serialize_message(message).index(np.array(_MARK, "<f8").tobytes())
    if vector is None:
        field[0] = 0.0
    else:
        vector.x = 0.0
    return place
