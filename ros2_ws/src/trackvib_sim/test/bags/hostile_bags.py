"""Bags that are damaged or hostile, of every kind that is known; made from a small sound one."""

import os
import struct
import zlib
from io import BytesIO
from typing import NamedTuple

import lz4.frame
import zstandard
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.nodes.messages import ImuMessage

NAME = "bag_0.mcap"
TOPICS = ("/chassis/imu", "/powertrain/imu")
MESSAGES = 200
COMPRESSIONS = (CompressionType.NONE, CompressionType.ZSTD, CompressionType.LZ4)
CONTROL = "\x1b]0;title\x07\x1b[2J\x1b[31mred\x9b1m\u202eback\r\nline"
MARKUP = "[red]x[/][/"
_HEADER = struct.pack("<BQ", 1, 13) + struct.pack("<I", 4) + b"ros2" + struct.pack("<I", 1) + b"x"
_END = struct.pack("<BQI", 15, 4, 0) + struct.pack("<BQQQI", 2, 20, 0, 0, 0) + MCAP0_MAGIC
_GIB = 1 << 30


class Chunk(NamedTuple):
    """A chunk of a sound bag."""

    start: int
    end: int
    messages: list  # of bytes


def sound_file(compression=CompressionType.ZSTD, checksums=True, qos="", topics=TOPICS, name="note", chunk_size=5000):
    """Return the bytes of an MCAP file with many small chunks, a metadata record and an attachment."""
    file, imu = BytesIO(), ImuMessage("imu")
    writer = Writer(file, chunk_size=chunk_size, compression=compression, enable_crcs=checksums)
    writer.start("ros2", "test")
    writer.add_metadata(name, {name: name})
    writer.add_attachment(0, 0, name, "text/plain", b"text")
    schema = writer.register_schema("sensor_msgs/msg/Imu", "ros2msg", schema_text("sensor_msgs/msg/Imu").encode())
    channels = [writer.register_channel(topic, "cdr", schema, {"offered_qos_profiles": qos}) for topic in topics]
    for k in range(1, MESSAGES + 1):
        data = imu.fill(k // 2 * 1_000_000, (0.1 * k, k / 7.0, 9.81), (1.0 / k, 0.0, k**0.5))
        writer.add_message(channels[k % len(channels)], k // 2 * 1_000_000, data, k // 2 * 1_000_000, k)
    writer.finish()
    return file.getvalue()


def chunks_of(data):
    """Return the `Chunk`s of a sound file, as mcap's own reader finds them."""
    found = []
    for index in make_reader(BytesIO(data)).get_summary().chunk_indexes:
        start, end = index.chunk_start_offset, index.chunk_start_offset + index.chunk_length
        (chunk,) = _records(data[start:end])
        found.append(Chunk(start, end, [each.data for each in breakup_chunk(chunk) if isinstance(each, Message)]))
    return found


def _records(data):
    reader = StreamReader(BytesIO(data), skip_magic=True, emit_chunks=True)
    return [next(reader.records)]


def damaged(data, flips, size):
    """Return the first `size` bytes of a file with some bits (place, bit) flipped."""
    data = bytearray(data)
    for place, bit in flips:
        data[place] ^= 1 << bit
    return bytes(data[:size])


def intact_messages(chunks, flips, size):
    """Return the messages of all chunks that no flip and no cut has touched."""
    whole = (chunk for chunk in chunks if chunk.end <= size)
    return [each for chunk in whole if not any(chunk.start <= place < chunk.end for place, _ in flips)
            for each in chunk.messages]  # fmt: skip


def _record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def _chunk(data, compression, size, checksum=0, last=1):
    name = compression.encode()
    head = struct.pack("<QQQII", 0, last, size, checksum, len(name)) + name + struct.pack("<Q", len(data))
    return _record(6, head + data)


def _zeros(compression, size, told=True):
    """Return so many zeros, packed; `told` says whether the frame tells how many they are."""
    piece = bytes(1 << 24)
    if compression == "lz4":
        packer = lz4.frame.LZ4FrameCompressor()
        begin = packer.begin(size if told else 0)
        return b"".join([begin, *(packer.compress(piece) for _ in range(size // len(piece))), packer.flush()])
    packer = zstandard.ZstdCompressor().compressobj(size=size if told else -1)
    return b"".join([*(packer.compress(piece) for _ in range(size // len(piece))), packer.flush()])


def _bombs(size):
    """Yield files whose chunks unfold to so many bytes, by name."""
    for compression in ("zstd", "lz4"):
        for told in (True, False):
            packed, name = _zeros(compression, size, told), f"bomb {compression}{' told' if told else ''}"
            for claim in (size, 1000, 1 << 62, 0):
                yield f"{name}, claims {claim}", MCAP0_MAGIC + _HEADER + _chunk(packed, compression, claim) + _END
            cut = bytearray(_chunk(packed, compression, size))
            struct.pack_into("<Q", cut, 1, len(cut) + 1000)
            yield f"{name}, cut", MCAP0_MAGIC + _HEADER + bytes(cut)
    packed, data = _zeros("zstd", size), sound_file()
    end = data.rindex(struct.pack("<BQ", 15, 4))
    yield "bomb behind good chunks", data[:end] + _chunk(packed, "zstd", size) + data[end:]
    # the index says that the summary begins with the chunk
    start = len(MCAP0_MAGIC + _HEADER)
    footer = struct.pack("<BQQQI", 2, 20, start, 0, 0) + MCAP0_MAGIC
    yield "bomb as summary", MCAP0_MAGIC + _HEADER + _chunk(packed, "zstd", size) + footer


def _claims():
    """Yield files that claim sizes which they do not have, by name."""
    small = zstandard.compress(bytes(100))
    for size in (1 << 31, 1 << 40, 1 << 62, (1 << 64) - 1):
        yield f"chunk claims {size}", MCAP0_MAGIC + _HEADER + _chunk(small, "zstd", size) + _END
        frame = b"\x28\xb5\x2f\xfd\xe0" + struct.pack("<Q", size) + b"\x01\0\0"
        yield f"frame claims {size}", MCAP0_MAGIC + _HEADER + _chunk(frame, "zstd", size) + _END
        for opcode in (3, 4, 5, 6, 7, 9, 12, 0, 0x80):
            record = struct.pack("<BQ", opcode, size) + bytes(60)
            yield f"record {opcode} claims {size}", MCAP0_MAGIC + _HEADER + record + _END
    yield "unknown compression", MCAP0_MAGIC + _HEADER + _chunk(bytes(50), "xz\x1b", 1000) + _END
    # a great many of the smallest records, definitions, and chunks that overlap in time
    empty = bytes(9) * ((48 << 20) // 9)
    packed = zstandard.compress(empty)
    yield "millions of records", MCAP0_MAGIC + _HEADER + _chunk(packed, "zstd", len(empty), zlib.crc32(empty)) + _END
    text = struct.pack("<I", 30 << 20) + bytes(30 << 20)
    schemas = [
        _record(3, struct.pack("<HI", k, 1) + b"s" + struct.pack("<I", 7) + b"ros2msg" + text) for k in range(1, 13)
    ]
    chunks = (_chunk(zstandard.compress(each), "zstd", len(each), zlib.crc32(each)) for each in schemas)
    yield "definitions without end", MCAP0_MAGIC + _HEADER + b"".join(chunks) + _END


_LAUGHS = "a: &a [lol, lol]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 10)}]\n" for a, b in zip("abcdefghi", "bcdefghij", strict=True)
)
TEXTS = {
    "laughs": _LAUGHS,
    "recursion": "&a [*a]",
    "deep": "[" * 3000,
    "deep blocks": "- " * 3000,
    "date": "rosbag2_bagfile_information: {when: 2001-99-99}",
    "odd date": "- 2001-99-99",
    "integer": "a: !!int ''",
    "bool": "a: !!bool q",
    "long number": "a: " + ":".join(["1"] * 100_000),
    "huge": "# " + "x" * 5_000_000,
    "unhashable": "? [1]\n: 2\n",
    "list": "- 1",
    "odd types": "[!!set {a, b}, !!binary aGk=, 2001-01-01, .nan]",
    "python": "!!python/object/apply:os.system [id]",
    "characters": 'rosbag2_bagfile_information: "\\e[31m\\a"',
    "nonsense": "rosbag2_bagfile_information: {relative_file_paths: 7, message_count: []}",
}
NAMES = (
    MARKUP.replace("/", ""),
    "[",
    "two\nlines",
    "red\x1b[31m",
    "turned\u202etxt",
    "$x^$",
    "' \" $(touch x)",
    "\x9b1m",
)


def files(bomb=_GIB):
    """Yield name and bytes of every hostile file; `bomb` is the size to which chunks unfold."""
    yield from _bombs(bomb)
    yield from _claims()
    for name, text in TEXTS.items():
        yield f"QoS {name}", sound_file(qos=text)
        yield f"QoS {name}, cut", sound_file(qos=text)[:-200]
    yield "topics", sound_file(topics=("/" + CONTROL, "/" + MARKUP, *TOPICS))
    yield "names", sound_file(name=CONTROL + MARKUP)


def odd_folders(place, data):
    """Make bags that are odd by what lies in their folder; yields name, folder, and the files that must stay."""
    victim = place / "victim"
    victim.write_text("precious")

    def folder(name):
        made = place / name
        made.mkdir()
        return made

    for number, name in enumerate(NAMES):
        made = place / name
        made.mkdir()
        (made / NAME).write_bytes(data[:-200] if number % 2 else data)
        yield f"name {name!r}", made, victim
    for name, text in TEXTS.items():
        made = folder(f"metadata {name}")
        (made / NAME).write_bytes(data)
        (made / "metadata.yaml").write_text(text)
        yield made.name, made, victim
    for target in (NAME, "metadata.yaml"):
        for suffix in ("", ".part", ".damaged"):
            made = folder(f"link {target}{suffix}")
            (made / NAME).write_bytes(data[:-200])
            (made / f"{target}{suffix}").unlink(missing_ok=True)
            (made / f"{target}{suffix}").symlink_to(victim)
            yield made.name, made, victim
        made = folder(f"pipe {target}")
        if target != NAME:
            (made / NAME).write_bytes(data)
        os.mkfifo(made / target)
        yield made.name, made, victim
        made = folder(f"folder {target}")
        if target != NAME:
            (made / NAME).write_bytes(data)
        (made / target).mkdir()
        yield made.name, made, victim
    for name, target in (("device", "/dev/zero"), ("loop", NAME), ("gone", "nowhere")):
        made = folder(f"link to a {name}")
        (made / NAME).symlink_to(target)
        yield made.name, made, victim
