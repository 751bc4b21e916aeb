"""Bags with a few of their messages or metadata records changed, and what is attached to a bag or counted in it."""

import numpy as np
from mcap.reader import make_reader
from mcap.records import Metadata
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.schemas import schema_text


def edit_bag(bag, folder, message=lambda topic, data: data, provenance=lambda name, values: values):
    """Copy a bag to a new folder, which is returned.

    `message` and `provenance` get the topic or the record's name and the contents, and return what shall stand there,
    or None.
    """
    folder.mkdir()
    channels = {}
    with (folder / "edited_0.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros2", library="test")
        for record in raw_records(bag):
            if isinstance(record, RawMessage) and record.topic not in channels:
                text = schema_text(record.type_name).encode()
                schema = writer.register_schema(record.type_name, "ros2msg", text)
                channels[record.topic] = writer.register_channel(record.topic, "cdr", schema, {})
            if isinstance(record, RawMessage) and record.message is not None:
                time, data = record.message.log_time, message(record.topic, record.message.data)
                if data is not None:
                    writer.add_message(channels[record.topic], time, data, time)
            elif isinstance(record, Metadata):
                values = provenance(record.name, dict(record.metadata))
                if values is not None:
                    writer.add_metadata(record.name, values)
        writer.finish()
    return folder


def attachment(bag, name):
    """Return the text of the last attachment of a name to a bag of one file."""
    (file,) = bag.glob("*.mcap")
    with file.open("rb") as stream:
        return [each.data.decode() for each in make_reader(stream).iter_attachments() if each.name == name][-1]


def counted(bag, topic):
    """Return stamps [ns] and counts of the stream's messages in a bag."""
    with next(bag.glob("*.mcap")).open("rb") as file:
        decoded = make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages([topic])
        found = [(message.log_time, imu.linear_acceleration.x) for _, _, message, imu in decoded]
    return np.array([stamp for stamp, _ in found]), np.array([count for _, count in found])
