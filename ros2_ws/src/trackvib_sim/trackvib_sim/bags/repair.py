"""Completes a bag whose recorder was killed or whose disk was full: index, statistics and `metadata.yaml`."""

import fcntl
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import yaml
from mcap import records
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from .errors import BagError
from .files import bag_files
from .metadata import summary_of, write_metadata
from .recovery import DAMAGE, Recovery, compression_of, is_sound
from .writing import CHUNK, LIBRARY

_TELL = 1000  # records between two calls of `told`


class RepairedFile(NamedTuple):
    """What became of one file of a bag."""

    file: Path
    messages: int  # kept
    unread: int  # bytes at its end that are no whole record
    damaged_chunks: int  # left out, as their checksum is wrong
    original: Path  # the file as it was


class Repair(NamedTuple):
    """What was done to a bag."""

    files: list  # of `RepairedFile`; sound ones are not among them
    metadata: bool  # whether `metadata.yaml` was written


def repair(path, told=lambda done, size: None):
    """Complete a bag folder without losing a whole message; returns a `Repair`.

    What is damaged is written anew beside, and kept under its name with `.damaged` behind; what is sound is not
    touched. `told(done, size)` is called now and then with the bytes that are done of a file.

    Raises
    ------
    BagError
        It is no bag, is being recorded, or cannot be written.
    """
    path = Path(path)
    try:
        files = bag_files(path)
        done = [repaired for file in files if (repaired := _repair_file(file, told)) is not None]
        summaries = {file.name: summary_of(file) for file in files}
        metadata = path / "metadata.yaml"
        fits = _metadata_fits(metadata, summaries)
        if not fits:
            if metadata.exists():
                metadata.rename(_name_of_original(metadata))
            write_metadata(path, summaries)
    except OSError as error:
        raise BagError(f"bag {str(path)!r} cannot be repaired: {error.strerror}") from None
    return Repair(done, not fits)


def _repair_file(file, told):
    part = file.with_name(f"{file.name}.part")
    size = file.stat().st_size
    with file.open("rb") as stream, _alone(stream):
        if stream.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
            raise BagError(f"{str(file)!r} is no MCAP file")
        if is_sound(file):
            return None
        original = _name_of_original(file)
        stream.seek(0)
        compression = CompressionType.NONE if compression_of(stream, size) == "" else CompressionType.ZSTD
        stream.seek(0)
        salvage = Recovery(stream, size)
        try:
            with part.open("wb") as target:
                whole = chain(_announced(file), salvage.records())
                messages = _copy(whole, target, compression, lambda: told(stream.tell(), size))
            try:
                file.rename(original)
                part.replace(file)
            except BaseException:
                if original.exists() and not file.exists():  # in between: a bag must not be left without its file
                    original.rename(file)
                raise
        finally:
            part.unlink(missing_ok=True)
    return RepairedFile(file, messages, salvage.unread, salvage.damaged_chunks, original)


def _name_of_original(file):
    original = file.with_name(f"{file.name}.damaged")
    if original.exists():
        raise BagError(f"{str(original)!r} exists already; nothing is overwritten")
    return original


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


def _announced(file):
    """Return schemas and channels from the index, if it can be read: the chunk that announces them may be damaged."""
    try:
        summary = summary_of(file)
    except (OSError, *DAMAGE):  # OSError: shorter than a footer
        summary = None
    return [] if summary is None else [*summary.schemas.values(), *summary.channels.values()]


def _copy(whole, target, compression, told):
    """Write whole records to a new file, with an index; returns how many messages."""
    writer = Writer(target, chunk_size=CHUNK, compression=compression)
    header, schemas, channels, messages = None, {0: 0}, {}, 0
    for number, record in enumerate(whole):
        if number % _TELL == 0:
            told()
        match record:
            case records.Header():
                header = record
                writer.start(record.profile, record.library)
            # both may come again, in other chunks and behind the data
            case records.Schema() if record.id not in schemas:
                schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
            case records.Channel() if record.id not in channels and record.schema_id in schemas:
                channels[record.id] = writer.register_channel(
                    record.topic, record.message_encoding, schemas[record.schema_id], record.metadata
                )
            case records.Message() if record.channel_id in channels:
                writer.add_message(
                    channels[record.channel_id], record.log_time, record.data, record.publish_time, record.sequence
                )
                messages += 1
            case records.Metadata():
                writer.add_metadata(record.name, record.metadata)
            case records.Attachment():
                writer.add_attachment(record.create_time, record.log_time, record.name, record.media_type, record.data)
    if header is None:
        writer.start("ros2", LIBRARY)
    writer.finish()
    return messages


def _metadata_fits(metadata, summaries):
    """Return whether `metadata.yaml` is there and speaks of these files and their messages."""
    try:
        told = yaml.safe_load(metadata.read_text(encoding="utf-8"))["rosbag2_bagfile_information"]
        messages = sum(summary.statistics.message_count for summary in summaries.values())
        return told["relative_file_paths"] == list(summaries) and told["message_count"] == messages
    except (FileNotFoundError, yaml.YAMLError, KeyError, TypeError, UnicodeDecodeError):
        return False
