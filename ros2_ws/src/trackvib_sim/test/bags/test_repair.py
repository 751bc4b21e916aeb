"""Bags cut short at any byte, or damaged, are completed without losing a whole message."""

import shutil
import struct
import tempfile
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import yaml
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.writer import MCAP0_MAGIC
from rosbags.rosbag2 import Reader
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.repair import repair
from trackvib_sim.bags.writing import BagWriter

MESSAGES = 100
NAME = "bag_0.mcap"


class Sound:
    """A bag that lacks nothing: its folder, the bytes of its file, its messages. (Its repr is short.)"""

    def __init__(self, folder, messages):
        self.folder, self.data, self.messages = folder, (folder / NAME).read_bytes(), messages


@pytest.fixture(scope="module", params=["none", "zstd"])
def sound(request, tmp_path_factory, write_bag):
    """A sound bag of each compression."""
    folder = tmp_path_factory.mktemp("sound") / "bag"
    return Sound(folder, write_bag(folder, MESSAGES, request.param))


@pytest.fixture
def copy(sound, tmp_path):
    """A copy of the sound bag, to be spoiled."""
    return shutil.copytree(sound.folder, tmp_path / "bag")


def cut(data, folder, size):
    """Make a bag of the first `size` bytes of a file, as a recorder that is killed leaves it."""
    folder.mkdir()
    (folder / NAME).write_bytes(data[:size])


def read(folder):
    """Return the messages of a bag as rosbags reads them by metadata.yaml, which must agree with the index."""
    with Reader(folder) as reader:
        found = [bytes(data) for _, _, data in reader.messages()]
        assert reader.message_count == len(found)
    return found


def ends(data):
    """Return where in a sound file each message is whole: those of a compressed chunk at its end."""
    found = []
    for index in make_reader(BytesIO(data)).get_summary().chunk_indexes:
        end = index.chunk_start_offset + index.chunk_length
        content, place = data[end - index.compressed_size : end], 0
        if index.compression:
            content = zstandard.decompress(content)
        while place < len(content):
            opcode, length = struct.unpack_from("<BQ", content, place)
            place += 9 + length
            if opcode == Opcode.MESSAGE:
                found.append(end if index.compression else end - len(content) + place)
    return np.array(found)


@pytest.mark.slow(reason="eighty bags for each compression")
@pytest.mark.property
@settings(max_examples=80, deadline=None)
@given(part=st.floats(0.0, 1.0))
def test_cut_anywhere(sound, part):
    """Wherever a file is cut, every message whose record is whole is in the repaired bag, unchanged, in order."""
    data, messages = sound.data, sound.messages
    size = len(MCAP0_MAGIC) + round(part * (len(data) - len(MCAP0_MAGIC) - 1))
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "bag"
        cut(data, folder, size)
        done = repair(folder)
        found = read(folder)
        assert found == messages[: len(found)]
        assert len(found) >= np.count_nonzero(ends(data) <= size)
        assert done.metadata and done.files[0].messages == len(found)
        assert done.files[0].original.read_bytes() == data[:size]
        assert repair(folder) == ([], False)


