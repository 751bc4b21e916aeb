"""Opens a bag for playing: raw messages in order of time, and the quality of service with which they came."""

from contextlib import ExitStack
from tempfile import TemporaryFile
from typing import NamedTuple

import numpy as np
from mcap.exceptions import InvalidMagic
from mcap.records import Channel, Schema

from ..numerics.units import NANO
from .errors import BagError
from .files import bag_files
from .limits import TooLarge, too_large
from .mcap_records import DAMAGE
from .mcap_summary import examine
from .mcap_walk import Walk
from .opening import most_unfolded, opened
from .qos import BEST_EFFORT, TRANSIENT_LOCAL, offers
from .unfolding import unfold_messages

_LATEST = ((1 << 31) - 1) * NANO  # ns, the last second that a message of ROS 2 can name
_PLACE = np.dtype([("time", "<i8"), ("start", "<i8"), ("size", "<u4"), ("connection", "<u4")])


class Connection(NamedTuple):
    """A topic as one publisher announced it."""

    number: int  # in its bag
    topic: str
    encoding: str  # of the messages: "cdr" of all that ROS 2 can play
    schema: Schema | None
    reliability: frozenset  # of its offers, in rosbag2's words
    durability: frozenset

    @property
    def type_name(self):
        """Name of the type, "" where none is told."""
        return self.schema.name if self.schema else ""

    @property
    def is_latched(self):
        """Whether its messages were kept for late joiners (transient local)."""
        return self.durability == {TRANSIENT_LOCAL}

    @property
    def is_best_effort(self):
        """Whether its messages could be lost on their way."""
        return BEST_EFFORT in self.reliability


class OpenBag:
    """The messages of a bag by time, whatever the order in its files; use as a context manager, or `close` it.

    They lie in an unnamed temporary file.

    Attributes
    ----------
    connections : list of Connection
    start, end : int
        Times of the first and of the last message of all topics [ns].

    Raises
    ------
    BagError
        There is no such bag, it holds no messages, it is damaged, or it cannot be read.
    """

    def __init__(self, path, wanted=lambda topic: True, whole=True):
        """Read the bag and keep the messages of topics that are `wanted`.

        One that is cut short is refused, or read as far as it goes if it need not be `whole`.
        """
        self.connections, self._places, self._size, self._most, self._times = [], [], 0, 0, []
        with ExitStack() as undo:
            self._file = undo.enter_context(TemporaryFile())
            try:
                for file in bag_files(path):
                    if whole:
                        _require_sound(file)
                    self._most += most_unfolded(file.stat().st_size)
                    self._read(file, wanted)
            except (OSError, TooLarge, *DAMAGE) as error:
                raise BagError(f"bag {str(path)!r} cannot be read: {error}") from None
            if not self._times:
                raise BagError(f"bag {str(path)!r} holds no messages")
            self.start, self.end = min(self._times), max(self._times)
            if self.end > _LATEST:
                raise BagError(f"bag {str(path)!r} ends at {self.end} ns, accepted: up to {_LATEST}")
            self._file.flush()
            undo.pop_all()
        places = np.concatenate(self._places or [np.empty(0, _PLACE)])
        self._places = places[np.argsort(places["time"], kind="stable")]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Forget the messages."""
        self._file.close()

    def messages(self, connections, start=None, stop=None):
        """Yield connection, time [ns] and bytes of messages from `start` on and before `stop`, in order of time."""
        places = self.places(connections)
        begin, end = np.searchsorted(self._places["time"][places], (start or 0, _LATEST + 1 if stop is None else stop))
        for place in places[begin:end].tolist():
            found = self._places[place]
            yield self.connections[found["connection"]], int(found["time"]), self.message(place)

    def places(self, connections):
        """Return the places (k,) of the messages of some connections, in order of time, for `message`."""
        numbers = [connection.number for connection in connections]
        return np.flatnonzero(np.isin(self._places["connection"], numbers))

    def times(self, places):
        """Return the times (k,) at which messages were recorded [ns]."""
        return self._places["time"][places]

    def message(self, place):
        """Return the bytes of a message."""
        found = self._places[place]
        self._file.seek(found["start"])
        return self._file.read(found["size"])

    def _read(self, file, wanted):
        """Take in the messages of a file; ids of schemas and channels are its own."""
        schemas, numbers = {}, np.full(1 << 16, -1)
        with opened(file) as stream:
            for part in Walk(stream).parts():
                for record in part.others:
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        numbers[record.id] = self._announced(record, schemas, wanted)
                head = part.messages.head
                if len(head):
                    self._times += [int(head["log_time"].min()), int(head["log_time"].max())]
                connection = numbers[head["channel"]]
                kept = connection >= 0
                if kept.any():
                    self._keep(part, kept, connection[kept])

    def _announced(self, channel, schemas, wanted):
        """Return the number of a channel's connection, -1 if its topic is not wanted."""
        offered = offers(channel)
        number = len(self.connections)
        self.connections.append(
            Connection(
                number,
                channel.topic,
                channel.message_encoding,
                schemas.get(channel.schema_id),
                frozenset(each.reliability for each in offered),
                frozenset(each.durability for each in offered),
            )
        )
        return number if wanted(channel.topic) else -1

    def _keep(self, part, kept, connection):
        head, start, size = (each[kept] for each in part.messages)
        data, start, size = unfold_messages(part.data, start, size)
        ends = np.cumsum(size)
        if self._size + ends[-1] > self._most:
            raise too_large("the contents of the bag", self._size + int(ends[-1]))
        places = np.empty(len(start), _PLACE)
        places["time"], places["size"], places["connection"] = head["log_time"], size, connection
        places["start"] = self._size + ends - size
        self._file.write(np.concatenate([data[at : at + length] for at, length in zip(start, size, strict=True)]).data)
        self._places.append(places)
        self._size += int(ends[-1])


def _require_sound(file):
    """Raise ValueError or TooLarge unless a file is whole."""
    try:
        findings = examine(file)
    except InvalidMagic:
        raise ValueError(f"{file.name!r} is not an MCAP file") from None
    if findings.flaw:
        raise ValueError(f"{file.name!r} is {findings.flaw}; `trackvib bag repair` repairs it")
