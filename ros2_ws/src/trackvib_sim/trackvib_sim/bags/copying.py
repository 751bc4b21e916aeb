"""Copies what a bag holds into another one, byte for byte."""

import yaml
from mcap.exceptions import EndOfFile
from mcap.records import Channel, Header, Message, Schema

from .replaying import records
from .writing import BagError


def copy_bag(path, writer, wanted=lambda topic: True):
    """Announce all topics of a bag to a `BagWriter`, copy the messages of the wanted ones, and return all topics.

    A bag that is cut short is copied as far as it goes.

    Raises
    ------
    BagError
        The bag cannot be read, or the type of a message is not installed.
    """
    known = set()
    schemas, topics = {}, {}  # by their numbers
    try:
        for record in records(path):
            if isinstance(record, Header):  # each file of a bag has numbers of its own
                schemas, topics = {}, {}
            elif isinstance(record, Schema):
                schemas[record.id] = record.name
            elif isinstance(record, Channel):
                topics[record.id] = record.topic
                if record.topic not in known:
                    known.add(record.topic)
                    _announce(record, schemas[record.schema_id], writer)
            elif isinstance(record, Message) and wanted(topics[record.channel_id]):
                writer.write(topics[record.channel_id], record.log_time, record.data)
    except EndOfFile:
        pass
    return known


def _announce(channel, type_name, writer):
    qos = yaml.safe_load(channel.metadata.get("offered_qos_profiles", "[]"))
    try:
        writer.add_topic(channel.topic, type_name, qos, channel.metadata.get("topic_type_hash", ""))
    except LookupError:
        raise BagError(f"the type {type_name} of {channel.topic} is not installed here") from None
