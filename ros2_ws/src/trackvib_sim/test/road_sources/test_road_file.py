"""Roads by name or file: what each gives, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from trackvib_sim.road.iso8608 import Iso8608Road, Isotropic, Roughness
from trackvib_sim.road_sources.csv_profile import write_csv_profile
from trackvib_sim.road_sources.road_file import RoadError, find_road, road_in_words

pytestmark = pytest.mark.property
DISTANCE = 0.05 * np.arange(400)
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
        ("just words", "road.yaml"),
        ("a: &a [1]\nb: *a", "alias"),
    ],
)
def test_bad_road_files_are_refused(described, text, words):
    """With the file, the item and what is accepted."""
    with pytest.raises(RoadError, match=words):
        find_road(described(text), 2.8)


@pytest.mark.parametrize("name", ["nowhere.csv", "nowhere.crg", "nowhere", "Q", "", "."])
def test_what_is_not_there_is_refused(tmp_path, monkeypatch, name):
    """By its name, with what is accepted."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RoadError):
        find_road(name, 2.8)
