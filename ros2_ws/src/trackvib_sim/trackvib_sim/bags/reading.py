"""Reads a run out of a bag: columns of numbers, an hour of them in a few seconds and bounded memory.

Nothing is done message by message in Python but for the rare topics.
"""

from collections import Counter
from collections.abc import Callable
from os import SEEK_END
from pathlib import Path

import numpy as np
from mcap.records import Channel, Metadata, Schema
from rosbags.serde import SerdeError

from .csv_recording import csv_recording
from .definitions import Definition
from .errors import BagError
from .files import find_files
from .limits import TooLarge
from .mcap_records import DAMAGE
from .mcap_walk import Walk
from .opening import opened
from .raw_messages import NO_SCHEMA
from .recording import Recording
from .sources import Sources, is_csv
from .topic_contents import TopicContents
from .unfolding import unfold_messages

HEADER_TIME, LOG_TIME = TIMES = ("header", "log")  # that may be the time base
# a definition that is damaged or not the one we know gives the others where it is applied
_READ_ERRORS = (
    OSError, TooLarge, *DAMAGE, SerdeError, RuntimeError, LookupError, OverflowError, AssertionError, AttributeError,
    TypeError,
)  # fmt: skip


def read_recording(
    path: str | Path,
    on_progress: Callable[[int, int], None] = lambda done, total: None,
    time: str = HEADER_TIME,
    sources: Sources = Sources(),  # noqa: B008, never changes
) -> Recording:
    """Return the `Recording` of a bag, a folder with MCAP files or one such file, as far as it is readable.

    Topics are found by the ends of their names. Of several with the same end, the one in the sensors' namespace counts.

    Parameters
    ----------
    path : path
    on_progress : callable
        Called from time to time with the number of bytes read and their total number.
    time : str
        Which times are the stamps: "header", those in the messages, or "log", those at which they were recorded.
    sources : Sources
        Which sensors there are and where they are found. A sensor of the two that is not there has no sample that is a
        number; a path that ends in .csv is a file of samples.

    Raises
    ------
    BagError
        The bag cannot be read, holds none of the sensors, or those of several vehicles.

    Examples
    --------
    With `bag` the path of a bag:

    >>> import trackvib_sim as tv
    >>> recording = tv.read_recording(bag)
    >>> recording.chassis.specific_force.shape[1], recording.complete
    (3, True)
    """
    path, reading = Path(path), _Reading(time == LOG_TIME, sources)
    if is_csv(str(path)):
        return csv_recording(path, sources, on_progress)
    found = find_files(path)
    files = found.files
    try:
        total, done = sum(file.stat().st_size for file in files), 0
        for file in files:
            size = file.stat().st_size
            reading.read(file, lambda part, before=done, size=size: on_progress(before + round(part * size), total))
            done += size
        recording = reading.recording(path)
    except BagError:
        raise
    except _READ_ERRORS as error:
        raise BagError(f"bag {str(path)!r} cannot be read: {str(error) or type(error).__name__}") from None
    on_progress(total, total)
    by_log = ("stamps are the times at which messages were recorded",) if time == LOG_TIME else ()
    return recording._replace(notes=(*found.notes, *recording.notes, *by_log))


class _Reading:
    """What has been read of a bag."""

    def __init__(self, by_log, sources):
        self._topics = TopicContents(by_log, sources)
        self._provenance, self._counts, self._complete = {}, Counter(), True

    def read(self, file, on_progress):
        """Read one file; ids of schemas and channels are its own. `on_progress` is called with the part read."""
        schemas, channels, definitions = {}, {}, {}
        with opened(file) as stream:
            whole = stream.seek(0, SEEK_END)  # of a compressed file more than it has on disk
            stream.seek(0)
            walk = Walk(stream)
            for part in walk.parts():
                _require_undamaged(walk)
                for record in part.others:
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        channels[record.id] = record
                    elif isinstance(record, Metadata):
                        self._provenance[record.name] = dict(record.metadata)
                numbers = part.messages.head["channel"]
                for number in np.unique(numbers).tolist():
                    channel = channels.get(number)
                    schema = schemas.get(channel.schema_id) if channel else None
                    if channel is None or (schema is None and channel.schema_id != NO_SCHEMA):
                        raise ValueError(f"messages on channel {number}, which is not declared")
                    of_channel = numbers == number
                    start, size = part.messages.start[of_channel], part.messages.size[of_channel]
                    self._counts[channel.topic] += len(start)
                    if schema and (end := self._topics.end_of(channel.topic, schema, len(start))) is not None:
                        if schema.id not in definitions:
                            definitions[schema.id] = Definition(schema.name, schema.encoding, schema.data)
                        messages = unfold_messages(part.data, start, size)
                        logged = part.messages.head["log_time"][of_channel].astype(np.int64)
                        self._topics.take(channel.topic, schema.name, end, definitions[schema.id], *messages, logged)
                on_progress(part.end / whole)
            _require_undamaged(walk)
            self._complete &= walk.complete

    def recording(self, path):
        """Return it all."""
        whole = {"provenance": self._provenance, "counts": self._counts, "complete": self._complete}
        return self._topics.recording(path, **whole)


def _require_undamaged(walk):
    """Numbers with a hole that nobody sees are worse than none."""
    for damage in walk.damage:
        if damage.size:
            raise ValueError(f"it is damaged at {damage}; `trackvib bag repair` keeps everything else")
