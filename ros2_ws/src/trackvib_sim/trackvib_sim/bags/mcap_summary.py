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
from .opening import opened
from .raw_messages import NO_SCHEMA
from .unfolding import are_compressed

_FOOTER = struct.Struct("<BQQQI")  # with its frame
_NOT_SUMMED = 4  # bytes at the footer's end that the summary's checksum leaves out: itself
_PARTS = (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.STATISTICS, Opcode.CHUNK_INDEX, Opcode.ATTACHMENT_INDEX,
          Opcode.METADATA_INDEX)  # fmt: skip


def summary_of(file):
    """Return mcap's `Summary` of a file, empty where it has none, as it may; None where it is damaged or cut off.

    Raises
    ------
    TooLarge
        It needs more memory than is accepted.
    OSError
        The file cannot be read.
    """
    summary = Summary()
    try:
        with opened(Path(file)) as stream:
            for record in _records(stream):
                _add(summary, record)
    except DAMAGE:
        return None
    return summary


def full_summary(file):
    """Return a `Summary` that tells all that it may tell, by reading the file where its own does not; None if damaged.

    Raises as `examine` does.
    """
    summary = summary_of(file)
    if summary is None or _tells_all(summary):
        return summary
    findings = examine(file)
    return None if findings.flaw else findings.summary


def _tells_all(summary):
    """Return whether a summary announces what its statistics count; a writer may leave out any part of it."""
    statistics = summary.statistics
    return (
        statistics is not None
        and sum(statistics.channel_message_counts.values()) == statistics.message_count
        and statistics.channel_message_counts.keys() <= summary.channels.keys()
        and {channel.schema_id for channel in summary.channels.values()} <= summary.schemas.keys() | {NO_SCHEMA}
        and len(summary.chunk_indexes) == statistics.chunk_count
        and len(summary.metadata_indexes) == statistics.metadata_count
        and len(summary.attachment_indexes) == statistics.attachment_count
    )


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
    if start == 0:
        return
    if start > footer:
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
    summary: Summary  # as it should be; of its chunks the `ChunkPlace`s of those that hold
    compressed: bool  # whether its messages are, each for itself

    @property
    def compressions(self):
        """Names of the chunks' compressions."""
        return {chunk.compression for chunk in self.summary.chunk_indexes}


def examine(file, told=lambda done: None):
    """Read a file to its end and return the `Findings`: of every record, every checksum, and the summary.

    `told(done)` is called now and then with the bytes that have been read.

    Raises
    ------
    mcap.exceptions.InvalidMagic, TooLarge, OSError
        It is not an MCAP file, a record needs too much memory, or the system cannot read it.
    """
    summary, counts, times, compressed = Summary(), Counter(), [], False
    with opened(Path(file)) as stream:
        walk = Walk(stream)
        for part in walk.parts():
            head = part.messages.head
            counts.update(
                dict(zip(*map(np.ndarray.tolist, np.unique(head["channel"], return_counts=True)), strict=True))
            )
            if len(head):
                times += [int(head["log_time"].min()), int(head["log_time"].max())]
                compressed |= are_compressed(part.data, part.messages.start, part.messages.size)
            for record in part.others:
                _add(summary, _indexed(record))
            told(part.end)
    summary.chunk_indexes = walk.chunks
    summary.statistics = Statistics(
        attachment_count=len(summary.attachment_indexes),
        channel_count=len(summary.channels),
        channel_message_counts=dict(counts),
        chunk_count=len(walk.chunks),
        message_count=counts.total(),
        message_end_time=max(times, default=0),
        message_start_time=min(times, default=0),
        metadata_count=len(summary.metadata_indexes),
        schema_count=len(summary.schemas),
    )
    return Findings(_flaw(walk, summary_of(file), summary), summary, compressed)


def _indexed(record):
    """Return the entry of an index for a record that has one; where it stands is not told."""
    match record:
        case Metadata():
            return MetadataIndex(0, 0, record.name)
        case Attachment():
            return AttachmentIndex(
                0, 0, record.log_time, record.create_time, len(record.data), record.name, record.media_type
            )
    return record


def _flaw(walk, told, found):
    if walk.damage:
        return f"damaged at {walk.damage[0]}"
    if not walk.complete:
        return "cut short"
    if told is None:
        return "without an index, or with a damaged one"
    chunks = [ChunkPlace(*(getattr(index, name) for name in ChunkPlace._fields)) for index in told.chunk_indexes]
    # not every writer makes every part of it
    agrees = (
        sorted(chunks) in ([], walk.chunks)
        and (told.statistics is None or _agree(told.statistics, found.statistics))
        and (not told.channels or found.statistics.channel_message_counts.keys() <= told.channels.keys())
        and len(told.metadata_indexes) in (0, len(found.metadata_indexes))
        and len(told.attachment_indexes) in (0, len(found.attachment_indexes))
    )
    return "" if agrees else "with an index that does not match its contents"


def _agree(told, found):
    counts = found.channel_message_counts
    return (
        all(counts.get(number, 0) == count for number, count in told.channel_message_counts.items())
        and told.message_count == found.message_count
        and (told.metadata_count, told.attachment_count) == (found.metadata_count, found.attachment_count)
    )
