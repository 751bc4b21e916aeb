"""Finds the records of an MCAP file that hold, also where what says so is damaged.

A record holds if its content is one of its kind to the last byte, and of a chunk if the checksum is right. A chunk
tells its length twice, in its frame and in its head, so one damaged opcode or length costs no chunk.
"""

import struct
from io import SEEK_END
from typing import NamedTuple
from zlib import crc32

import numpy as np
from mcap.opcode import Opcode

from .limits import largest_record, too_large
from .mcap_messages import FRAME, at, find_records
from .mcap_records import DAMAGE, PRIVATE, is_message_index, parse
from .unfolding import COMPRESSIONS, unfold

_FRAME = struct.Struct("<BQ")
_CHUNK = struct.Struct("<QQQII")  # first and last time, size and checksum of the contents, length of a name
_COMPRESSION = 4  # longest name, bytes
_LENGTH = np.dtype("<u8")
_KNOWN = frozenset(map(int, Opcode))
_LOOSE = (Opcode.MESSAGE, Opcode.SCHEMA, Opcode.CHANNEL)  # stand inside chunks, or in a file without chunks outside
_ANCHORS = (Opcode.CHUNK, Opcode.MESSAGE_INDEX, Opcode.METADATA, Opcode.ATTACHMENT, Opcode.DATA_END)
_WINDOW = 1 << 20  # bytes that are searched at once


class ChunkPlace(NamedTuple):
    """Where a chunk stands, and what its head says; with the fields of mcap's `ChunkIndex`."""

    chunk_start_offset: int
    chunk_length: int
    message_start_time: int
    message_end_time: int
    compression: str
    compressed_size: int
    uncompressed_size: int


class Record(NamedTuple):
    """A record that holds."""

    opcode: int
    content: bytes  # of a chunk unfolded
    end: int  # where the next one begins
    chunk: ChunkPlace | None = None
    flaw: str = ""  # what it says wrong of itself, though its content holds


