"""Damaged and hostile bags: repair loses nothing that is whole, and whatever a bag claims ends in one clear error."""

import tempfile
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.stream_reader import MAGIC_SIZE
from trackvib_sim.bags.contents import contents
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.limits import largest_chunk
from trackvib_sim.bags.mcap_summary import examine
from trackvib_sim.bags.playing import OpenBag
from trackvib_sim.bags.raw_messages import RawMessage, raw_records
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.repair import repair

from .hostile_bags import (
    COMPRESSIONS,
    NAME,
    chunks_of,
    damaged,
    files,
    intact_messages,
    odd_folders,
    sound_file,
)

pytestmark = pytest.mark.property
LONGEST_ERROR = 3000  # characters


def messages(bag):
    """Return the messages of a bag with their numbers."""
    records = (record for record in raw_records(bag) if isinstance(record, RawMessage))
    return Counter(record.message.data for record in records if record.message is not None)


@pytest.fixture(scope="module", params=[(kind, sums) for kind in COMPRESSIONS for sums in (True, False)], ids=str)
def sound(request):
    """A sound file of each compression, with checksums and without: its bytes and its chunks."""
    data = sound_file(*request.param)
    return data, chunks_of(data)


def _is_refused(bag):
    """Whether both reading and repair say that it is not an MCAP file."""
    try:
        messages(bag)
    except BagError:
        with pytest.raises(BagError, match="is not an MCAP file"):
            repair(bag)
        return True
    return False


@pytest.mark.slow(reason="sixty bags for each compression")
@settings(max_examples=60, deadline=None)
@given(draw=st.data())
def test_repair_keeps_every_intact_chunk(sound, draw):
    """One to three flipped bits, most of them about the heads of records, and a cut: no whole chunk is lost."""
    data, chunks = sound
    edges = [place for chunk in chunks for edge in (chunk.start, chunk.end) for place in range(edge, edge + 60)]
    places = st.one_of(st.sampled_from(edges), st.integers(0, len(data) - 1))
    flips = draw.draw(st.lists(st.tuples(places, st.integers(0, 7)), min_size=1, max_size=3))
    size = draw.draw(st.one_of(st.just(len(data)), st.integers(100, len(data))))
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder)
        (bag / NAME).write_bytes(damaged(data, flips, size))
        intact = Counter(intact_messages(chunks, flips, size))
        if not intact and any(place < MAGIC_SIZE for place, _ in flips) and _is_refused(bag):
            return  # nothing by which it could be known as MCAP is left
        before = messages(bag)
        done = repair(bag)
        found = messages(bag)
        assert not intact - found
        assert not before - found
        assert not examine(bag / NAME).flaw and repair(bag) == ([], False)
        for file in done.files:
            assert file.messages == found.total() and file.original.read_bytes() == damaged(data, flips, size)


def test_a_file_by_which_nothing_is_known_is_refused(tmp_path):
    """Its magic is damaged, and its only record as well."""
    (tmp_path / NAME).write_bytes(damaged(sound_file(), [(0, 0), (50, 0)], 100))
    assert _is_refused(tmp_path)


@pytest.mark.slow(reason="every bit of every head")
def test_one_flipped_bit_in_a_head_costs_no_message():
    """In opcode, length or the length of the contents of any chunk; and the bag is read as it is."""
    data = sound_file()
    whole = Counter(each for chunk in chunks_of(data) for each in chunk.messages)
    for chunk in chunks_of(data)[:2]:
        for place in (0, 1, 3, 8, 45):
            for bit in range(8):
                with tempfile.TemporaryDirectory() as folder:
                    bag = Path(folder)
                    (bag / NAME).write_bytes(damaged(data, [(chunk.start + place, bit)], len(data)))
                    assert len(read_recording(bag).chassis.stamp) == whole.total() // 2
                    (file,) = repair(bag).files
                    assert (messages(bag), file.lost) == (whole, 0)


@pytest.mark.slow(reason="every byte before the chunks")
def test_lengths_that_no_file_has_cost_no_message(tmp_path):
    """The top bit of every byte of header and attachment, those of lengths of eight bytes among them."""
    data = sound_file()
    chunks = chunks_of(data)
    whole = Counter(each for chunk in chunks for each in chunk.messages)
    for place in range(MAGIC_SIZE, chunks[0].start):
        (tmp_path / NAME).write_bytes(damaged(data, [(place, 7)], len(data)))
        assert messages(tmp_path) == whole, place


def test_lost_messages_are_counted(tmp_path):
    """By the index, which still tells how many there were."""
    data, chunk = sound_file(), chunks_of(sound_file())[2]
    (tmp_path / NAME).write_bytes(damaged(data, [(chunk.end - 20, 3)], len(data)))
    (file,) = repair(tmp_path).files
    assert file.lost == len(chunk.messages) and file.damage[0].place == chunk.start


def accepted(bag):
    """Read, examine, open and repair a bag; whatever is wrong is one error of few printable signs."""
    for verb in (contents, read_recording, messages, lambda bag: OpenBag(bag).close(), repair):
        try:
            verb(bag)
        except BagError as error:
            assert len(str(error)) < LONGEST_ERROR


@pytest.mark.parametrize(("name", "data"), list(files(1 << 27)), ids=lambda each: each if isinstance(each, str) else "")
def test_hostile_files(tmp_path, name, data):
    """Nothing but a `BagError` comes out."""
    (tmp_path / NAME).write_bytes(data)
    accepted(tmp_path)


def test_what_is_too_large_is_named_with_what_is_accepted(tmp_path):
    """By every reader; a larger limit lets it through."""
    bomb = next(data for name, data in files(1 << 27) if name.startswith("bomb zstd told"))
    (tmp_path / NAME).write_bytes(bomb)
    for verb in (read_recording, messages, OpenBag, repair):
        with pytest.raises(BagError, match=rf"{1 << 27} bytes, accepted: {64 << 20} \(64 MiB; --largest-chunk"):
            verb(tmp_path)
    token = largest_chunk.set(256)
    try:
        assert messages(tmp_path) == {}
    finally:
        largest_chunk.reset(token)


@pytest.mark.slow(reason="many bags, each by every way of reading")
def test_odd_folders(tmp_path):
    """Links, pipes, folders and texts in the place of files: nothing is overwritten, nothing hangs."""
    for name, bag, victim in odd_folders(tmp_path, sound_file()):
        accepted(bag)
        assert victim.read_text() == "precious", name


def test_a_name_that_is_too_long():
    """Is that of a bag that cannot be read."""
    for verb in (contents, read_recording, messages, OpenBag, repair):
        with pytest.raises(BagError, match="xx' cannot be read: File name too long"):
            verb("x" * 300)
