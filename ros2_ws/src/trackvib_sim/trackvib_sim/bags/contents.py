"""What is in a bag, from the indexes of its files, or where these do not tell it from the files themselves."""

from collections import Counter
from typing import NamedTuple

from mcap.exceptions import InvalidMagic
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from .errors import BagError
from .files import find_files
from .limits import TooLarge
from .mcap_summary import full_summary
from .metadata import channels
from .opening import opened


class Contents(NamedTuple):
    """What a bag holds."""

    files: list  # of Path
    size: int  # bytes
    compression: set  # of the chunks, as MCAP names it
    first: int  # time of the first message, ns
    last: int
    types: dict  # topic -> type
    counts: Counter  # topic -> messages
    provenance: list  # names of metadata records
    attachments: list  # names
    notes: tuple  # sentences: which files of the folder were left out


def contents(path):
    """Return the `Contents` of a bag folder.

    Raises
    ------
    BagError
        It is no bag, was cut short, or cannot be read.
    """
    found = find_files(path)
    files = found.files
    summaries = [_summary(file) for file in files]
    types, counts = {}, Counter()
    for summary in summaries:
        for channel, type_name, count in channels(summary):
            types[channel.topic] = type_name
            counts[channel.topic] += count
    filled = [summary.statistics for summary in summaries if summary.statistics.message_count]
    return Contents(
        files=files,
        size=sum(file.stat().st_size for file in files),
        compression={index.compression or "none" for summary in summaries for index in summary.chunk_indexes},
        first=min((each.message_start_time for each in filled), default=0),
        last=max((each.message_end_time for each in filled), default=0),
        types=types,
        counts=counts,
        provenance=[index.name for summary in summaries for index in summary.metadata_indexes],
        attachments=[index.name for summary in summaries for index in summary.attachment_indexes],
        notes=found.notes,
    )


def _summary(file):
    try:
        summary = full_summary(file)
        if summary is None:
            with opened(file) as stream:
                magic = stream.read(len(MCAP0_MAGIC))
    except InvalidMagic:
        raise BagError(f"{str(file)!r} is not an MCAP file") from None
    except (OSError, TooLarge, ZstdError) as error:
        raise BagError(f"{str(file)!r} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if summary is not None:
        return summary
    if magic != MCAP0_MAGIC:
        raise BagError(f"{str(file)!r} is not an MCAP file")
    raise BagError(f"{str(file)!r} was cut short or is damaged; `trackvib bag repair` repairs it")