def test_nothing_but_the_end_is_lost(sound, copy):
    """Provenance, attachments, compression are kept; the metadata is that of the sound bag but for what was cut off."""
    (copy / NAME).write_bytes(sound.data[: ends(sound.data)[50]])
    repair(copy)
    with (copy / NAME).open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert [each.metadata for each in reader.iter_metadata()] == [{"trackvib_sim": "0"}]
        assert [(each.name, each.data) for each in reader.iter_attachments()] == [("vehicle.yaml", b"name: test\n")]
        assert reader.get_header().profile == "ros2"
    assert contents(copy).compression == contents(sound.folder).compression
    old, new = (
        yaml.safe_load((folder / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
        for folder in (sound.folder, copy)
    )
    kept = new["message_count"]
    assert 51 <= kept < MESSAGES == old["message_count"]
    old["topics_with_message_count"][0]["message_count"] = kept
    assert new["topics_with_message_count"] == old["topics_with_message_count"]
    assert new["duration"]["nanoseconds"] == (kept - 1) * 1_000_000
    assert set(new) == set(old)


def test_of_a_cut_zstd_chunk_whole_blocks_are_read(tmp_path, write_bag):
    """A chunk that was not written to its end still gives the messages in its first blocks."""
    messages = write_bag(tmp_path / "whole", 3000, "zstd", 10**7)
    data = (tmp_path / "whole" / "whole_0.mcap").read_bytes()
    cut(data, tmp_path / "bag", int(0.8 * ends(data)[0]))
    repair(tmp_path / "bag")
    found = read(tmp_path / "bag")
    assert 400 < len(found) < 3000 and found == messages[: len(found)]


def test_sound_bag_is_left_alone(copy):
    """Not one file of it is touched."""
    before = {file.name: (file.stat().st_mtime_ns, file.read_bytes()) for file in copy.iterdir()}
    assert repair(copy) == ([], False)
    assert {file.name: (file.stat().st_mtime_ns, file.read_bytes()) for file in copy.iterdir()} == before


def test_missing_or_wrong_metadata_alone(copy):
    """Only `metadata.yaml` is written then; a wrong one is kept beside."""
    text = (copy / "metadata.yaml").read_text()
    (copy / "metadata.yaml").unlink()
    assert repair(copy) == ([], True)
    assert (copy / "metadata.yaml").read_text() == text
    (copy / "metadata.yaml").write_text(wrong := text.replace(f"message_count: {MESSAGES}", "message_count: 7"))
    assert repair(copy) == ([], True)
    assert (copy / "metadata.yaml").read_text() == text
    assert (copy / "metadata.yaml.damaged").read_text() == wrong


@pytest.mark.parametrize("tail", [bytes(5000), b"\xff" * 5000, MCAP0_MAGIC])
def test_rubbish_at_the_end(sound, copy, tail):
    """What a file system leaves after a power cut, or anything else behind the whole records, is left out."""
    index = make_reader(BytesIO(sound.data)).get_summary().chunk_indexes[3]
    end = index.chunk_start_offset + index.chunk_length
    (copy / NAME).write_bytes(sound.data[:end] + tail)
    repair(copy)
    assert read(copy) == sound.messages[: np.count_nonzero(ends(sound.data) <= end)] != []


@pytest.mark.parametrize("number", [0, 3])
def test_chunk_with_a_wrong_checksum_is_left_out(sound, copy, number):
    """One flipped bit costs the chunk in which it is, and is told; all others are kept, also without the first."""
    data = bytearray(sound.data)
    index = make_reader(BytesIO(data)).get_summary().chunk_indexes[number]
    data[index.chunk_start_offset + index.chunk_length - 100] ^= 1
    (copy / NAME).write_bytes(data)
    done = repair(copy)
    (damage,) = done.files[0].damage
    assert "checksum is wrong" in damage.reason or "cannot be read" in damage.reason
    found = read(copy)
    assert 0.7 * MESSAGES < len(found) < MESSAGES and [each for each in sound.messages if each in found] == found


def test_nonsense_is_refused_and_left_as_it_was(tmp_path):
    """A folder without bag, and files that are no MCAP, give one error that names them."""
    with pytest.raises(BagError, match="holds no .mcap file"):
        repair(tmp_path)
    for content in (b"", b"\x89MCA", b"not a bag at all"):
        (tmp_path / NAME).write_bytes(content)
        with pytest.raises(BagError, match="bag_0.mcap' is not an MCAP file"):
            repair(tmp_path)
        assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [(NAME, content)]


def test_nothing_is_overwritten(sound, copy):
    """A file that has the name for the original stops the repair before anything is changed."""
    data = sound.data[:-50]
    (copy / NAME).write_bytes(data)
    (copy / f"{NAME}.damaged").write_bytes(b"precious")
    with pytest.raises(BagError, match="already exists"):
        repair(copy)
    assert (copy / f"{NAME}.damaged").read_bytes() == b"precious" and (copy / NAME).read_bytes() == data


def test_interrupted_between_the_names(sound, copy, monkeypatch):
    """The original has its name again, and nothing lies about."""
    data = sound.data[:-50]
    (copy / NAME).write_bytes(data)

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(type(copy), "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        repair(copy)
    assert {file.name for file in copy.iterdir()} == {NAME, "metadata.yaml"}
    assert (copy / NAME).read_bytes() == data


def test_bag_that_is_being_recorded_is_refused(tmp_path):
    """Until its writer ends."""
    bag = BagWriter(tmp_path / "bag")
    with pytest.raises(BagError, match="is being recorded"):
        repair(tmp_path / "bag")
    bag.close()
    assert repair(tmp_path / "bag") == ([], False)


def test_killed_before_the_first_message(tmp_path):
    """A bag in which nothing was written yet becomes an empty one."""
    bag = BagWriter(tmp_path / "bag")
    header = (tmp_path / "bag" / NAME).read_bytes()
    bag.close()
    (tmp_path / "bag" / NAME).write_bytes(header)
    repair(tmp_path / "bag")
    assert read(tmp_path / "bag") == []
