"""Copies what a bag holds into another one, byte for byte."""

from dataclasses import replace

from mcap.records import Attachment, Schema

from .raw_messages import RawMessage, raw_records
from .schemas import schema_text


def copy_bag(path, writer, wanted=lambda topic: True, attached=lambda name: True):
    """Announce all topics of a bag to a `BagWriter`, copy wanted messages and attachments, and return all topics.

    Definitions are copied as they stand, so that no type need be installed. A bag that is cut short is copied as far as
    it goes.

    Raises
    ------
    BagError
        The bag cannot be read.
    """
    copied = {}  # topic, type and encoding -> channel in the new bag; nothing forbids several types on one topic
    for record in raw_records(path):
        if isinstance(record, Attachment) and attached(record.name):
            writer.copy_attachment(record)
        if not isinstance(record, RawMessage):
            continue
        kind = record.topic, record.type_name, record.channel.message_encoding
        if kind not in copied:
            # what is left out may be written anew, and then with the definitions of here
            schema = record.schema if wanted(record.topic) else _installed(record.schema)
            copied[kind] = writer.copy_topic(schema, _described_by(schema, record))
        if record.message is not None and wanted(record.topic):
            writer.copy_message(copied[kind], record.message)
    return {topic for topic, *_ in copied}


def _described_by(schema, record):
    """Return the channel of a `RawMessage`, without the hash of its type if the schema is another one now."""
    channel = record.channel
    if schema is None or schema.data == record.schema.data:
        return channel
    return replace(channel, metadata={**channel.metadata, "topic_type_hash": ""})


def _installed(schema):
    """Return the installed definition of a schema's type; the given one if there is none."""
    try:
        return schema and Schema(schema.id, schema_text(schema.name).encode(), "ros2msg", schema.name)
    except (LookupError, OSError, ValueError):  # no such package, no such message, a name that is none of a message
        return schema
