"""Messages of a bag as bytes, one by one, in the order in which they were recorded."""

from dataclasses import replace
from typing import NamedTuple

from mcap.records import Channel, Message, Schema

from .errors import BagError
from .files import bag_files
from .limits import TooLarge
from .mcap_records import DAMAGE
from .mcap_walk import Walk
from .opening import opened
from .unfolding import unfold_message

NO_SCHEMA = 0  # number with which MCAP marks a channel without a definition, of a JSON log for instance


class RawMessage(NamedTuple):
    """A message, or that a topic is announced."""

    schema: Schema | None  # None where the topic has no definition
    channel: Channel  # with what the publisher offered, in its metadata
    message: Message | None  # None where the topic is announced

    @property
    def topic(self):
        return self.channel.topic

    @property
    def type_name(self):
        """Name of the type, "" where none is told."""
        return self.schema.name if self.schema else ""


def raw_records(path):
    """Yield a `RawMessage` for each message and each announcement of a bag, and mcap's records of everything else.

    Little is held in memory. Compressed messages are unfolded, chunks that are damaged are left out, and a bag that is
    cut short ends where it does.

    Raises
    ------
    BagError
        There is no such bag, a file of it is none of MCAP or cannot be read, or a record is too large.
    """
    for file in bag_files(path):
        try:
            with opened(file) as stream:
                yield from map(_unfolded, walked_records(Walk(stream)))
        except (OSError, TooLarge, *DAMAGE) as error:
            raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None


def _unfolded(record):
    if not isinstance(record, RawMessage) or record.message is None:
        return record
    data = unfold_message(record.message.data)
    return record if data is record.message.data else record._replace(message=replace(record.message, data=data))


def walked_records(walk, schemas=(), channels=()):
    """Yield what `raw_records` does, of one file by its `Walk`.

    Messages that nothing announces get a channel without a definition, called by its number. Schemas and channels
    (mcap's records) are what is known beforehand, from an index: the chunk that announces them may be damaged.
    """
    schemas = {each.id: each for each in schemas}  # each file has numbers of its own
    channels = {each.id: (schemas.get(each.schema_id), each) for each in channels}
    known = [RawMessage(*each, None) for each in channels.values()]
    for part in walk.parts():
        for record in part.others:
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = schemas.get(record.schema_id), record
                yield RawMessage(*channels[record.id], None)
            else:
                yield record
        yield from known
        known = ()
        heads, start, size = part.messages
        for (number, sequence, logged, published), begin, length in zip(
            heads.tolist(), start.tolist(), size.tolist(), strict=True
        ):
            if number not in channels:
                channels[number] = None, Channel(number, f"/unannounced_{number}", "", {}, NO_SCHEMA)
            data = part.data[begin : begin + length].tobytes()
            yield RawMessage(*channels[number], Message(number, logged, data, published, sequence))
