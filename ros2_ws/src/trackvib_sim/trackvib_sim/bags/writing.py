"""Writes a bag: a folder with `metadata.yaml` and one MCAP file, as `ros2 bag record -s mcap` leaves it."""

import fcntl
import shutil
from collections import Counter
from contextlib import suppress
from pathlib import Path

from mcap.writer import CompressionType, Writer

from .errors import BagError
from .mcap_summary import summary_of
from .metadata import to_yaml, write_metadata
from .schemas import schema_text

LIBRARY = "trackvib"
COMPRESSIONS = {"zstd": CompressionType.ZSTD, "none": CompressionType.NONE}
CHUNK = 1024 * 1024  # bytes


class BagWriter:
    """One bag. Messages are given as they travel (CDR); `close` makes it complete.

    Messages are gathered in chunks, which are written when they are full; `flush` writes what there is. Every method
    may raise `OSError`, from a full disk for instance; what was written before can be repaired (`bags.repair`).
    """

    def __init__(self, path, compression="zstd", chunk_size=CHUNK):
        """Make the folder; `compression` is one of `COMPRESSIONS`, `chunk_size` in bytes before compression.

        Raises
        ------
        BagError
            It exists already, or cannot be made.
        """
        self.path = Path(path)
        try:
            self.path.mkdir(parents=True)
        except FileExistsError:
            raise BagError(f"bag {str(path)!r} already exists; nothing is overwritten") from None
        except OSError as error:
            raise BagError(f"bag {str(path)!r} cannot be created: {error.strerror}") from None
        try:
            self._file = (self.path / f"{self.path.name}_0.mcap").open("xb")
            with suppress(OSError):  # where files cannot be locked, none is
                fcntl.flock(self._file, fcntl.LOCK_EX)  # repair keeps away as long as we live
            self._mcap = Writer(self._file, chunk_size=chunk_size, compression=COMPRESSIONS[compression])
            self._mcap.start(profile="ros2", library=LIBRARY)
            self._mcap.flush()
        except OSError as error:
            shutil.rmtree(self.path, ignore_errors=True)
            raise BagError(f"bag {str(path)!r} cannot be created: {error.strerror}") from None
        self._channels = {}  # topic -> channel id
        self.counts = Counter()

    def add_topic(self, topic, type_name, qos, type_hash):
        """Announce a topic, its type (`package/msg/Type`), its offered QoS (list of `qos.qos_record`) and type hash."""
        schema = self._mcap.register_schema(type_name, "ros2msg", schema_text(type_name).encode())
        metadata = {"offered_qos_profiles": to_yaml(qos), "topic_type_hash": type_hash}
        self._channels[topic] = self._mcap.register_channel(topic, "cdr", schema, metadata)

    def copy_topic(self, schema, channel):
        """Announce a topic as in another bag, by mcap's records; returns its channel here, for `copy_message`.

        `schema` is None for a topic without a definition.
        """
        schema_id = self._mcap.register_schema(schema.name, schema.encoding, schema.data) if schema else 0
        copy = self._mcap.register_channel(channel.topic, channel.message_encoding, schema_id, channel.metadata)
        self._channels.setdefault(channel.topic, copy)
        return copy

    def copy_message(self, channel, message):
        """Write a message of another bag, an `mcap.records.Message`, on a channel that `copy_topic` returned."""
        self._mcap.add_message(channel, message.log_time, message.data, message.publish_time, message.sequence)

    def write(self, topic, stamp, data):
        """Write one serialised message of an announced topic; `stamp` is its time [ns]."""
        self._mcap.add_message(self._channels[topic], stamp, data, publish_time=stamp)
        self.counts[topic] += 1

    def add_provenance(self, name, values):
        """Write a metadata record: what made the messages. Values are written out as text."""
        self._mcap.add_metadata(name, {str(key): str(value) for key, value in values.items()})

    def add_attachment(self, name, text):
        """Attach a YAML file."""
        self._mcap.add_attachment(0, 0, name, "application/yaml", text.encode())

    def copy_attachment(self, record):
        """Attach what is attached to another bag: an `mcap.records.Attachment`, of whatever kind."""
        self._mcap.add_attachment(record.create_time, record.log_time, record.name, record.media_type, record.data)

    def flush(self):
        """Hand everything so far to the operating system: it outlives this process, however that ends."""
        self._mcap.flush()

    def close(self):
        """Write the index and `metadata.yaml`."""
        self._mcap.finish()
        self._file.close()
        file = Path(self._file.name)
        write_metadata(self.path, {file.name: summary_of(file)})
