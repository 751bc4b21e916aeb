"""Where the numbers of a serialised message stand (CDR, as ROS 2 speaks it)."""

import struct

NANO = 1_000_000_000
_STAMP = {"<": struct.Struct("<iI"), ">": struct.Struct(">iI")}


def leading_stamp(data):
    """Return the time [ns] with which a CDR message starts (one whose first field is a Header or a Time)."""
    order = "<" if data[1] & 1 else ">"
    seconds, nanoseconds = _STAMP[order].unpack_from(data, 4)
    return seconds * NANO + nanoseconds
