"""Roads by name or file: what each gives, and what is refused."""

import os
import re

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from trackvib_sim.road.iso8608 import Iso8608Road, Isotropic, Roughness
from trackvib_sim.road_sources.csv_profile import write_csv_profile
from trackvib_sim.road_sources.road_file import RoadError, find_road, road_in_words

pytestmark = pytest.mark.property
DISTANCE = 0.05 * np.arange(400)
CRG = b"""$ROAD_CRG
REFERENCE_LINE_INCREMENT = 0.1
$KD_DEFINITION
#:KDBI
D:long section at v = -2,m
D:long section at v = 2,m
"""
WAVES = np.random.default_rng(1).normal(scale=0.01, size=(2, 400))


@pytest.fixture
def described(tmp_path):
    """A function that writes a road file, beside a profile."""
    write_csv_profile(tmp_path / "waves.csv", DISTANCE, WAVES - WAVES[:, :1])

    def write(text):
        path = tmp_path / "road.yaml"
        path.write_text(text)
        return str(path)

    return write


def test_a_class_by_its_letter():
    """With the tread of the vehicle and the seed that are given."""
    expected = Iso8608Road("D", 7, coherence=Isotropic(2.0)).heights(300, 50)
    assert_array_equal(find_road("D", 2.0, 7).heights(300, 50), expected)
    assert (road_in_words("D"), road_in_words("/a/b.csv")) == ("class D", "road b.csv")


def test_a_roughness_of_ones_own(described):
    """Level, waviness and band."""
    road = find_road(described("ground: {level: 1.0e-4, waviness: 2.5, lowest: 0.02, highest: 2, seed: 4}"), 2.8)
    expected = Iso8608Road(Roughness(1e-4, 2.5, 0.02, 2.0), 4)
    assert_array_equal(road.heights(300, 50), expected.heights(300, 50))


def test_coherence_of_ones_own(described):
    """An exponential one in place of that of an isotropic surface."""
    road = find_road(described("ground: {class: C, seed: 4, coherence_length: 0}"), 2.8)
    left, right = road.heights(300, 50)
    assert_array_equal(left, right)


def test_a_profile_with_obstacles(described):
    """By a path from the road file's folder, begun where it says; obstacles on top."""
    text = "ground: {file: waves.csv, start: 5}\nobstacles: [{shape: step, at: 8, height: 0.2, length: 1, side: left}]"
    road = find_road(described(text), 2.8)
    expected = WAVES - WAVES[:, :1]
    expected[0, 61:80] += 0.2
    assert_array_equal(road.heights(100, 400), expected)
    assert road.begins == 5.0


def test_obstacles_alone_stand_on_level_ground(described):
    """With fine samples."""
    road = find_road(described("obstacles: [{shape: half_round, at: 3, radius: 0.1}]"), 2.8)
    assert road.spacing == 0.01
    heights = road.heights(0, 500)
    assert heights.max() == pytest.approx(0.1) and not heights[:, :300].any()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("ground: {class: Q}", "road.yaml: ground.*'Q'"),
        ("ground: {seed: 3}", "one of class and level must be given"),
        ("ground: {class: C, level: 1.0e-4}", "one of class and level must be given"),
        ("ground: {level: 1.0e-4, lowest: 3, highest: 1}", "lowest is 3 1/m and highest 1"),
        ("ground: {file: none.csv}", "none.csv"),
        ("ground: {file: waves.csv}\nspacing: 0.01", "waves.csv has its own"),
        ("obstacles: [{shape: cube, at: 3, height: 1}]", "obstacles.0.*'cube'"),
        ("obstacles: [{shape: step, at: 3, height: -1, length: 1}]", "height is -1"),
        ("obstacles: [{shape: step, at: 3, height: 0.1}]", "length"),
        ("obstacles: [{shape: step, at: .inf, height: 0.1, length: 1}]", "at is inf"),
        ("spacing: 0\nobstacles: []", "spacing is 0"),
        ("hills: 3", "hills"),
        ("ground: {class: C}\nspacing: 0.2", "spacing is 0.2 m, must be at most 0.177 m for waves up to 2.83 1/m"),
        ("ground: {class: C, waviness: 3}", "waviness is given with a class"),
        ("ground: {level: 1, waviness: 4, lowest: 1.0e-3}", "an RMS value of .* accepted: 10"),
        ("ground: {level: .nan}", "level is nan"),
        ("ground: {file: road.yaml}", "road.yaml.*not a valid MCAP file"),
        ("ground: {file: /dev/zero}", "/dev/zero"),
        ('ground: {file: "a\\0b.csv"}', r"a.x00b.csv' cannot be read"),
        ("ground: {file: " + "x" * 400 + ".csv}", "File name too long"),
        ("obstacles: [{shape: step, at: 3, height: 2, length: 1}]", "height is 2"),
        ("obstacles: [{shape: sine, at: 3, height: 1, wavelength: 1, count: 1000000000}]", "count is 1000000000"),
        ("obstacles: " + "[" * 1000, "nested too deeply"),
        ("spacing: " + "9" * 5000, "a number of 5000 characters"),
        ("just words", "road.yaml"),
        ("a: &a [1]\nb: *a", "alias"),
    ],
)
def test_bad_road_files_are_refused(described, text, words):
    """In one line, with the file, the item and what is accepted."""
    with pytest.raises(RoadError, match=words) as refused:
        find_road(described(text), 2.8)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("name", ["nowhere.csv", "nowhere.crg", "nowhere.yaml", "nowhere", "Q", "", ".", "x" * 5000])
