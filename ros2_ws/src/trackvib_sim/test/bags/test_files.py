"""Which files of a folder are the bag: those that its metadata list, else those that are there; never hidden ones."""

import shutil

import numpy as np
import pytest
import yaml
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.files import bag_files, find_files
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.repair import NO_MCAP, repair

from .made_bags import write_bag

pytestmark = pytest.mark.property
SPLITS = ("part_b.mcap", "part_a.mcap")  # in the order of time; their names sort otherwise


@pytest.fixture
def split(tmp_path):
    """A bag of two files, and of a list in the metadata that names them in the order of time."""
    folder = tmp_path / "split"
    folder.mkdir()
    for name in SPLITS:
        write_bag(tmp_path / name, 20)
        shutil.move(next((tmp_path / name).glob("*.mcap")), folder / name)
    told = {"relative_file_paths": [f"split/{SPLITS[0]}", SPLITS[1]], "message_count": 0}
    (folder / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": told}))
    return folder


def names(folder):
    return [file.name for file in bag_files(folder)]


def test_the_list_in_the_metadata_counts(split):
    """Its files in its order, whatever lies beside is named and left out; early versions put the folder before."""
    shutil.copy(split / SPLITS[0], split / "recovered.mcap")
    assert names(split) == list(SPLITS)
    recording = read_recording(split)
    assert recording.counts["/chassis/imu"] == 40
    assert recording.notes == ("not listed in metadata.yaml, left out: recovered.mcap",)
    assert contents(split).notes == recording.notes


@pytest.mark.parametrize("text", ["", "no: list", "rosbag2_bagfile_information: {relative_file_paths: [1, 2]}", "- ]"])
def test_without_a_list_files_are_found_by_name(split, text):
    """A bag that was cut short has none, or half of one."""
    (split / "metadata.yaml").write_text(text)
    assert names(split) == sorted(SPLITS) and find_files(split).beside == []


def test_files_that_were_renamed_are_found(split):
    """A list of which nothing is there tells nothing; of which a part is there, the rest is said to be missing."""
    (split / SPLITS[1]).rename(split / "z.mcap")
    found = find_files(split)
    assert ([file.name for file in found.files], found.beside, found.absent) == ([SPLITS[0]], ["z.mcap"], [SPLITS[1]])
    (split / SPLITS[0]).rename(split / "y.mcap")
    found = find_files(split)
    assert [file.name for file in found.files] == ["y.mcap", "z.mcap"] and found.beside == []
    assert found.notes == (f"listed in metadata.yaml, missing: {SPLITS[0]}, {SPLITS[1]}",)


def test_a_list_leads_nowhere_else(split, tmp_path):
    """Names with folders before them mean files of this folder."""
    write_bag(tmp_path / "other", 20)
    told = {"relative_file_paths": ["../other/other_0.mcap", "/etc/passwd", SPLITS[0]]}
    (split / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": told}))
    assert bag_files(split) == [split / SPLITS[0]]


def test_hidden_files_are_none_of_ours(split):
    """As other systems leave them on a stick; not even where nothing lists the others."""
    (split / "._part_a.mcap").write_bytes(b"Mac OS X")
    (split / "metadata.yaml").unlink()
    assert names(split) == sorted(SPLITS) and read_recording(split).notes == ()


@pytest.mark.parametrize("name", SPLITS)
@pytest.mark.parametrize("content", [b"", b"\0" * 3000], ids=["empty", "zeros"])
def test_a_split_of_which_nothing_was_written(split, name, content):
    """The rest is read, with a note; `bag repair` sets it aside and writes the list anew."""
    (split / name).write_bytes(content)
    recording = read_recording(split)
    assert recording.counts["/chassis/imu"] == 20
    assert recording.notes == (f"empty or not MCAP, left out: {name} (`trackvib bag repair` renames it)",)
    done = repair(split)
    assert [(file.file.name, file.flaw, file.original.name) for file in done.files] == [
        (name, NO_MCAP, f"{name}.damaged")
    ]
    assert done.metadata and find_files(split).notes == () and (split / f"{name}.damaged").read_bytes() == content
    again = read_recording(split)
    np.testing.assert_array_equal(again.chassis.stamp, recording.chassis.stamp)


def test_a_bag_of_nothing_is_refused(split):
    """Where every file is empty the first one is named."""
    for name in SPLITS:
        (split / name).write_bytes(b"")
    with pytest.raises(BagError, match="split' cannot be read"):
        read_recording(split)
    with pytest.raises(BagError, match=rf"{SPLITS[0]}' is not an MCAP file"):
        repair(split)
    assert all((split / name).exists() for name in SPLITS)


def test_the_recorder_s_times_may_be_the_stamps(tmp_path):
    """For headers that nobody filled in."""
    write_bag(tmp_path / "bag", 50)
    by_header, by_log = (read_recording(tmp_path / "bag", time=time) for time in ("header", "log"))
    np.testing.assert_array_equal(by_log.chassis.stamp, by_header.chassis.logged)
    np.testing.assert_array_equal(by_log.odometry.stamp, by_header.odometry.stamp)  # recorded at their stamps
    assert by_log.notes == ("stamps are the times at which messages were recorded",)
