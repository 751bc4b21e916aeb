"""What goes in and out of a controller in a bag, as bytes: the samples of both Imu, and the answers."""

from array import array
from typing import NamedTuple

import numpy as np
from mcap.exceptions import EndOfFile
from mcap.records import Channel, Message, Metadata

from ..simulation.settings import NANO
from .replaying import records
from .stamps import leading_stamp
from .writing import BagError


class RecordedLoop(NamedTuple):
    """What a bag holds of the loop."""

    chassis: str  # topics
    powertrain: str
    samples: int  # messages on the first
    rate: int  # of the samples, Hz
    answers: list  # serialised messages, in the order of arrival; none where there is no such topic
    provenance: dict  # metadata records


def recorded_loop(path):
    """Return the `RecordedLoop` in a bag folder; topics are found by the ends of their names.

    Raises
    ------
    BagError
        The bag cannot be read, lacks an Imu, or holds more than one run.
    """
    topics, known, stamps, answers, provenance = {}, set(), array("q"), [], {}
    try:
        for record in records(path):
            if isinstance(record, Channel):
                topics[record.id] = record.topic  # of the file at hand; each has numbers of its own
                known.add(record.topic)
            elif isinstance(record, Metadata):
                provenance[record.name] = dict(record.metadata)
            elif isinstance(record, Message) and topics[record.channel_id].endswith("/chassis/imu"):
                stamps.append(leading_stamp(record.data))
            elif isinstance(record, Message) and topics[record.channel_id].endswith("/coil_current"):
                answers.append(record.data)
    except EndOfFile:
        pass
    if len(stamps) < 2:
        raise BagError(f"bag {str(path)!r} holds no samples on chassis/imu")
    if min(np.diff(stamps)) <= 0:
        raise BagError(f"bag {str(path)!r} holds more than one run: the samples begin anew")
    chassis, powertrain = (_topic(path, known, end) for end in ("chassis/imu", "powertrain/imu"))
    rate = round(NANO / float(np.median(np.diff(stamps))))
    return RecordedLoop(chassis, powertrain, len(stamps), rate, answers, provenance)


def _topic(path, topics, end):
    found = [topic for topic in topics if topic.endswith(f"/{end}")]
    if len(found) != 1:
        raise BagError(f"bag {str(path)!r} holds {len(found)} topics that end in {end}, must be one")
    return found.pop()


def sample_messages(path, chassis, powertrain):
    """Yield stamp [ns] and both serialised Imu messages of each sample of which the bag holds both topics' message.

    Raises as `replaying.records` does, but for a bag that is cut short, which ends.
    """
    topics, waiting = {}, {}  # names by number; messages without their partner by topic and stamp
    partner = {chassis: powertrain, powertrain: chassis}
    try:
        for record in records(path):
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Message) and (topic := topics[record.channel_id]) in partner:
                stamp = leading_stamp(record.data)
                other = waiting.pop((partner[topic], stamp), None)
                if other is None:
                    waiting[topic, stamp] = record.data
                else:
                    yield stamp, *((record.data, other) if topic == chassis else (other, record.data))
    except EndOfFile:
        pass
