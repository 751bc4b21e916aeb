"""The summary with which an MCAP file ends, its index; and whether a file is all that its summary says."""

import struct
from collections import Counter
from io import SEEK_END
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

import numpy as np
from mcap.opcode import Opcode
from mcap.records import Attachment, AttachmentIndex, Channel, ChunkIndex, Metadata, MetadataIndex, Schema, Statistics
from mcap.summary import Summary
from mcap.writer import MCAP0_MAGIC

from .limits import largest_record, too_large
from .mcap_finder import ChunkPlace
from .mcap_messages import FRAME, find_records
from .mcap_records import DAMAGE, parse
from .mcap_walk import Walk

_FOOTER = struct.Struct("<BQQQI")  # with its frame
_NOT_SUMMED = 4  # bytes at the footer's end that the summary's checksum leaves out: itself
_PARTS = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX,
          Opcode.METADATA_INDEX)  # fmt: skip


def summary_of(file):
    """Return mcap's `Summary` of a file; None where there is none, or a damaged one.

    Raises
    ------
    TooLarge
        It needs more memory than is accepted.
    OSError
        The file cannot be read.
    """
    with Path(file).open("rb") as stream:
        try:
            summary = Summary()
            for record in _records(stream):
                _add(summary, record)
        except DAMAGE:
            return None
    return summary if summary.statistics is not None else None


def _records(stream):
    size = stream.seek(0, SEEK_END)
    footer = size - len(MCAP0_MAGIC) - _FOOTER.size
    if footer < 0:
        raise ValueError("shorter than a footer")
    stream.seek(footer)
    end = stream.read(_FOOTER.size)
    if stream.read() != MCAP0_MAGIC or end[:FRAME] != struct.pack("<BQ", Opcode.FOOTER, _FOOTER.size - FRAME):
        raise ValueError("no footer")
    _, _, start, _, checksum = _FOOTER.unpack(end)
    if not 0 < start <= footer:
        raise ValueError("no summary")
    if footer - start > largest_record():
        raise too_large("its summary", footer - start)
    stream.seek(start)
    content = stream.read(footer - start)
    if checksum and crc32(content + end[:-_NOT_SUMMED]) != checksum:
        raise ValueError("the summary's checksum is wrong")
    found = find_records(np.frombuffer(content, np.uint8))
    if found.end != len(content):
        raise ValueError("the summary is no row of records")
    for index in np.flatnonzero(np.isin(found.opcode, _PARTS)).tolist():
        begin = int(found.start[index])
        yield parse(int(found.opcode[index]), content[begin : begin + int(found.length[index])])


def _add(summary, record):
    match record:
        case Schema():
            summary.schemas[record.id] = record
        case Channel():
            summary.channels[record.id] = record
        case Statistics():
            summary.statistics = record
        case ChunkIndex():
            summary.chunk_indexes.append(record)
        case AttachmentIndex():
            summary.attachment_indexes.append(record)
        case MetadataIndex():
            summary.metadata_indexes.append(record)


class Findings(NamedTuple):
    """What a whole file was found to be."""

    flaw: str  # what is wrong with it, "" if nothing
    chunks: list  # of `ChunkPlace`, those that hold
    channels: list  # mcap's `Channel`s

    @property
    def compressions(self):
        """Names of the chunks' compressions."""
        return {chunk.compression for chunk in self.chunks}


def examine(file, told=lambda done: None):
    """Read a file to its end and return the `Findings`: of every record, every checksum, and the summary.

    `told(done)` is called now and then with the bytes that have been read.

    Raises
    ------
    mcap.exceptions.InvalidMagic, TooLarge, OSError
        It is no MCAP file, a record needs too much memory, or the system cannot read it.
    """
    counts, others = Counter(), []
    with Path(file).open("rb") as stream:
        walk = Walk(stream)
        for part in walk.parts():
            counts.update(dict(zip(*np.unique(part.messages.head["channel"], return_counts=True), strict=True)))
            others += (each if isinstance(each, Channel) else type(each) for each in part.others)
            told(part.end)
    flaw = _flaw(walk, summary_of(file), counts, Counter(each for each in others if isinstance(each, type)))
    return Findings(flaw, walk.chunks, [each for each in others if isinstance(each, Channel)])


def _flaw(walk, summary, counts, others):
    if walk.damage:
        return f"damaged at {walk.damage[0]}"
    if not walk.complete:
        return "cut short"
    if summary is None:
        return "without an index, or with a damaged one"
    chunks = [ChunkPlace(*(getattr(index, name) for name in ChunkPlace._fields)) for index in summary.chunk_indexes]
    statistics = summary.statistics
    # not every writer makes every index
    agrees = (
        sorted(chunks) in ([], walk.chunks)
        and statistics.message_count == counts.total()
        and all(counts[number] == count for number, count in statistics.channel_message_counts.items())
        and counts.keys() <= summary.channels.keys()
        and (others[Metadata], others[Attachment]) == (statistics.metadata_count, statistics.attachment_count)
        and len(summary.metadata_indexes) in (0, statistics.metadata_count)
        and len(summary.attachment_indexes) in (0, statistics.attachment_count)
    )
    return "" if agrees else "with an index that does not say what it holds"
