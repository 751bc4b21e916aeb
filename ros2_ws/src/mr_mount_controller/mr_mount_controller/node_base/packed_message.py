"""Messages in serialised form, for those that travel every period.

rclpy translates every field of a message each time it is published or taken, the covariances and names that never
change or that nobody reads with the numbers that matter. Here only these numbers are written and read, where they
stand in the bytes.
"""

from struct import Struct

import numpy as np
from rclpy.serialization import serialize_message

from .cdr import NANO, Checker, LayoutError, byte_order, find_layout
from .definitions import installed_definition


class PackedMessage:
    """A message with stamps and some fields of numbers, as many of them each time.

    Parameters
    ----------
    message : ROS message
        With everything set that does not change, sequences with as many elements as they shall have.
    fields : dict
        Shape of each changing field, by name: numbers (), vectors (x, y, z), arrays of numbers or of vectors.
    stamps : tuple of str
        Names of the times that say when.
    """

    def __init__(self, message, fields, stamps=("header.stamp",)):
        self._bytes = bytearray(serialize_message(message))
        wanted = {part: shape for stamp in stamps for part, shape in _stamp(stamp).items()}
        layout = find_layout(installed_definition(type(message)), self._bytes, wanted | fields)
        # the serialiser leaves what lies between the fields as it finds it; equal runs need equal bytes
        for gap in layout.padding:
            self._bytes[gap] = bytes(gap.stop - gap.start)
        self._write_stamp = Struct(f"{byte_order(self._bytes)}iI").pack_into
        self._stamps = [layout.numbers.fields[f"{stamp}.sec"][1] for stamp in stamps]
        record = np.frombuffer(self._bytes, layout.numbers)
        self._places = {name: record[name] for name in fields}  # found once, written every period

    def fill(self, stamp, **values):
        """Return the bytes to publish, with a stamp [ns] and the values of all changing fields."""
        seconds, nanoseconds = divmod(stamp, NANO)
        for place in self._stamps:
            self._write_stamp(self._bytes, place, seconds, nanoseconds)
        for name, value in values.items():
            self._places[name][0] = value
        return bytes(self._bytes)


class MessageReader(Checker):
    """Reads a time and some fields of serialised messages of one type.

    It is quick for messages that are called alike, so have one for each topic.

    Parameters
    ----------
    message_type : type
        Of the ROS messages.
    stamp : str
        Name of the time, as "header.stamp".
    fields : dict
        How many numbers each field has, by name, in the order of the message and behind the time.
    """

    def __init__(self, message_type, stamp, fields):
        super().__init__(installed_definition(message_type))
        self._wanted = _stamp(stamp) | {name: (count,) for name, count in fields.items()}

    def read(self, data):
        """Return the time [ns], and the numbers of all fields, one after the other, as a list.

        Raises
        ------
        LayoutError
            The bytes are no message of that type, or the time is none.
        """
        # whoever sends may call the frame as he likes, which shifts everything behind the name
        self.check(data)
        seconds, nanoseconds, *numbers = self._numbers_of(data)
        if seconds < 0 or nanoseconds >= NANO:
            raise LayoutError(
                f"time is {seconds} s and {nanoseconds} ns, accepted: 0 s or more and less than {NANO} ns"
            )
        return seconds * NANO + nanoseconds, numbers

    def _fit(self, message):
        numbers = find_layout(self._kind, message, self._wanted).numbers
        super()._fit(message)
        self._numbers_of = _packing(byte_order(message), numbers).unpack_from


def _stamp(name):
    return {f"{name}.sec": (), f"{name}.nanosec": ()}


def _packing(order, record):
    """Return the `Struct` that reads what a structured dtype of numbers reads."""
    packing, end = order, 0
    for name in record.names:
        field, place = record.fields[name]
        packing += f"{place - end}x{field.itemsize // field.base.itemsize}{field.base.char}"
        end = place + field.itemsize
    return Struct(packing)