def test_what_is_not_there_is_refused(tmp_path, monkeypatch, name):
    """By its name, with what is accepted."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RoadError):
        find_road(name, 2.8)


@pytest.mark.parametrize("suffix", [".csv", ".crg", ".yaml", ""])
@pytest.mark.parametrize("kind", ["folder", "pipe", "device", "loop", "locked"])
def test_what_is_no_file_is_refused(tmp_path, suffix, kind):
    """At once: a folder, a pipe that nobody writes to, a device without end, a loop of links, another's file."""
    path = tmp_path / f"road{suffix}"
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    elif kind == "loop":
        path.symlink_to(path)
    else:
        path.touch(mode=0o000)
        if os.access(path, os.R_OK):
            pytest.skip("root may read everything")
    with pytest.raises(RoadError, match=re.escape(str(path))) as refused:
        find_road(str(path), 2.8)
    assert "\n" not in str(refused.value)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(suffix=st.sampled_from([".csv", ".crg", ".yaml"]), start=st.integers(0, 5), junk=st.binary(max_size=300))
def test_junk_is_refused_or_a_road(tmp_path, suffix, start, junk):
    """Whatever the bytes are, behind a beginning that is well formed: one line, or heights that are finite."""
    beginnings = {
        ".csv": (b"", b"distance_m,height_m\n", b"distance_m,height_m\n0,0\n0.1,0\n", b"height_mm;distance_km\n", b"#"),
        ".crg": (b"", CRG, CRG + b"$$$$\n", CRG.replace(b"KDBI", b"LRFI") + b"$$$$\n", b"$CT\n$\n$ROAD_CRG\n"),
        ".yaml": (b"", b"ground: ", b"obstacles: [", b"ground: {class: C, ", b"spacing: "),
    }[suffix]
    path = tmp_path / f"junk{suffix}"
    path.write_bytes(beginnings[start % len(beginnings)] + junk)
    try:
        heights = find_road(str(path), 2.8).heights(-100, 1000)
    except RoadError as error:
        assert len(str(error).splitlines()) == 1
    else:
        assert np.isfinite(heights).all()


SCALARS = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.sampled_from(["C", "waves.csv", "step", "both", "\0"])
)
ITEMS = ["class", "level", "waviness", "lowest", "highest", "seed", "level_until", "fade", "coherence_length", "file",
         "start", "reverse", "repeat", "shape", "at", "side", "radius", "height", "length", "ramp", "depth",
         "wavelength", "count"]  # fmt: skip


@pytest.mark.slow(reason="a road of every kind of item")
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    ground=st.dictionaries(st.sampled_from(ITEMS), SCALARS, max_size=5),
    obstacle=st.dictionaries(st.sampled_from(ITEMS), SCALARS, max_size=6),
    spacing=SCALARS,
)
def test_any_values_are_refused_or_a_road(described, ground, obstacle, spacing):
    """Of all kinds at all items: a line for each item that does not fit, or heights that are finite."""
    text = yaml.safe_dump({"ground": ground or None, "obstacles": [obstacle] if obstacle else [], "spacing": spacing})
    try:
        heights = find_road(described(text), 2.8).heights(-100, 200)
    except RoadError as error:
        assert str(error).replace("\n", "").isprintable()
    else:
        assert np.isfinite(heights).all()
