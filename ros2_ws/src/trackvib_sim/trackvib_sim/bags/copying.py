"""Copies what a bag holds into another one, byte for byte."""

import yaml
from mcap.records import Attachment

from .raw_messages import RawMessage, raw_records
from .writing import BagError


def copy_bag(path, writer, wanted=lambda topic: True, attached=lambda name: True):
    """Announce all topics of a bag to a `BagWriter`, copy wanted messages and attachments, and return all topics.

    A bag that is cut short is copied as far as it goes.

    Raises
    ------
    BagError
        The bag cannot be read, or the type of a message is not installed.
    """
    known = set()
    for record in raw_records(path):
        if isinstance(record, Attachment) and attached(record.name):
            writer.copy_attachment(record)
        if not isinstance(record, RawMessage):
            continue
        if record.topic not in known:
            known.add(record.topic)
            _announce(record, writer)
        if record.message is not None and wanted(record.topic):
            writer.write(record.topic, record.message.log_time, record.message.data)
    return known


def _announce(record, writer):
    offered = record.channel.metadata
    qos = yaml.safe_load(offered.get("offered_qos_profiles", "[]"))
    try:
        writer.add_topic(record.topic, record.type_name, qos, offered.get("topic_type_hash", ""))
    except LookupError:
        raise BagError(f"the type {record.type_name} of {record.topic} is not installed here") from None
