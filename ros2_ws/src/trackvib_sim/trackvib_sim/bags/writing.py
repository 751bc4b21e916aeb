"""Writes a bag: a folder with `metadata.yaml` and one MCAP file, as `ros2 bag record -s mcap` leaves it."""

from collections import Counter
from pathlib import Path

import yaml
from mcap.writer import CompressionType, Writer

from .schemas import schema_text

LIBRARY = "trackvib"
CHUNK = 1024 * 1024  # bytes


class BagError(RuntimeError):
    """A bag cannot be written or read; the message names it and says why."""


class BagWriter:
    """One bag. Messages are given as they travel (CDR); `close` makes it complete."""

    def __init__(self, path):
        """Make the folder.

        Raises
        ------
        BagError
            It exists already, or cannot be made.
        """
        self.path = Path(path)
        try:
            self.path.mkdir(parents=True)
            self._file = (self.path / f"{self.path.name}_0.mcap").open("wb")
        except FileExistsError:
            raise BagError(f"bag {str(path)!r} exists already; nothing is overwritten") from None
        except OSError as error:
            raise BagError(f"bag {str(path)!r} cannot be made: {error.strerror}") from None
        self._mcap = Writer(self._file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._mcap.start(profile="ros2", library=LIBRARY)
        self._topics = {}  # topic -> channel id, type, QoS, type hash
        self.counts = Counter()
        self._first, self._last = None, 0

    def add_topic(self, topic, type_name, qos, type_hash):
        """Announce a topic, its type (`package/msg/Type`), its offered QoS (list of `qos.qos_record`) and type hash."""
        schema = self._mcap.register_schema(type_name, "ros2msg", schema_text(type_name).encode())
        metadata = {"offered_qos_profiles": _to_yaml(qos), "topic_type_hash": type_hash}
        channel = self._mcap.register_channel(topic, "cdr", schema, metadata)
        self._topics[topic] = (channel, type_name, qos, type_hash)

    def write(self, topic, stamp, data):
        """Write one serialised message of an announced topic; `stamp` is its time [ns]."""
        channel = self._topics[topic][0]
        self._mcap.add_message(channel, stamp, data, publish_time=stamp)
        self.counts[topic] += 1
        self._first = stamp if self._first is None else min(self._first, stamp)
        self._last = max(self._last, stamp)

    def add_provenance(self, name, values):
        """Write a metadata record: what made the messages. Values are written out as text."""
        self._mcap.add_metadata(name, {str(key): str(value) for key, value in values.items()})

    def close(self):
        """Write the index and `metadata.yaml`."""
        self._mcap.finish()
        self._file.close()
        text = _to_yaml({"rosbag2_bagfile_information": self._information()})
        part = self.path / "metadata.yaml.part"
        part.write_text(text, encoding="utf-8")
        part.replace(self.path / "metadata.yaml")

    def _information(self):
        first = self._first or 0
        span = {
            "duration": {"nanoseconds": self._last - first},
            "starting_time": {"nanoseconds_since_epoch": first},
            "message_count": self.counts.total(),
        }
        name = f"{self.path.name}_0.mcap"
        return {
            "version": 9,
            "storage_identifier": "mcap",
            **span,
            "topics_with_message_count": [
                {
                    "topic_metadata": {
                        "name": topic,
                        "type": type_name,
                        "serialization_format": "cdr",
                        "offered_qos_profiles": qos,
                        "type_description_hash": type_hash,
                    },
                    "message_count": self.counts[topic],
                }
                for topic, (_, type_name, qos, type_hash) in self._topics.items()
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [name],
            "files": [{"path": name, **span}],
            "custom_data": None,
            "ros_distro": "jazzy",
        }


class _Plain(yaml.SafeDumper):
    """Writes everything out: no anchors and references, which other readers may not follow."""

    def ignore_aliases(self, data):
        return True


def _to_yaml(data):
    return yaml.dump(data, Dumper=_Plain, sort_keys=False)