class RecordFinder:
    """Looks for records in an open binary file.

    Attributes
    ----------
    size : int
        Bytes of the file.
    chunked, loose : bool
        Whether chunks have been found, and whether messages outside of chunks have; for the caller to set.
    """

    def __init__(self, stream):
        self._stream = stream
        self.size = stream.seek(0, SEEK_END)
        self.chunked = self.loose = False

    def bytes_at(self, place, size):
        """Return so many bytes from a place on, fewer where the file ends."""
        self._stream.seek(place)
        return self._stream.read(size)

    def record(self, place, strict=False):
        """Return the `Record` at a place; raises one of `DAMAGE` where none holds.

        `strict`: what contradicts itself does not hold, and is not unfolded to see.
        """
        opcode, length = _FRAME.unpack(self.bytes_at(place, FRAME))
        end = place + FRAME + length
        if opcode in _KNOWN and opcode != Opcode.CHUNK and end <= self.size:
            try:
                return self._plain_record(place, opcode, length)
            except DAMAGE as error:
                reason = error
        else:
            reason = ValueError(f"a record with opcode {opcode} that claims {length} bytes")
        try:
            return self._chunk(place, opcode, length, strict)
        except DAMAGE as error:
            if opcode >= PRIVATE and self._plausible(end):
                return Record(opcode, b"", end)
            raise error if opcode == Opcode.CHUNK else reason from None

    def _plain_record(self, place, opcode, length):
        end = place + FRAME + length
        if not self._may_be_read(f"the record at byte {place}", length, end):
            raise ValueError(f"a record that claims {length} bytes")
        content = self.bytes_at(place + FRAME, length)
        parse(opcode, content)
        if opcode in _LOOSE and not self._plausible(end):
            raise ValueError(f"a record of {length} bytes without a valid record after it")
        if opcode == Opcode.MESSAGE and self.chunked and is_message_index(content):
            raise ValueError("an index of messages under another opcode")
        flaw = "the record that ends the data is missing" if opcode == Opcode.FOOTER else ""
        return Record(opcode, content, end, flaw=flaw)

    def _chunk(self, place, opcode, length, strict):
        """Return the `Record` of a chunk: its end is told by its frame and by its head, of which one may be damaged."""
        head = self.bytes_at(place + FRAME, _CHUNK.size + _COMPRESSION + _LENGTH.itemsize)
        first, last, size, checksum, name = _CHUNK.unpack_from(head)
        compression = head[_CHUNK.size : _CHUNK.size + min(name, _COMPRESSION)].decode()
        if name > _COMPRESSION or compression not in COMPRESSIONS:
            raise ValueError(f"a chunk with compression {compression!r}, accepted: {', '.join(COMPRESSIONS)[2:]}")
        (declared,) = struct.unpack_from("<Q", head, _CHUNK.size + name)
        start = place + FRAME + _CHUNK.size + name + _LENGTH.itemsize
        by_head, by_frame = start + declared, place + FRAME + length
        if strict and (opcode != Opcode.CHUNK or by_head != by_frame):
            raise ValueError("a chunk that contradicts itself")
        reason = ValueError("a chunk that claims more bytes than there are")
        for end in sorted({by_head, by_frame}):  # the nearer one first: bytes too many need not show
            what = f"the chunk at byte {place}"
            if not (start <= end <= self.size and self._may_be_read(what, end - start, end)):
                continue
            try:
                contents = unfold(compression, self.bytes_at(start, end - start), size, what)
                if checksum or opcode == Opcode.CHUNK and by_head == by_frame:
                    _require_whole(contents, size, checksum)
                else:
                    raise ValueError("it contradicts itself and has no checksum")
            except DAMAGE as error:
                reason = error
                continue
            sound = opcode == Opcode.CHUNK and end == by_head == by_frame and len(contents) == size
            flaw = "" if sound else "a chunk whose opcode or length is wrong, and whose contents are not"
            where = ChunkPlace(place, end - place, first, last, compression, end - start, size)
            return Record(Opcode.CHUNK, contents, end, where, flaw)
        raise ValueError(f"a chunk that cannot be read: {reason}")

    def _may_be_read(self, what, size, end):
        """Return whether some bytes may be; too many are an error if what stands behind them looks like a record."""
        if size <= largest_record():
            return True
        if self._plausible(end):
            raise too_large(what, size)
        return False

    def _plausible(self, place):
        """Return whether a record may begin at a place, also one that was cut off."""
        frame = self.bytes_at(place, FRAME) if place < self.size else b""
        if len(frame) < FRAME:
            return place <= self.size
        opcode, length = _FRAME.unpack(frame)
        return opcode in _KNOWN and length <= max(self.size - place, largest_record())

    def search(self, place):
        """Return the next place from a given one on at which a record holds beyond doubt; None if there is none."""
        anchors = _ANCHORS + (_LOOSE if self.loose else ())
        while place + FRAME <= self.size:
            window = np.frombuffer(self.bytes_at(place, _WINDOW + FRAME - 1), np.uint8)
            start = np.flatnonzero(np.isin(window[: len(window) - FRAME + 1], anchors))
            start = start[at(window, _LENGTH, start + 1) <= (self.size - place - FRAME - start).astype(np.uint64)]
            for candidate in (place + start).tolist():
                try:
                    self.record(candidate, strict=True)
                except DAMAGE:
                    continue
                return candidate
            place += _WINDOW
        return None

    def is_whole_chunk(self, place):
        """Return whether what stands at a place is a chunk with its end, whatever it holds."""
        opcode, length = _FRAME.unpack(self.bytes_at(place, FRAME).ljust(FRAME, b"\0"))
        return opcode == Opcode.CHUNK and place + FRAME + length <= self.size

    def cut_chunk(self, place):
        """Return the contents of a chunk that lacks its end, as far as they go; of what is none nothing.

        zstd gives whole blocks, of 128 KiB at most.
        """
        data = self.bytes_at(place, largest_record())
        try:
            opcode, _ = _FRAME.unpack_from(data)
            *_, size, _, name = _CHUNK.unpack_from(data, FRAME)
            start = FRAME + _CHUNK.size
            compression, start = data[start : start + name].decode(), start + name + _LENGTH.itemsize
            return unfold(compression, data[start:], size, f"the chunk at byte {place}")
        except (*DAMAGE, KeyError):
            return b""


def _require_whole(contents, size, checksum):
    """Raise ValueError unless a chunk's contents are what they were."""
    if checksum:
        if crc32(contents) != checksum:
            raise ValueError("its checksum is wrong")
    elif not size or len(contents) != size or find_records(np.frombuffer(contents, np.uint8)).end != size:
        raise ValueError(f"it declares {size} bytes of records and holds {len(contents)}")
