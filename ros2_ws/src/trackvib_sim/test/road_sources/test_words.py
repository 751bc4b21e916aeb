"""What is said of a road: what it really is, and what the vehicle does before it."""

import numpy as np
import pytest
from trackvib_sim.road_sources.measures import measures
from trackvib_sim.road_sources.road_file import find_road, road_in_words
from trackvib_sim.road_sources.words import before, composition

pytestmark = pytest.mark.property

WASHBOARD = "obstacles: [{shape: sine, at: 20, height: 0.05, wavelength: 2, count: 90}]"
FILES = {
    "washboard.yaml": (WASHBOARD, "level ground, with 1 washboard"),
    "mixed.yaml": (
        "ground: {class: B}\nobstacles: [{shape: half_round, at: 30, radius: 0.1}, {shape: step, at: 40, height: 0.1, "
        "length: 1}, {shape: step, at: 50, height: 0.1, length: 1}]",
        "class B of ISO 8608, with 1 half-round and 2 steps",
    ),
    "own.yaml": ("ground: {level: 2.0e-4, waviness: 2.3}", "random, Gd(0.1 1/m) = 0.0002 m³, waviness 2.3"),
    "profile.csv": ("distance_m,height_m\n" + "".join(f"{0.1 * k:.1f},0\n" for k in range(100)), "a profile"),
    "turned.yaml": ("ground: {file: profile.csv, start: 20, reverse: true}", "a profile, reversed"),
}


@pytest.fixture(scope="module")
def roads(tmp_path_factory):
    """Each road by its file's name."""
    folder = tmp_path_factory.mktemp("roads")
    for name, (text, _) in FILES.items():
        (folder / name).write_text(text)
    return {name: find_road(str(folder / name), 2.8) for name in FILES}


def test_roads_are_called_what_they_are(roads):
    """Of a file ground and obstacles, of a class its letter."""
    assert {name: composition(road) for name, road in roads.items()} == {
        name: words for name, (_, words) in FILES.items()
    }
    assert composition(find_road("D", 2.8)) == "class D of ISO 8608"
    assert road_in_words("a/b.yaml", "level ground") == "road b.yaml (level ground)" and road_in_words("D") == "class D"


def test_a_washboard_has_no_class(roads):
    """Neither has a sum of waves; their spectra are no line. A random road of the same length has its own."""
    road = roads["washboard.yaml"]
    found = measures(road.heights(round(20 / road.spacing), round(180 / road.spacing))[0], road.spacing)
    assert found.road_class == "" and np.isnan(found.level) and found.rms > 0.01
    place = 0.1 * np.arange(2000)
    waves = sum(a * np.sin(2 * np.pi * place / b) for a, b in ((0.012, 11.0), (0.008, 5.3), (0.004, 2.1), (0.002, 0.9)))
    assert measures(waves, 0.1).road_class == ""
    assert measures(find_road("C", 2.8).heights(400, 3600)[0], 0.05).road_class == "C"


def test_what_the_vehicle_does_before_a_road(roads):
    """It rolls on level ground up to a profile; roughness of a class fades in; a level road begins with the run."""
    assert before(roads["profile.csv"]).startswith("the road begins at 10 m; a run starts at 0 m")
    assert "begins at 20 m" in before(roads["turned.yaml"])
    assert "fades in from 8 to 16 m" in before(roads["mixed.yaml"]) and before(roads["washboard.yaml"]) == ""
