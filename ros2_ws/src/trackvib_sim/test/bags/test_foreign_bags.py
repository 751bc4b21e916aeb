"""Bags that others have recorded: every legal variant is read, counted, played, and called sound."""

import shutil
from io import BytesIO

import numpy as np
import pytest
import zstandard
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.playing import OpenBag
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.repair import repair
from trackvib_sim.bags.schemas import SEPARATOR, schema_text
from trackvib_sim.yaml_text import load, read_text

from .foreign_bags import IMU, START, TOPICS, VARIANTS, imus, pack, stamps, write_foreign

pytestmark = pytest.mark.property

IDL = {
    "sensor_msgs/Imu": "std_msgs::msg::Header header; geometry_msgs::msg::Quaternion orientation; "
    "double orientation_covariance[9]; geometry_msgs::msg::Vector3 angular_velocity; "
    "double angular_velocity_covariance[9]; geometry_msgs::msg::Vector3 linear_acceleration; "
    "double linear_acceleration_covariance[9];",
    "std_msgs/Header": "builtin_interfaces::msg::Time stamp; string frame_id;",
    "builtin_interfaces/Time": "int32 sec; uint32 nanosec;",
    "geometry_msgs/Quaternion": "double x; double y; double z; double w;",
    "geometry_msgs/Vector3": "double x; double y; double z;",
}


def idl(types):
    """The definitions of some types as rosbag2 puts IDL files one after the other."""
    sections = []
    for name in types:
        package, message = name.split("/")
        text = f"module {package} {{ module msg {{ struct {message} {{ {IDL[name]} }}; }}; }};"
        sections.append(f"{SEPARATOR}\nIDL: {package}/msg/{message}\n{text}\n")
    return "".join(sections).encode()


def holds_all(bag, samples=1000):
    """Whether every way of reading gives all messages, in order of time, and repair leaves what is there."""
    recording = read_recording(bag)
    np.testing.assert_array_equal(np.sort(recording.chassis.stamp), stamps(samples))
    assert recording.complete
    found = contents(bag)
    assert found.counts == dict.fromkeys(TOPICS, samples) and set(found.types.values()) == {IMU}
    assert (found.first, found.last) == (stamps(samples)[0], stamps(samples)[-1])
    raw = [each.message.data for each in raw_records(bag) if isinstance(each, RawMessage) and each.message is not None]
    assert sorted(raw) == sorted(2 * imus(stamps(samples).tolist()))
    with OpenBag(bag) as opened:
        played = [(time, data) for each, time, data in opened.messages(opened.connections) if each.topic == TOPICS[0]]
    assert played == list(zip(stamps(samples).tolist(), imus(stamps(samples).tolist()), strict=True))
    before = {path.name: path.read_bytes() for path in bag.iterdir()}
    assert repair(bag).files == [] and repair(bag) == ([], False)
    assert {path.name: path.read_bytes() for path in bag.iterdir() if path.name in before} == before


@pytest.mark.parametrize("variant", VARIANTS)
def test_legal_variants(tmp_path, variant):
    """A writer may leave out index, statistics and chunks, and compress as it likes."""
    write_foreign(tmp_path / "bag_0.mcap", **VARIANTS[variant])
    holds_all(tmp_path)


@pytest.mark.parametrize("variant", ["no summary", "no statistics"])
def test_what_is_not_indexed_is_told_by_reading(tmp_path, variant):
    """Metadata, attachments and the compression of chunks."""

    def more(writer):
        writer.add_metadata("settings", {"gain": "2"})
        writer.add_attachment(1, 1, "notes.txt", "text/plain", b"cold")

    write_foreign(tmp_path / "bag_0.mcap", more=more, **VARIANTS[variant])
    found = contents(tmp_path)
    assert (found.provenance, found.attachments, found.compression) == (["settings"], ["notes.txt"], {"zstd"})


