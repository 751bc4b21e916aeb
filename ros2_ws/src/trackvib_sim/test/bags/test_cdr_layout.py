"""Places of numbers in serialised messages, beside rosbags' serialiser: either byte order, odd sizes before them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.bags.cdr_layout import LayoutError, find_layout, type_store

NAME = "some_msgs/msg/Mixed"
DEFINITION = f"""
bool flag
string name
uint16[] counts
Inner[2] pairs
float32 small
int64 large
{"=" * 80}
MSG: some_msgs/Inner
uint8 mark
float64[3] values
"""
STORE = type_store(NAME, "ros2msg", DEFINITION.encode())
WANTED = {"flag": (), "pairs.0.values": (3,), "pairs.1.values": (3,), "small": (), "large": ()}


def serialised(name, counts, values, little_endian=True):
    """Return a message's bytes as rosbags writes them."""
    mixed, inner = STORE.types[NAME], STORE.types["some_msgs/msg/Inner"]
    pairs = [inner(7, np.array(each)) for each in values]
    message = mixed(True, name, np.array(counts, np.uint16), pairs, 0.5, -(2**40))
    return bytes(STORE.serialize_cdr(message, NAME, little_endian=little_endian))


@pytest.mark.cross_engine
@given(
    name=st.text("abc", max_size=9),
    counts=st.lists(st.integers(0, 65535), max_size=5),
    seed=st.integers(0, 2**32 - 1),
    little_endian=st.booleans(),
)
def test_numbers_stand_where_rosbags_writes_them(name, counts, seed, little_endian):
    """Whatever text and sequence stand before them, which move and align them anew."""
    values = np.random.default_rng(seed).normal(size=(2, 3))
    data = serialised(name, counts, values, little_endian)
    layout = find_layout(STORE, NAME, data, WANTED)
    numbers = np.frombuffer(data, layout.numbers)[0]
    assert layout.size == len(data)
    assert (numbers["flag"], numbers["small"], numbers["large"]) == (True, 0.5, -(2**40))
    np.testing.assert_array_equal((numbers["pairs.0.values"], numbers["pairs.1.values"]), values)


@pytest.mark.property
def test_lengths_tell_messages_of_one_size_apart():
    """A longer text with a shorter sequence can have the same size; the layout does not take one for the other."""
    values = np.ones((2, 3))
    first, second = serialised("abcd", [1, 2, 3, 4], values), serialised("abcdef", [1, 2, 3], values)
    assert len(first) == len(second)
    layout = find_layout(STORE, NAME, first, WANTED)
    assert np.frombuffer(first, layout.lengths)[0] == layout.values
    assert np.frombuffer(second, layout.lengths)[0] != layout.values


@pytest.mark.property
def test_what_does_not_fit_is_refused():
    """A field that is not there, of another shape or mixed, a cut message, other encodings, a broken definition."""
    data = serialised("abc", [1], np.ones((2, 3)))
    for wanted in ({"missing": ()}, {"small": (2,)}, {"name": ()}):
        with pytest.raises(LayoutError, match=r"has \d numbers, must be"):
            find_layout(STORE, NAME, data, wanted)
    with pytest.raises(LayoutError, match="not of one kind, one after the other"):
        find_layout(STORE, NAME, data, {"pairs": (8,)})
    for size in (4, 10, len(data) - 1):
        with pytest.raises(LayoutError, match="shorter than its definition"):
            find_layout(STORE, NAME, data[:size], WANTED)
    for start in (b"", b"\x00\x07\x00\x00"):
        with pytest.raises(LayoutError, match="not plain CDR"):
            find_layout(STORE, NAME, start + data[4 if start else len(data) :], WANTED)
    incomplete = DEFINITION.replace("MSG: some_msgs/Inner", "MSG: some_msgs/Other").encode()
    with pytest.raises(LayoutError, match="field pairs.0 is a some_msgs/msg/Inner, which .* does not define"):
        find_layout(type_store(NAME, "ros2msg", incomplete), NAME, data, WANTED)
    with pytest.raises(LayoutError, match="is in 'protobuf', accepted are ros2msg, ros2idl"):
        type_store(NAME, "protobuf", b"")
    with pytest.raises(LayoutError, match="cannot be read"):
        type_store(NAME, "ros2msg", b"float64 = = 3 [")
