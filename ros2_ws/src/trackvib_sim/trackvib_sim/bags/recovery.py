"""Reads what is whole in an MCAP file that was cut short or damaged."""

import struct
from io import BytesIO

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Chunk
from mcap.stream_reader import StreamReader, breakup_chunk, get_chunk_data_stream

from .metadata import summary_of

# what mcap's readers raise at bytes that are no whole record; checksums and text that is none give a ValueError
DAMAGE = (McapError, struct.error, ValueError, zstandard.ZstdError, MemoryError)


class Recovery:
    """The whole records of a file, in its order.

    Parameters
    ----------
    stream : binary file
        Open for reading, at its beginning.
    size : int
        Bytes of the file.

    Attributes
    ----------
    unread : int
        Bytes at the end that belong to no whole record; known when `records` is through.
    damaged_chunks : int
        Chunks left out so far because their checksum is wrong.
    """

    def __init__(self, stream, size):
        self._stream, self._size = stream, size
        self.unread = self.damaged_chunks = 0

    def records(self):
        """Yield mcap's records; of a chunk those in it, also of a last one without its end."""
        end = 0
        for record in _whole(self._stream, self._size, skip_magic=False):
            end = self._stream.tell()
            if not isinstance(record, Chunk):
                yield record
                continue
            try:
                contents = breakup_chunk(record, validate_crc=True)
            except DAMAGE:
                self.damaged_chunks += 1
                continue
            yield from contents
        self._stream.seek(0, 2)
        self.unread = self._stream.tell() - end
        if self.unread:
            self._stream.seek(end)
            contents = cut_chunk(self._stream)
            yield from _whole(BytesIO(contents), len(contents), skip_magic=True)


def is_sound(file):
    """Return whether a file is whole: every record, every chunk's checksum, and the index."""
    try:
        with file.open("rb") as stream:
            size = file.stat().st_size
            for record in StreamReader(stream, emit_chunks=True, validate_crcs=True, record_size_limit=size).records:
                if isinstance(record, Chunk):
                    get_chunk_data_stream(record, validate_crc=True)
        return summary_of(file) is not None
    except DAMAGE:
        return False


def compression_of(stream, size):
    """Return how the first whole chunk of a file is compressed, as MCAP names it; None if there is none."""
    chunks = (record for record in _whole(stream, size, skip_magic=False) if isinstance(record, Chunk))
    return next((chunk.compression for chunk in chunks), None)


def _whole(stream, size, skip_magic):
    records = StreamReader(stream, skip_magic=skip_magic, emit_chunks=True, record_size_limit=size).records
    while True:
        try:
            record = next(records)
        except (StopIteration, *DAMAGE):
            return
        yield record


def cut_chunk(stream):
    """Return the contents of a chunk that begins at the place of a file and lacks its end, as far as they go.

    zstd gives whole blocks, of 128 KiB at most. Of what is no chunk nothing is returned.
    """
    data = ReadDataStream(stream)
    try:
        if data.read1() != Opcode.CHUNK:
            return b""
        data.read8()
        chunk = Chunk.read(data)
        if chunk.compression == "zstd":
            return zstandard.ZstdDecompressor().decompressobj().decompress(chunk.data)
    except DAMAGE:
        return b""
    return chunk.data if chunk.compression == "" else b""