def test_one_cut_short_is_still_named(tmp_path):
    """Also where it would have had no summary."""
    file = write_foreign(tmp_path / "bag_0.mcap", **VARIANTS["no summary"])
    file.write_bytes(file.read_bytes()[:-20])
    with pytest.raises(BagError, match="was cut short or is damaged"):
        contents(tmp_path)
    (repaired,) = repair(tmp_path).files
    assert (repaired.messages, repaired.lost) == (2000, None)
    holds_all(tmp_path)


@pytest.mark.parametrize(
    ("encoding", "definition"),
    [
        ("ros2idl", idl(IDL)),
        ("ros2idl", idl(list(IDL)[:1])),
        ("ros2msg", b""),
        ("", b""),
        ("ros2idl", b"\n"),
        ("ros2msg", schema_text(IMU).split(SEPARATOR)[0].encode()),
        ("ros2msg", schema_text(IMU).replace("\n", "\r\n").encode()),
    ],
    ids=["IDL", "IDL alone", "empty", "no encoding", "a line", "alone", "lines of Windows"],
)
def test_definitions(tmp_path, encoding, definition):
    """IDL, and what is left out of types that everybody knows."""
    write_foreign(tmp_path / "bag_0.mcap", encoding=encoding, definition=definition)
    holds_all(tmp_path)


def test_messages_may_be_compressed(tmp_path):
    """Each for itself, as `--compression-mode message` does; the metadata of a repaired bag say so."""
    write_foreign(tmp_path / "bag_0.mcap", packed=zstandard.ZstdCompressor().compress)
    holds_all(tmp_path)
    told = load(read_text(tmp_path / "metadata.yaml"), "metadata")["rosbag2_bagfile_information"]
    assert (told["compression_format"], told["compression_mode"]) == ("zstd", "MESSAGE")


def test_files_may_be_compressed(tmp_path):
    """As a whole; a file that a player has unfolded beside is no second one."""
    file = write_foreign(tmp_path / "bag_0.mcap")
    plain = file.read_bytes()
    pack(file)
    holds_all(tmp_path)
    told = load(read_text(tmp_path / "metadata.yaml"), "metadata")["rosbag2_bagfile_information"]
    assert (told["compression_mode"], told["relative_file_paths"]) == ("FILE", ["bag_0.mcap.zstd"])
    file.write_bytes(plain)
    assert len(read_recording(tmp_path).chassis.stamp) == 1000
    assert len(read_recording(tmp_path / "bag_0.mcap.zstd").chassis.stamp) == 1000


def test_a_compressed_file_that_is_cut_short(tmp_path):
    """It is read as far as it goes, and repaired to one that is not compressed."""
    random = np.random.default_rng(3)  # a frame of zstd is unfolded in blocks, of which there must be some
    noisy = lambda data: data[:-72] + random.bytes(72)  # noqa: E731
    file = pack(write_foreign(tmp_path / "bag_0.mcap", packed=noisy, **VARIANTS["not compressed"]))
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 3 // 4])  # one topic lies behind the other
    recording = read_recording(tmp_path)
    assert not recording.complete and 0 < len(recording.powertrain.stamp) < 1000
    with pytest.raises(BagError, match="bag repair"):
        contents(tmp_path)
    (repaired,) = repair(tmp_path).files
    assert repaired.original.name == "bag_0.mcap.zstd.damaged"
    assert contents(tmp_path).counts.total() == repaired.messages == recording.counts.total()


