"""Profiles as CSV: back to the last bit, units, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal
from trackvib_sim.road.profile import ProfileError
from trackvib_sim.road_sources.csv_profile import read_csv_profile, write_csv_profile

pytestmark = pytest.mark.property
GOOD = "distance_m,left_m,right_m\n0,0,0\n0.1,0.01,0.02\n0.2,0,0\n"


@pytest.fixture
def file(tmp_path):
    """A function that writes text to a file."""

    def write(text, encoding="utf-8"):
        path = tmp_path / "profile.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return path

    return write


@given(heights=arrays(float, (2, 30), elements=st.floats(-0.04, 0.04)))
def test_what_is_written_comes_back(tmp_path_factory, heights):
    """To the last bit."""
    path = tmp_path_factory.mktemp("csv") / "road.csv"
    distance = 0.05 * np.arange(7, 37)
    write_csv_profile(path, distance, heights)
    found = read_csv_profile(path)
    assert_array_equal(found.distance, distance)
    assert_array_equal(found.heights, heights)


@pytest.mark.parametrize(
    ("text", "left", "right"),
    [
        (GOOD, [0.0, 0.01, 0.0], [0.0, 0.02, 0.0]),
        ("distance_cm;left_mm;right_mm\n0;0;0\n10;10;20\n20;0;0\n", [0.0, 0.01, 0.0], [0.0, 0.02, 0.0]),
        ("# mine\ndistance_m,height_in\n\n0,0\n# half\n0.1,1\n0.2,0\n", [0.0, 0.0254, 0.0], [0.0, 0.0254, 0.0]),
        ("right_m\tx\tdistance_m\tleft_m\n0\tx\t0\t0\n0.02\tx\t0.1\t0.01\n0\tx\t0.2\t0\n", [0, 0.01, 0], [0, 0.02, 0]),
        ("\ufeffDistance_m,Left_m,Right_m\r\n0,0,0\r\n0.1,0.01,0.02\r\n0.2,0,0\r\n", [0, 0.01, 0], [0, 0.02, 0]),
    ],
)  # fmt: skip
def test_columns_and_units_are_named(file, text, left, right):
    """In any order, beside others, with comments, with the byte order mark of a spreadsheet."""
    found = read_csv_profile(file(text))
    assert_allclose(found.distance, [0.0, 0.1, 0.2])
    assert_allclose(found.heights, [left, right])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty, its first line must name the columns"),
        ("0,0,0\n1,0,0\n", "has the columns 0, 0, 0; accepted: distance_UNIT,left_UNIT,right_UNIT"),
        ("distance_m,left_m\n0,0\n", "accepted: distance_UNIT,left_UNIT,right_UNIT or distance_UNIT,height_UNIT"),
        ("distance_yd,height_m\n0,0\n", "UNIT being one of m, cm, mm"),
        ("distance_m,distance_cm,height_m\n0,0,0\n", "two columns are named distance"),
        (GOOD + "0.3,x,0\n", "line 5: '0.3,x,0', accepted: 3 numbers"),
        (GOOD + "0.3,0\n", "line 5: '0.3,0', accepted: 3 numbers"),
        (GOOD + "0.3,nan,0\n", "left height of sample 4 is nan"),
        (GOOD + "0.1,0,0\n", "distance goes from 0.2 to 0.1 m at sample 4"),
        (GOOD + "9,0,0\n", "a gap of 8.8 m from 0.2 m on"),
        (GOOD + "0.3,400,0\n", "left rises by 400 m.*is the unit right"),
        ("distance_m,height_m\n0,0\n", "1 samples"),
        (b"distance_m,height_m\n0,\xff\n", "is not UTF-8 text: it has a byte 0xff"),
        ("distance_m,height_m\n0,0\n0.1,1e400\n", "left height of sample 2 is inf"),
        ("distance_km,height_km\n0,0\n1e-4,1e308\n", "left height of sample 2 is inf"),
        ("distance_m,height_m\n-1e308,0\n1e308,0\n", "a gap of inf m"),
        ("distance_m,height_m\n0,0\n1e-9,0\n", "are 1 samples at the least distance between them"),
        ("distance_m,height_m\n0,0\n0.1,\0\n", "line 3|not a CSV file"),
        ("distance_m;height_m\n0,0;0;0\n", "line 2: '0,0;0;0', accepted: 2 numbers"),
        (GOOD.replace("0.01", "10").replace("0.02", "20"), "left rises by 10 m .* is the unit right"),
        ("distance_m,height_m\n" + "0" * 20_000, "line 2: more than 10000 characters"),
        (GOOD + "\x1b[31m,0,0\n", r"line 5: '.*, accepted: 3 numbers"),
    ],
)
def test_bad_files_are_refused(file, text, words):
    """In one line that names file, line and what is accepted; nothing raw in it."""
    with pytest.raises(ProfileError, match=words) as refused:
        read_csv_profile(file(text))
    message = str(refused.value)
    assert message.startswith(str(file(text))) and "\n" not in message and "\x1b" not in message
