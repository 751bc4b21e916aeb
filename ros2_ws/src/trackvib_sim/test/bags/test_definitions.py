"""Places of numbers in serialised messages, beside rosbags' serialiser: either byte order, odd sizes before them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.node_base.cdr import LayoutError, check, find_layout
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from trackvib_sim.bags.definitions import Definition

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
STORE = get_typestore(Stores.EMPTY)
STORE.register(get_types_from_msg(DEFINITION, NAME))
MIXED = Definition(NAME, "ros2msg", DEFINITION.encode())
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
    layout = find_layout(MIXED.kind, data, WANTED)
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
    layout = find_layout(MIXED.kind, first, WANTED)
    assert np.frombuffer(first, layout.lengths)[0] == layout.values
    assert np.frombuffer(second, layout.lengths)[0] != layout.values


@pytest.mark.property
def test_what_does_not_fit_is_refused():
    """A field that is not there, of another shape or mixed, a cut message, other encodings, a broken definition."""
    data = serialised("abc", [1], np.ones((2, 3)))
    for wanted in ({"missing": ()}, {"small": (2,)}, {"name": ()}):
        with pytest.raises(LayoutError, match=r"has (1 numbers, must be 2|no numbers)"):
            find_layout(MIXED.kind, data, wanted)
    with pytest.raises(LayoutError, match="not of one kind, one after the other"):
        find_layout(MIXED.kind, data, {"pairs": (8,)})
    for size in (4, 10, len(data) - 1):
        with pytest.raises(LayoutError, match="shorter than its definition"):
            find_layout(MIXED.kind, data[:size], WANTED)
    for start in (b"", b"\x00\x07\x00\x00"):
        with pytest.raises(LayoutError, match="not plain CDR"):
            find_layout(MIXED.kind, start + data[4 if start else len(data) :], WANTED)
    incomplete = DEFINITION.replace("MSG: some_msgs/Inner", "MSG: some_msgs/Other").encode()
    with pytest.raises(LayoutError, match="field pairs is a some_msgs/msg/Inner, which .* does not define"):
        Definition(NAME, "ros2msg", incomplete)
    with pytest.raises(LayoutError, match="is in 'protobuf', accepted: ros2msg, ros2idl"):
        Definition(NAME, "protobuf", b"")
    with pytest.raises(LayoutError, match="definition of some_msgs/msg/Mixed is missing"):
        Definition(NAME, "ros2msg", b"")
    with pytest.raises(LayoutError, match="cannot be read"):
        Definition(NAME, "ros2msg", b"float64 = = 3 [")
    with pytest.raises(LayoutError, match="field name is a wstring, which has no layout"):
        Definition(NAME, "ros2idl", b"module some_msgs { module msg { struct Mixed { wstring name; }; }; };")


@pytest.mark.property
@pytest.mark.parametrize("field", ["Mixed inner", "Mixed[] inner", "Mixed[2] inner\nMixed[3] other"])
def test_a_message_that_holds_itself_is_refused(field):
    """It has no end, and no place for what follows."""
    with pytest.raises(LayoutError, match="definition of some_msgs/msg/Mixed is more than 50 deep"):
        Definition(NAME, "ros2msg", field.encode())


@pytest.mark.property
@pytest.mark.parametrize("claim", [6, 2**20, 2**32 - 1])
@pytest.mark.parametrize(
    "field", ["string text", "float64[] values", "string[] names", "Empty[] parts", "Empty[{}] parts"]
)
def test_lengths_are_borne_out_by_bytes(field, claim):
    """A text or sequence that claims more than there is is refused before anybody makes room for it."""
    text = f"{field.format(claim)}\n{'=' * 80}\nMSG: some_msgs/Empty\n".encode()
    with pytest.raises(LayoutError, match="says: [a-z.]+ takes [0-9]+ bytes, [0-9]+ are left"):
        check(Definition(NAME, "ros2msg", text).kind, b"\0\1\0\0" + claim.to_bytes(4, "little") + b"a")