def test_a_bomb_is_refused_before_it_is_unfolded(tmp_path):
    """A whole file, one that does not tell its size, and messages."""
    zeros = zstandard.ZstdCompressor().compressobj(size=1 << 28)
    told = zeros.compress(bytes(1 << 28)) + zeros.flush()
    untold = BytesIO()
    with zstandard.ZstdCompressor().stream_writer(untold, closefd=False) as writer:
        writer.write(bytes(1 << 28))
    for number, bomb in enumerate((told, untold.getvalue())):
        bag = tmp_path / f"file_{number}"
        bag.mkdir()
        (bag / "bag_0.mcap.zstd").write_bytes(bomb)
        for verb in (read_recording, contents, OpenBag, repair, lambda bag: list(raw_records(bag))):
            with pytest.raises(BagError, match=r"decompressed, has \d+ bytes, accepted:"):
                verb(bag)
    write_foreign(tmp_path / "messages" / "bag_0.mcap", packed=lambda data: zstandard.compress(bytes(1 << 20)))
    for verb in (read_recording, OpenBag):
        with pytest.raises(BagError, match=r"or chunk has \d+ bytes, accepted:"):
            verb(tmp_path / "messages")


def test_order_in_the_file_is_not_that_of_time(tmp_path):
    """Halves the wrong way round are played in order of time."""
    stamp = stamps(1000)
    write_foreign(tmp_path / "bag_0.mcap", dict.fromkeys(TOPICS, np.concatenate((stamp[500:], stamp[:500]))))
    holds_all(tmp_path)


def test_ros_1_is_refused_with_the_way_out(tmp_path):
    """Its messages in MCAP, its own bags, and the other storage of ROS 2: each names the command that converts."""
    write_foreign(tmp_path / "one" / "bag_0.mcap", name="sensor_msgs/Imu", encoding="ros1msg", message_encoding="ros1")
    (tmp_path / "drive.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(100))
    (tmp_path / "drive.db3").write_bytes(b"SQLite format 3\0" + bytes(100))
    (tmp_path / "two").mkdir()
    shutil.copy(tmp_path / "drive.db3", tmp_path / "two" / "drive_0.db3")
    for bag, words in (
        ("one", "holds messages of ROS 1 on /chassis/imu, /powertrain/imu"),
        ("drive.bag", "is a bag of ROS 1"),
        ("drive.db3", "is a bag in sqlite3"),
        ("two", r"holds no \.mcap file"),
    ):
        with pytest.raises(BagError, match=rf"{words}; convert it first: \./trackvib exec -- rosbags-convert --src"):
            read_recording(tmp_path / bag)


@pytest.mark.parametrize(
    ("qos", "latched", "best_effort"),
    [
        ("", False, False),
        ("- history: 1\n  depth: 10\n  reliability: 1\n  durability: 2\n", False, False),  # up to Humble, cut
        ("- {reliability: 2, durability: 1}", True, True),
        ("- {reliability: best_effort, durability: transient_local}", True, True),  # from Iron on
        ("- {reliability: system_default, durability: unknown}", False, False),
        ("- {depth: 5}", False, False),
        ("- 7\n- [1]", False, False),
        ("reliability: 1", False, False),
        ("- {reliability: {}, durability: [1]}", False, False),
        ("- [:", False, False),
    ],
)
def test_qos_of_any_version(tmp_path, qos, latched, best_effort):
    """What is missing or makes no sense is ROS's default."""
    write_foreign(tmp_path / "bag_0.mcap", {TOPICS[0]: stamps(10)}, qos=qos)
    with OpenBag(tmp_path) as bag:
        (connection,) = bag.connections
    assert (connection.is_latched, connection.is_best_effort) == (latched, best_effort)


def test_start_is_that_of_the_whole_bag(tmp_path):
    """Also where only one topic is wanted, of which the messages alone are kept."""
    write_foreign(tmp_path / "bag_0.mcap", {TOPICS[0]: stamps(1000), TOPICS[1]: stamps(1000)[500:]})
    with OpenBag(tmp_path, lambda topic: topic == TOPICS[1]) as bag:
        assert (bag.start, bag.end) == (START + 1_000_000, START + 1_000_000_000)
        found = list(bag.messages(bag.connections, stop=START + 600_000_000))
    assert {each.topic for each, *_ in found} == {TOPICS[1]} and len(found) == 99
