"""The one walk over the records of an MCAP file: for columns, copies and repair alike, and past what is damaged."""

import struct
from typing import NamedTuple

import numpy as np
from mcap.exceptions import InvalidMagic
from mcap.opcode import Opcode
from mcap.stream_reader import MAGIC_SIZE
from mcap.writer import MCAP0_MAGIC

from .limits import largest_record, too_large
from .mcap_finder import Record, RecordFinder
from .mcap_messages import Messages, find_records, messages_of
from .mcap_records import DAMAGE, parse

_FRAME = struct.Struct("<BQ")
_KEPT = (Opcode.HEADER, Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE, Opcode.METADATA, Opcode.ATTACHMENT)
_OTHERS = np.zeros(256, bool)  # by opcode, whether it is kept and no message
_OTHERS[[each for each in _KEPT if each != Opcode.MESSAGE]] = True
_ANNOUNCED = (Opcode.SCHEMA, Opcode.CHANNEL)  # may come again and again
_OUTSIDE = 1 << 20  # bytes of records outside of chunks that are taken together


class Part(NamedTuple):
    """Some of a file's records."""

    data: np.ndarray  # (n,) uint8, records one after the other
    messages: Messages  # where they stand in the data
    others: list  # mcap's records of all else, in their order; schemas and channels only once
    end: int  # how far the file has been read, bytes


class Damage(NamedTuple):
    """Bytes that hold no whole record, or a record that says something wrong of itself."""

    place: int  # first byte
    size: int  # bytes that were skipped
    reason: str

    def __str__(self):
        passed = f", {self.size} bytes skipped" if self.size else ""
        return f"byte {self.place}: {self.reason}{passed}"


def has_records(stream):
    """Return whether an open binary file is one of MCAP: it begins like one, or holds a record further on."""
    try:
        Walk(stream).begin()
    except InvalidMagic:
        return False
    return True


class Walk:
    """The records of an open binary file.

    Attributes
    ----------
    complete : bool
        Whether the data have their end; known, as all else here, when `parts` is through.
    unread : int
        Bytes at the end that belong to no whole record.
    damage : list of Damage
        Of what lies before that.
    chunks : list of ChunkPlace
        Those that hold.
    """

    def __init__(self, stream):
        self._finder = RecordFinder(stream)
        self._known, self._known_size = {}, 0  # content of what was announced, by opcode and number
        self.complete, self.unread = False, 0
        self.damage, self.chunks = [], []

    def parts(self):
        """Iterate over the `Part`s of the file, as far as it goes.

        Raises
        ------
        mcap.exceptions.InvalidMagic
            It is not an MCAP file.
        TooLarge
            A record needs more memory than is accepted.
        """
        place, outside = self.begin(), bytearray()
        while place < self._finder.size and not self.complete:
            try:
                record = self._finder.record(place)
            except DAMAGE as error:
                end = self._finder.search(place + 1)
                if end is None and not self._finder.is_whole_chunk(place):
                    break
                record = Record(0, b"", end or self._finder.size, flaw=str(error) or "no whole record")
            if outside and (record.chunk or len(outside) > _OUTSIDE):
                yield self._part(outside, place)  # what a chunk holds may be announced before it
                outside = bytearray()
            if record.flaw:
                self.damage.append(Damage(place, 0 if record.opcode else record.end - place, record.flaw))
            if record.chunk:
                self.chunks.append(record.chunk)
                self._finder.chunked = True
                yield self._part(record.content, record.end)
            elif record.opcode in _KEPT:
                self._finder.loose |= record.opcode == Opcode.MESSAGE
                outside += _FRAME.pack(record.opcode, len(record.content)) + record.content
            place, self.complete = record.end, record.opcode in (Opcode.DATA_END, Opcode.FOOTER)
        if outside:
            yield self._part(outside, place)
        if not self.complete and place < self._finder.size:
            self.unread = self._finder.size - place
            yield self._part(self._finder.cut_chunk(place), self._finder.size)

    def begin(self):
        """Return where the first record stands; raises `InvalidMagic` as `parts` does."""
        magic = self._finder.bytes_at(0, MAGIC_SIZE)
        if magic == MCAP0_MAGIC:
            return MAGIC_SIZE
        place = self._finder.search(0) if len(magic) == MAGIC_SIZE else None
        if place is None:
            raise InvalidMagic(magic)
        self.damage.append(Damage(0, place, "an MCAP file begins with other bytes"))
        return place

    def _part(self, content, end):
        data = np.frombuffer(content, np.uint8)
        records = find_records(data)
        others = []
        for index in np.flatnonzero(_OTHERS[records.opcode]).tolist():
            opcode, start = int(records.opcode[index]), int(records.start[index])
            inside = data[start : start + int(records.length[index])].tobytes()
            if not self._is_new(opcode, inside):
                continue
            try:
                others.append(parse(opcode, inside))
            except DAMAGE as error:
                self.damage.append(Damage(end, len(inside), f"before it a record that cannot be read: {error}"))
        return Part(data, messages_of(data, records), others, end)

    def _is_new(self, opcode, content):
        """Return whether content was not announced before; all announcements together must not be too large."""
        if opcode == Opcode.ATTACHMENT or self._known.get((opcode, content[:2])) == content:
            return opcode == Opcode.ATTACHMENT
        if opcode in _ANNOUNCED:
            self._known[opcode, content[:2]] = content
        self._known_size += len(content)
        if self._known_size > largest_record():
            raise too_large("what all definitions and metadata tell", self._known_size)
        return True
