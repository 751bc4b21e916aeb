"""OpenCRG surfaces: all four representations, where the tracks run, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal
from trackvib_sim.road.profile import ProfileError
from trackvib_sim.road_sources.crg import read_crg, write_crg

pytestmark = pytest.mark.property
HEAD = """$CT
a surface = made by hand
$
$ROAD_CRG                       ! comment
REFERENCE_LINE_INCREMENT = 0.5  ! m
LONG_SECTION_V_RIGHT = -2.0
LONG_SECTION_V_LEFT = 2.0
LONG_SECTION_V_INCREMENT = 1.0
$
$KD_Definition
#:{kind}
{channels}
$
$$$$
"""
SECTIONS = "\n".join(f"D:long section {k},m" for k in range(1, 6))
GRID = 0.01 * np.arange(20.0).reshape(4, 5)  # from right to left


def as_text(grid, width, on_line):
    """Rows of numbers of a width, each beginning on a new line."""
    lines = []
    for row in grid:
        cells = ["*missing*".ljust(width, "*") if np.isnan(x) else f" {x:.{width - 3}f}"[:width] for x in row]
        lines += ["".join(cells[k : k + on_line]) for k in range(0, len(cells), on_line)]
    return ("\n".join(lines) + "\n").encode()


def as_bytes(grid, kind):
    """Big-endian numbers, filled up with nothing to blocks of 80 bytes."""
    data = np.asarray(grid, dtype=kind).tobytes()
    size = np.dtype(kind).itemsize
    return data + np.full(-len(data) % 80 // size, np.nan, dtype=kind).tobytes()


DATA = {
    "LRFI": lambda grid: as_text(grid, 10, 8),
    "LDFI": lambda grid: as_text(grid, 20, 4),
    "KRBI": lambda grid: as_bytes(grid, ">f4"),
    "KDBI": lambda grid: as_bytes(grid, ">f8"),
}


@pytest.fixture
def surface(tmp_path):
    """A function that writes a file."""

    def write(grid=GRID, kind="KDBI", channels=SECTIONS, head=HEAD, data=None):
        path = tmp_path / "surface.crg"
        text = head.format(kind=kind, channels=channels)
        path.write_bytes(text.encode("latin-1") + (DATA[kind](grid) if data is None else data))
        return path

    return write


@pytest.mark.parametrize("kind", DATA)
def test_all_representations_are_read(surface, kind):
    """Between the sections the height is linear: at +-1.4 m here 6 mm on from the section at 1 m or -2 m."""
    found = read_crg(surface(kind=kind), 2.8)
    assert_allclose(found.distance, [0.0, 0.5, 1.0, 1.5])
    right, left = GRID[:, 0] + 0.006, GRID[:, 3] + 0.004
    assert_allclose(found.heights, [left, right], atol=1e-6)


@given(heights=arrays(float, (2, 23), elements=st.floats(-0.04, 0.04)))
def test_what_is_written_comes_back(tmp_path_factory, heights):
    """To the last bit, whatever the number of rows leaves to a block."""
    path = tmp_path_factory.mktemp("crg") / "road.crg"
    write_crg(path, 0.05, heights, 2.8, 3.0)
    found = read_crg(path, 2.8)
    assert_array_equal(found.heights, heights)
    assert_allclose(found.distance, 3.0 + 0.05 * np.arange(23))


def test_sections_may_stand_anywhere(surface):
    """Their places in their names, in any order."""
    channels = "D:long section at v = 1.400,m\nD:long section at v = -1.400,m"
    found = read_crg(surface(GRID[:, :2], channels=channels), 2.8)
    assert_array_equal(found.heights, [GRID[:, 0], GRID[:, 1]])


def test_slope_and_banking_belong_to_the_surface(surface):
    """A slope of 2 % rises 10 mm a row, banking of 1 % lifts the left track by 14 mm and lowers the right one."""
    channels = f"D:reference line slope,m/m\nD:reference line banking,m/m\n{SECTIONS}"
    grid = np.hstack(([[np.nan, np.nan], *[[0.02, 0.01]] * 3], np.zeros((4, 5))))
    found = read_crg(surface(grid, "LRFI", channels), 2.8)
    rise = 0.01 * np.arange(4)
    assert_allclose(found.heights, [rise + 0.014, rise - 0.014], atol=1e-6)


def with_phi(turn):
    """A grid whose heading changes by so much [rad]."""
    return np.hstack((np.array([[np.nan], [0.0], [0.5 * turn], [turn]]), GRID))


def test_a_road_that_is_straight_but_for_rounding_is_read(surface):
    """A heading of all rows, the same."""
    found = read_crg(surface(with_phi(1e-4), channels=f"D:reference line phi,rad\n{SECTIONS}"), 2.8)
    assert found.heights.shape == (2, 4)


GAP = np.where(np.arange(20).reshape(4, 5) == 13, np.nan, GRID)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"head": "no file of this kind\n"}, "is not an OpenCRG file"),
        ({"kind": "KDBI", "head": HEAD.replace("{kind}", "ABCD")}, "data are ABCD, accepted: LRFI, LDFI, KRBI"),
        ({"channels": ""}, "0 channels, accepted: 1 to"),
        ({"head": HEAD.replace("REFERENCE_LINE_INCREMENT = 0.5", "X = 1")}, "REFERENCE_LINE_INCREMENT is None"),
        ({"head": HEAD.replace("= 0.5", "= half")}, "'REFERENCE_LINE_INCREMENT = half' in .ROAD_CRG"),
        ({"head": HEAD.replace("= 0.5", "= nan")}, "'REFERENCE_LINE_INCREMENT = nan' in .ROAD_CRG"),
        ({"head": HEAD.replace("= 0.5", "= 1e300")}, "a gap of 1e.300 m"),
        ({"head": HEAD.replace("= 0.5", "= 1e-300")}, "are 1 samples at the least distance between them"),
        ({"head": HEAD.replace("$KD", "$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\n$KD")}, "has modifiers"),
        ({"channels": "D:long section at v = 1.2.3,m\nD:long section at v = e,m"}, "reaches from -2 to -1 m across"),
        ({"channels": SECTIONS.replace(",m", ",mm")}, "channel 'long section 1,mm', accepted: heights in m"),
        ({"data": bytes(range(97, 122)) * 80}, "m high, accepted: 1000 m"),
        ({"data": b""}, "0 rows, accepted: 2 to"),
        ({"head": HEAD.replace("= 0.5", "= -0.5")}, "REFERENCE_LINE_INCREMENT is -0.5"),
        ({"head": HEAD.replace("$ROAD_CRG  ", "$ROAD_CRG_FILE\nother.crg\n$ROAD_CRG")}, "only refers to another file"),
        ({"data": as_bytes(GRID, ">f8")[:152]}, "cut short: 19 numbers do not make whole rows of 5"),
        ({"grid": GRID[:1]}, "1 rows, accepted: 2 to"),
        ({"kind": "LRFI", "data": as_text(GRID, 10, 8).replace(b"0.0100000", b"0.0l00000")}, "row 1 begins .* numbers"),
        ({"kind": "LRFI", "data": as_text(GRID[:, :4], 10, 8)}, "row 1 has 4 numbers, must have 5"),
        ({"grid": with_phi(0.3), "channels": f"D:reference line phi,rad\n{SECTIONS}"}, "with a curve.* 0.3 rad"),
        ({"grid": GAP}, "no height in row 3 at 1.4 m across"),
        ({"head": HEAD.replace("2.0", "0.5").replace("= 1.0", "= 0.25")}, "reaches from -0.5 to 0.5 m across"),
        ({"head": HEAD.replace("LONG_SECTION_V_INCREMENT", "X")}, "does not give the positions of its 5 long sections"),
    ],
)  # fmt: skip
def test_bad_files_are_refused(surface, change, words):
    """In one line that names the file and what is wrong."""
    path = surface(**change)
    with pytest.raises(ProfileError, match=words) as refused:
        read_crg(path, 2.8)
    assert str(refused.value).startswith(str(path)) and "\n" not in str(refused.value)
