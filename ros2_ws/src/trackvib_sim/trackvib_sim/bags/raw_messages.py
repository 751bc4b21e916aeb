"""Messages of a bag as bytes, one by one, in the order in which they were recorded."""

from typing import NamedTuple

from mcap.records import Channel, Message, Schema
from mr_mount_controller.node_base.cdr import leading_stamp

from .errors import BagError
from .files import bag_files
from .recovery import DAMAGE, Recovery


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

    Nothing is held in memory. Chunks that are damaged are left out, and a bag that is cut short ends where it does; a
    file that is no MCAP file ends at once.

    Raises
    ------
    BagError
        There is no such bag, or the system cannot read a file of it.
    """
    for file in bag_files(path):
        schemas, channels = {}, {}  # each file has numbers of its own
        try:
            with file.open("rb") as stream:
                for record in Recovery(stream, file.stat().st_size).records():
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        channels[record.id] = schemas.get(record.schema_id), record
                        yield RawMessage(*channels[record.id], None)
                    elif not isinstance(record, Message):
                        yield record
                    elif record.channel_id in channels:
                        yield RawMessage(*channels[record.channel_id], record)
        except (OSError, *DAMAGE) as error:
            raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None


def sample_messages(path, chassis, powertrain):
    """Yield stamp [ns] and both serialised Imu messages of each sample of which a bag holds both topics' message.

    Raises as `raw_records` does.
    """
    waiting = {}  # messages without their partner by topic and stamp
    partner = {chassis: powertrain, powertrain: chassis}
    for record in raw_records(path):
        if not isinstance(record, RawMessage) or record.message is None or record.topic not in partner:
            continue
        data, stamp = record.message.data, leading_stamp(record.message.data)
        other = waiting.pop((partner[record.topic], stamp), None)
        if other is None:
            waiting[record.topic, stamp] = data
        else:
            yield stamp, *((data, other) if record.topic == chassis else (other, data))
