"""What is in a bag, from the indexes of its files."""

from collections import Counter
from typing import NamedTuple

from mcap.writer import MCAP0_MAGIC

from .errors import BagError
from .files import bag_files
from .limits import TooLarge
from .mcap_summary import summary_of
from .metadata import channels


class Contents(NamedTuple):
    """A bag as its indexes tell it."""

    files: list  # of Path
    size: int  # bytes
    compression: set  # of the chunks, as MCAP names it
    first: int  # time of the first message, ns
    last: int
    types: dict  # topic -> type
    counts: Counter  # topic -> messages
    provenance: list  # names of metadata records
    attachments: list  # names


def contents(path):
    """Return the `Contents` of a bag folder.

    Raises
    ------
    BagError
        It is no bag, was cut short, or cannot be read.
    """
    files = bag_files(path)
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
    )


def _summary(file):
    try:
        summary = summary_of(file)
        if summary is None:
            with file.open("rb") as stream:
                magic = stream.read(len(MCAP0_MAGIC))
    except OSError as error:
        raise BagError(f"{str(file)!r} cannot be read: {error.strerror}") from None
    except TooLarge as error:
        raise BagError(f"{str(file)!r} cannot be read: {error}") from None
    if summary is not None:
        return summary
    if magic != MCAP0_MAGIC:
        raise BagError(f"{str(file)!r} is no MCAP file")
    raise BagError(f"{str(file)!r} was cut short or is damaged; `trackvib bag repair` completes it")
