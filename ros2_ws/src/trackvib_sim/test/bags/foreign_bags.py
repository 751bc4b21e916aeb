"""Bags as other people's recorders write them: two Imu topics in the legal variants of MCAP and rosbag2."""

import numpy as np
import zstandard
from mcap.writer import CompressionType, IndexType, Writer
from mr_mount_controller.node_base.cdr import NANO
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.nodes.messages import ImuMessage

IMU = "sensor_msgs/msg/Imu"
TOPICS = ("/chassis/imu", "/powertrain/imu")
START = 1_700_000_000 * NANO  # ns
VARIANTS = {  # options of mcap's writer
    "no statistics": {"use_statistics": False},
    "no offsets of the summary": {"use_summary_offsets": False},
    "no summary": {
        "use_statistics": False,
        "use_summary_offsets": False,
        "repeat_channels": False,
        "repeat_schemas": False,
        "index_types": IndexType.NONE,
    },
    "no channels in the summary": {"repeat_channels": False, "repeat_schemas": False},
    "no index": {"index_types": IndexType.NONE},
    "no index of messages": {"index_types": IndexType.CHUNK | IndexType.METADATA | IndexType.ATTACHMENT},
    "no chunks": {"use_chunking": False},
    "no chunks, no statistics": {"use_chunking": False, "use_statistics": False},
    "no checksums": {"enable_crcs": False},
    "lz4": {"compression": CompressionType.LZ4},
    "not compressed": {"compression": CompressionType.NONE},
    "statistics only": {"repeat_channels": False, "index_types": IndexType.NONE, "use_summary_offsets": False},
}


def stamps(samples, rate=1000.0):
    """Stamps (k,) of even samples [ns]."""
    return START + np.round(np.arange(1, samples + 1) / rate * NANO).astype(np.int64)


def imus(stamp):
    """Return a serialised message with each stamp [ns], a vibration in z and gravity."""
    message = ImuMessage("imu_link")
    z = (9.81 + np.sin(2.0 * np.pi * 20.0 * (np.asarray(stamp) - START) / NANO)).tolist()
    return [message.fill(time, (0.1, 0.0, value), (0.0, 0.0, 0.0)) for time, value in zip(stamp, z, strict=True)]


def write_foreign(
    file,
    streams=None,
    name=IMU,
    definition=None,
    encoding="ros2msg",
    qos="",
    packed=lambda data: data,
    more=lambda writer: None,
    message_encoding="cdr",
    **options,
):
    """Write a file; `streams` gives stamps [ns] by topic, by default 1 s of each of `TOPICS`.

    `packed` makes what is written of a message's bytes, `more(writer)` adds to the file, `options` are those of mcap's
    writer.
    """
    streams = dict.fromkeys(TOPICS, stamps(1000)) if streams is None else streams
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("wb") as stream:
        writer = Writer(stream, **({"chunk_size": 40_000} | options))
        writer.start("ros2", "some recorder")
        text = schema_text(IMU).encode() if definition is None else definition
        schema = writer.register_schema(name, encoding, text)
        metadata = {"offered_qos_profiles": qos}
        for topic, stamp in streams.items():
            channel = writer.register_channel(topic, message_encoding, schema, metadata)
            for time, data in zip(stamp.tolist(), imus(stamp.tolist()), strict=True):
                writer.add_message(channel, time, packed(data), time)
        more(writer)
        writer.finish()
    return file


def pack(file):
    """Compress a file as a whole, as `--compression-mode file` does; returns the new one."""
    packed = file.with_name(f"{file.name}.zstd")
    packed.write_bytes(zstandard.compress(file.read_bytes()))
    file.unlink()
    return packed
