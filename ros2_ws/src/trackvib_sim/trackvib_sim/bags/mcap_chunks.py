"""MCAP files chunk by chunk, and the messages of a chunk as arrays: no Python a message."""

from io import SEEK_CUR, SEEK_END, BytesIO
from struct import Struct
from typing import NamedTuple

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import InvalidMagic
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Metadata, Schema
from mcap.stream_reader import MAGIC_SIZE, get_chunk_data_stream, read_magic

from ..numerics.compiled import kernel
from .recovery import DAMAGE, cut_chunk

_FRAME = Struct("<BQ")  # of every record: what it is, and how many bytes follow
_MESSAGE = np.dtype([("channel", "<u2"), ("sequence", "<u4"), ("log_time", "<u8"), ("publish_time", "<u8")])
_WANTED = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE)  # of what stands outside of chunks
_OUTSIDE = 1 << 20  # bytes of records outside of chunks that are taken together


class Part(NamedTuple):
    """Some of a file's records."""

    data: np.ndarray  # (n,) uint8, records one after the other
    end: int  # how far the file has been read, bytes


class Messages(NamedTuple):
    """The messages of a part."""

    channel: np.ndarray  # (k,) id
    start: np.ndarray  # (k,) where in the part's data the message proper begins
    size: np.ndarray  # (k,) of the message proper, bytes


class PartedFile:
    """An open MCAP file, part by part.

    Attributes
    ----------
    metadata : dict
        The metadata records read so far: name -> dict.
    complete : bool
        Whether the file has its end; known when `parts` is through.
    """

    def __init__(self, file):
        self._file = file
        self.metadata, self.complete = {}, False

    def parts(self):
        """Iterate over the `Part`s that hold schemas, channels and messages, as far as the file goes.

        Raises
        ------
        mcap.exceptions.McapError, ValueError
            It is no MCAP file, or a chunk is damaged.
        """
        if len(self._file.read(MAGIC_SIZE)) < MAGIC_SIZE:
            raise InvalidMagic(b"")
        size = self._file.seek(0, SEEK_END)
        self._file.seek(0)
        read_magic(ReadDataStream(self._file))
        outside = bytearray()
        while len(frame := self._file.read(_FRAME.size)) == _FRAME.size:
            opcode, length = _FRAME.unpack(frame)
            if opcode == Opcode.DATA_END:
                self.complete = True
                break
            cut = length > size - self._file.tell()
            if outside and (cut or opcode == Opcode.CHUNK or len(outside) > _OUTSIDE):
                yield self._part(outside)  # what a chunk holds may be announced before it
                outside = bytearray()
            if cut:
                self._file.seek(-_FRAME.size, SEEK_CUR)
                yield self._part(cut_chunk(self._file))
                break
            if opcode == Opcode.CHUNK:
                yield self._part(self._whole_chunk(self._file.read(length)))
            elif opcode == Opcode.METADATA:
                read = Metadata.read(_stream(self._file.read(length)))
                self.metadata[read.name] = dict(read.metadata)
            elif opcode in _WANTED:
                outside += frame + self._file.read(length)
            else:
                self._file.seek(length, SEEK_CUR)
        if outside:
            yield self._part(outside)

    def _part(self, data):
        return Part(np.frombuffer(data, np.uint8), self._file.tell())

    def _whole_chunk(self, record):
        try:
            stream, size = get_chunk_data_stream(Chunk.read(_stream(record)), validate_crc=True)
            return stream.read(size)
        except DAMAGE as error:
            place = self._file.tell()
            raise ValueError(
                f"the chunk before byte {place} is damaged ({error}); `trackvib bag repair` keeps the others"
            ) from None


def take_apart(data, schemas, channels):
    """Return the `Messages` in a part's data; its schemas and channels are added to the two dicts by their ids."""
    opcode, start, length = (np.empty(len(data) // _FRAME.size, kind) for kind in (np.uint8, np.int64, np.int64))
    count = _frames(data, opcode, start, length)
    opcode, start, length = opcode[:count], start[:count], length[:count]
    for index in np.flatnonzero(opcode != Opcode.MESSAGE):
        record = data[start[index] : start[index] + length[index]].tobytes()
        if opcode[index] == Opcode.SCHEMA:
            schema = Schema.read(_stream(record))
            schemas[schema.id] = schema
        elif opcode[index] == Opcode.CHANNEL:
            channel = Channel.read(_stream(record))
            channels[channel.id] = channel
    found = (opcode == Opcode.MESSAGE) & (length >= _MESSAGE.itemsize)
    start, length = start[found], length[found]
    return Messages(at(data, _MESSAGE, start)["channel"], start + _MESSAGE.itemsize, length - _MESSAGE.itemsize)


def at(data, kind, start):
    """Return items (k,) of a dtype that stand at places (k,) of some bytes, all of them within."""
    # one item at every byte, overlapping
    anywhere = np.ndarray(max(len(data) - kind.itemsize + 1, 0), kind, data, strides=(1,))
    return anywhere[start]


def _stream(record):
    return ReadDataStream(BytesIO(record))


@kernel
def _frames(data, opcode, start, length):
    """Find the complete records in some bytes: what each is, where its content begins, how long it is."""
    place, count = 0, 0
    while place + 9 <= data.size:
        size = np.uint64(0)
        for index in range(8):
            size |= np.uint64(data[place + 1 + index]) << np.uint64(8 * index)
        if size > np.uint64(data.size - place - 9):
            break
        opcode[count], start[count], length[count] = data[place], place + 9, size
        place += 9 + np.int64(size)
        count += 1
    return count
