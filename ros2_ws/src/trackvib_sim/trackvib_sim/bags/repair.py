"""Completes a bag that was cut short or damaged: index, statistics and `metadata.yaml`, without what is lost."""

import fcntl
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from mcap.exceptions import InvalidMagic
from mcap.records import Attachment, Header, Metadata
from mcap.writer import CompressionType, Writer
from zstandard import ZstdError

from ..new_files import new_file, set_aside
from ..yaml_text import YamlTextError, load, read_text
from .errors import BagError
from .files import find_files, unfolded
from .limits import TooLarge
from .mcap_summary import examine, summary_of
from .mcap_walk import Walk
from .metadata import write_metadata
from .opening import opened
from .raw_messages import NO_SCHEMA, RawMessage, walked_records
from .writing import CHUNK, LIBRARY

NO_MCAP = "empty or no MCAP"  # flaw of a split that is set aside
_TELL = 1000  # records between two calls of `told`


class RepairedFile(NamedTuple):
    """What became of one file of a bag."""

    file: Path
    flaw: str  # why it was written anew
    messages: int  # kept
    lost: int | None  # messages that its index counted and nobody can read; None without an index
    damage: list  # of `Damage`: all that was skipped
    unread: int  # bytes at its end that are no whole record
    original: Path  # the file as it was


class Repair(NamedTuple):
    """What was done to a bag."""

    files: list  # of `RepairedFile`; sound ones are not among them
    metadata: bool  # whether `metadata.yaml` was written


def repair(path, told=lambda done, size: None):
    """Complete a bag folder without losing a whole message; returns a `Repair`.

    A split that is empty or no MCAP is set aside where others are left. What is damaged is written anew beside, and
    kept under its name with `.damaged` behind; what is sound is not touched. `told(done, size)` is called now and then
    with the bytes that are done of a file.

    Raises
    ------
    BagError
        It is no bag, is being recorded, cannot be written, or holds a record that needs more memory than is accepted.
    """
    path = Path(path)
    try:
        files, _, _, unreadable = find_files(path)
        done, found = [RepairedFile(file, NO_MCAP, 0, None, [], 0, set_aside(file)) for file in unreadable], {}
        for file in files:
            repaired, findings = _repair_file(file, told)
            done += [repaired] if repaired else []
            found[(unfolded(file) if repaired else file).name] = findings
        metadata = path / "metadata.yaml"
        fits = _metadata_fits(metadata, found)
        if not fits:
            if metadata.is_symlink() or metadata.exists():
                set_aside(metadata)
            write_metadata(path, {name: each.summary for name, each in found.items()}, _mode(found))
    except FileExistsError as error:
        raise BagError(str(error)) from None
    except OSError as error:
        raise BagError(f"bag {str(path)!r} cannot be repaired: {error.strerror}") from None
    return Repair(done, not fits)


def _repair_file(file, told):
    """Return the `RepairedFile`, or None of a sound one, and the `Findings` of what is there then."""
    size = file.stat().st_size
    with file.open("rb") as stream, _alone(stream):
        try:
            findings = examine(file, lambda done: told(done // 2, size))
            if not findings.flaw:
                return None, findings
            repaired = _written_anew(file, findings, lambda done: told((size + done) // 2, size))
            return repaired, examine(unfolded(file))
        except InvalidMagic:
            raise BagError(f"{str(file)!r} is not an MCAP file") from None
        except (TooLarge, ZstdError) as error:
            raise BagError(f"{str(file)!r} cannot be repaired: {error}") from None


def _written_anew(file, findings, told):
    with opened(file) as stream:
        return _written_from(stream, file, findings, told)


def _written_from(stream, file, findings, told):
    walk, summary = Walk(stream), summary_of(file)
    # what the index announces: the chunk that does may be damaged
    known = () if summary is None else (summary.schemas.values(), summary.channels.values())
    compression = CompressionType.NONE if findings.compressions == {""} else CompressionType.ZSTD
    whole = walked_records(walk, *known)
    aside = file.with_name(f"{file.name}.damaged")
    try:
        with new_file(unfolded(file), before=lambda: set_aside(file)) as target:
            messages = _copy(whole, target, compression, lambda: told(stream.tell()))
    except BaseException:
        if aside.exists() and not file.exists():  # in between: a bag must not be left without its file
            aside.rename(file)
        raise
    counted = summary is not None and summary.statistics is not None
    lost = None if not counted else max(summary.statistics.message_count - messages, 0)
    return RepairedFile(file, findings.flaw, messages, lost, walk.damage, walk.unread, aside)


@contextmanager
def _alone(stream):
    """Refuse a file that its recorder still holds."""
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise BagError(f"{stream.name!r} is being recorded") from None
    except OSError:
        pass  # where files cannot be locked, none is
    yield


def _copy(records, target, compression, told):
    """Write `walked_records` to a new file, with an index; returns how many messages."""
    writer = Writer(target, chunk_size=CHUNK, compression=compression)
    first = next(records, None)
    writer.start(*((first.profile, first.library) if isinstance(first, Header) else ("ros2", LIBRARY)))
    messages, copied = 0, _Copied(writer)
    for number, record in enumerate(chain([first], records)):
        if number % _TELL == 0:
            told()
        match record:
            case RawMessage(schema, channel, message):
                to = copied.channel(schema, channel)
                if message is not None:
                    writer.add_message(to, message.log_time, message.data, message.publish_time, message.sequence)
                    messages += 1
            case Metadata():
                writer.add_metadata(record.name, record.metadata)
            case Attachment():
                writer.add_attachment(record.create_time, record.log_time, record.name, record.media_type, record.data)
    writer.finish()
    return messages


class _Copied:
    """The schemas and channels that a new file has so far."""

    def __init__(self, writer):
        self._writer = writer
        self._schemas, self._channels = {}, {}  # by number in the old file: record there, number in the new file

    def channel(self, schema, channel):
        """Return the number of a channel in the new file, to which it is added if it is not there."""
        old, new = self._channels.get(channel.id, (None, None))
        if old is not channel and old != channel:
            new = self._writer.register_channel(
                channel.topic, channel.message_encoding, self._schema(schema), channel.metadata
            )
            self._channels[channel.id] = channel, new
        return new

    def _schema(self, schema):
        if schema is None:
            return NO_SCHEMA
        old, new = self._schemas.get(schema.id, (None, None))
        if old != schema:
            new = self._writer.register_schema(schema.name, schema.encoding, schema.data)
            self._schemas[schema.id] = schema, new
        return new


def _mode(found):
    """Return how a bag's files are compressed beside their chunks, as rosbag2 calls it."""
    if any(Path(name) != unfolded(Path(name)) for name in found):
        return "FILE"
    return "MESSAGE" if any(each.compressed for each in found.values()) else ""


def _metadata_fits(metadata, found):
    """Return whether `metadata.yaml` is there and speaks of these files and their messages."""
    try:
        told = load(read_text(metadata), metadata.name)["rosbag2_bagfile_information"]
        messages = sum(each.summary.statistics.message_count for each in found.values())
        return bool(told["relative_file_paths"] == list(found) and told["message_count"] == messages)
    except (YamlTextError, KeyError, TypeError, IndexError):
        return False
