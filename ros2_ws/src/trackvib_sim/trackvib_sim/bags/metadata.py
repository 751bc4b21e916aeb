"""`metadata.yaml` of a bag as rosbag2 of Jazzy writes it (version 9), from the summaries of its MCAP files."""

from collections import Counter
from pathlib import Path

import yaml

from ..new_files import new_file
from .qos import declared_qos


def write_metadata(folder, summaries, mode=""):
    """Write the `metadata.yaml` of a bag folder.

    `summaries` maps the names of its files to their summaries; `mode` is that of compression beside that of chunks:
    "FILE", "MESSAGE" or "".
    """
    text = to_yaml({"rosbag2_bagfile_information": _information(summaries, mode)})
    with new_file(Path(folder) / "metadata.yaml") as file:
        file.write(text.encode())


def channels(summary):
    """Yield each channel of a file with the name of its type and its number of messages."""
    for channel in summary.channels.values():
        schema = summary.schemas.get(channel.schema_id)
        yield channel, schema.name if schema else "", summary.statistics.channel_message_counts.get(channel.id, 0)


def to_yaml(data):
    """Return YAML text in the order of `data`."""
    return yaml.dump(data, Dumper=_Plain, sort_keys=False, allow_unicode=True)


def _information(summaries, mode):
    topics, counts = {}, Counter()
    for summary in summaries.values():
        for channel, type_name, count in channels(summary):
            if channel.message_encoding != "cdr":
                continue  # no topic of ROS; readers refuse the whole bag for it
            topics.setdefault(channel.topic, (type_name, channel))
            counts[channel.topic] += count
    return {
        "version": 9,
        "storage_identifier": "mcap",
        **_span([summary.statistics for summary in summaries.values()]),
        "topics_with_message_count": [
            {
                "topic_metadata": {
                    "name": topic,
                    "type": type_name,
                    "serialization_format": channel.message_encoding,
                    "offered_qos_profiles": declared_qos(channel),
                    "type_description_hash": channel.metadata.get("topic_type_hash", ""),
                },
                "message_count": counts[topic],
            }
            for topic, (type_name, channel) in topics.items()
        ],
        "compression_format": "zstd" if mode else "",
        "compression_mode": mode,
        "relative_file_paths": list(summaries),
        "files": [{"path": name, **_span([summary.statistics])} for name, summary in summaries.items()],
        "custom_data": None,
        "ros_distro": "jazzy",
    }


def _span(statistics):
    filled = [each for each in statistics if each.message_count]
    first = min((each.message_start_time for each in filled), default=0)
    return {
        "duration": {"nanoseconds": max((each.message_end_time for each in filled), default=0) - first},
        "starting_time": {"nanoseconds_since_epoch": first},
        "message_count": sum(each.message_count for each in statistics),
    }


class _Plain(yaml.SafeDumper):
    """Writes everything out: no anchors and references, which other readers may not follow."""

    def ignore_aliases(self, data):
        return True
