"""Messages of a topic as columns of numbers, gathered without Python a message.

The columns lie in unnamed temporary files that are mapped into memory: the system keeps of them what it has room for,
and they are gone with the arrays.
"""

from tempfile import TemporaryFile
from types import MappingProxyType
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
    first: dict = MappingProxyType({})  # likewise, of which only the first number is kept
    logged: str = ""  # column of the times at which messages were recorded, if there is to be one

    def row(self, numbers):
        """Structured dtype of a message's numbers, given that of its layout."""
        time, *others = self.fields.items()
        shapes = ((column, np.float64, numbers[field].shape) for column, (field, _) in others)
        times = (time[0], self.logged) if self.logged else (time[0],)
        single = ((column, np.float64) for column in self.first)
        return np.dtype([*((name, np.int64) for name in times), *shapes, *single])

    @property
    def wanted(self):
        """Shapes by the names of the fields in the message."""
        time, *others = self.fields.values()
        return {f"{time}.sec": (), f"{time}.nanosec": (), **dict(others), **dict(self.first.values())}


class Topic:
    """The columns of a topic as they grow; messages whose sequences differ in length have columns of their own."""

    def __init__(self, columns, by_log=False):
        self._columns, self._by_log = columns, by_log
        self._files = {}  # by dtype of a row
        self._layout = None

    def add(self, kind, data, start, size, logged):
        """Add messages of a `cdr.Fields` that stand at places of some bytes, and were recorded at times [ns]."""
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
            self._fill(rows, left[fitting], at(data, self._layout.numbers, start[left[fitting]]), logged)
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

    def _fill(self, rows, where, numbers, logged):
        time, *others = self._columns.fields.items()
        seconds, nanoseconds, *_ = self._columns.wanted
        stamp = numbers[seconds].astype(np.int64) * NANO + numbers[nanoseconds]
        rows[time[0]][where] = logged[where] if self._by_log else stamp
        if self._columns.logged:
            rows[self._columns.logged][where] = logged[where]
        for column, (name, _) in others:
            rows[column][where] = numbers[name]
        for column, (name, _) in self._columns.first.items():
            rows[column][where] = numbers[name][:, 0]

    def columns(self, wanted=lambda columns: True):
        """Return the record of columns, mapped into memory: of those that are `wanted`, if any are, the longest."""
        records = [self._mapped(*each) for each in self._files.items()]
        return max(records, key=lambda record: (wanted(record), len(record[0])))

    def _mapped(self, row, file):
        file.flush()
        rows = np.memmap(file, row, "r")
        return self._columns.kind(**{name: rows[name] for name in rows.dtype.names})
