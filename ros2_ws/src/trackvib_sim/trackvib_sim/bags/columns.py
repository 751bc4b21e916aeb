"""Messages of a topic as columns of numbers, gathered without Python a message.

The columns lie in unnamed temporary files that are mapped into memory: the system keeps of them what it has room for,
and they are gone with the arrays.
"""

from tempfile import TemporaryFile
from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.cdr import find_layout

from ..numerics.units import NANO
from .mcap_messages import at


class Columns(NamedTuple):
    """How a topic becomes a record of columns."""

    type_name: str  # of the messages
    kind: type  # of the record
    fields: dict  # by column: first the name of a time in the message, then names and shapes (-1: any) of numbers

    def row(self, numbers):
        """Structured dtype of a message's numbers, given that of its layout."""
        first, *others = self.fields.items()
        shapes = ((column, np.float64, numbers[field].shape) for column, (field, _) in others)
        return np.dtype([(first[0], np.int64), *shapes])

    @property
    def wanted(self):
        """Shapes by the names of the fields in the message."""
        first, *others = self.fields.values()
        return {f"{first}.sec": (), f"{first}.nanosec": (), **dict(others)}


class Topic:
    """The columns of a topic as they grow; messages whose sequences differ in length have columns of their own."""

    def __init__(self, columns):
        self._columns = columns
        self._files = {}  # by dtype of a row
        self._layout = None

    def add(self, kind, data, start, size):
        """Add messages of a `cdr.Fields` that stand at places of some bytes."""
        found = {}  # by dtype of a row, the messages and their rows
        left = np.arange(len(start))
        # one turn for messages whose frame is called alike, which is nearly always all of them
        while len(left):
            fitting = self._fitting(data, start[left], size[left])
            if not fitting.any():
                first = start[left[0]]
                message = data[first : first + size[left[0]]].tobytes()
                self._layout = find_layout(kind, message, self._columns.wanted)
                continue
            row = self._columns.row(self._layout.numbers)
            where, rows = found.setdefault(row, (np.zeros(len(start), bool), np.empty(len(start), row)))
            where[left[fitting]] = True
            self._fill(rows, left[fitting], at(data, self._layout.numbers, start[left[fitting]]))
            left = left[~fitting]
        for row, (where, rows) in found.items():
            if row not in self._files:
                self._files[row] = TemporaryFile()  # noqa: SIM115, lives as long as the arrays
            self._files[row].write((rows if where.all() else rows[where]).data)

    def _fitting(self, data, start, size):
        if self._layout is None:
            return np.zeros(len(start), bool)
        fitting = size == self._layout.size
        lengths = at(data, self._layout.lengths, start[fitting])
        fitting[fitting] = lengths == self._layout.values
        return fitting

    def _fill(self, rows, where, numbers):
        seconds, nanoseconds, *names = self._columns.wanted
        stamp, *columns = rows.dtype.names
        rows[stamp][where] = numbers[seconds].astype(np.int64) * NANO + numbers[nanoseconds]
        for column, name in zip(columns, names, strict=True):
            rows[column][where] = numbers[name]

    def columns(self, wanted=lambda columns: True):
        """Return the record of columns, mapped into memory: of those that are `wanted`, if any are, the longest."""
        records = [self._mapped(*each) for each in self._files.items()]
        return max(records, key=lambda record: (wanted(record), len(record[0])))

    def _mapped(self, row, file):
        file.flush()
        rows = np.memmap(file, row, "r")
        return self._columns.kind(*(rows[name] for name in rows.dtype.names))
