"""`trackvib road` and `trackvib run --road`: what is told, drawn and written; roads of files driven by the nodes."""

import json
import os

import numpy as np
import pytest
from mcap.reader import make_reader
from rclpy.parameter_client import AsyncParameterClient
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.road_sources.csv_profile import read_csv_profile, write_csv_profile
from trackvib_sim.road_sources.road_file import find_road

from .processes import trackvib

ROAD = """ground: {class: C, seed: 3, level_until: 2, fade: 2}
obstacles: [{shape: v_ramp, at: 12, height: 0.1, length: 1.0}]
"""


@pytest.mark.property
def test_a_road_is_told_drawn_and_written(tmp_path):
    """Table and picture; CSV and OpenCRG files that are the same road, to the last bit."""
    (tmp_path / "mine.yaml").write_text(ROAD)
    files = ["--csv", tmp_path / "out.csv", "--crg", tmp_path / "out.crg", "--out", tmp_path / "out.png"]
    told = trackvib("road", tmp_path / "mine.yaml", "--length", 100, "--begin", 0, *files)
    assert (
        "road mine.yaml (class C of ISO 8608, with 1 V-ramp), 0 to 100 m" in told and "left" in told and "right" in told
    )
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    heights = find_road(str(tmp_path / "mine.yaml"), 2.8).heights(0, 2001)
    np.testing.assert_array_equal(read_csv_profile(tmp_path / "out.csv").heights, heights)
    for name in ("out.csv", "out.crg"):
        np.testing.assert_array_equal(find_road(str(tmp_path / name), 2.8).heights(200, 2001), heights)


@pytest.mark.property
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere.csv"], "road 'nowhere.csv' cannot be read: No such file or directory"),
        (["C", "--csv", "road.png"], "name the same file twice"),
        (["C", "--csv", "C"], "name the same file twice"),
        (["Q"], "accepted: a class (A, B, C, D, E, F, G, H)"),
        (["C", "--length", "100", "--out", "/proc/none/x.png"], "/proc/none"),
    ],
)
def test_bad_roads_end_in_one_line(tmp_path, arguments, words):
    """Exit code 1, nothing left."""
    told = trackvib("road", *arguments, code=1, cwd=tmp_path)
    assert words in told and len(told.strip().splitlines()) == 1 and told.startswith("error: ")
    assert list(tmp_path.iterdir()) == []


BAD = {
    "junk.csv": bytes(range(256)) * 40,
    "junk.crg": bytes(range(256)) * 40,
    "nul.csv": b"distance_m,height_m\n0,0\n0.1,\0\n",
    "huge.csv": b"distance_m,height_m\n0,1e308\n0.1,-1e308\n",
    "far.csv": b"distance_m,height_m\n-1e308,0\n1e308,0\n",
    "escape.csv": b"distance_m,height_m\n0,\x1b[31mred\n",
    "deep.yaml": b"[" * 10_000,
    "alias.yaml": b"a: &a [1]\nb: *a\n",
    "new\nline.csv": b"distance_m,height_m\n",
}


@pytest.mark.slow(reason="many files, each by two commands")
@pytest.mark.property
@pytest.mark.parametrize("verb", ["road", "run"])
@pytest.mark.parametrize("name", [*BAD, "loop.csv", "pipe.crg", "zero.csv", "folder.yaml", "x" * 300 + ".csv"])
def test_bad_files_end_in_one_line(tmp_path, verb, name):
    """Under both verbs: exit code 1, no traceback, nothing raw, nothing left."""
    (tmp_path / "here").mkdir()
    for each, content in BAD.items():
        (tmp_path / each).write_bytes(content)
    (tmp_path / "loop.csv").symlink_to("loop.csv")
    (tmp_path / "zero.csv").symlink_to("/dev/zero")
    (tmp_path / "folder.yaml").mkdir()
    os.mkfifo(tmp_path / "pipe.crg")
    told = trackvib(verb, *(["--road"] if verb == "run" else []), tmp_path / name, code=1, cwd=tmp_path / "here")
    (line,) = told.splitlines()
    assert line.startswith("error: ") and line.isprintable()
    assert list((tmp_path / "here").iterdir()) == []


@pytest.mark.property
def test_a_road_is_not_overwritten_by_itself(tmp_path):
    """A file that is read is none to write to; files may lie in several folders."""
    (tmp_path / "mine.yaml").write_text(ROAD)
    assert "twice" in trackvib("road", "mine.yaml", "--csv", tmp_path / "mine.yaml", code=1, cwd=tmp_path)
    assert (tmp_path / "mine.yaml").read_text() == ROAD
    (tmp_path / "other").mkdir()
    trackvib("road", "mine.yaml", "--length", 50, "--csv", "other/a", "--out", "a", cwd=tmp_path)
    assert (tmp_path / "a").read_bytes().startswith(b"\x89PNG") and (tmp_path / "other" / "a").read_text().startswith(
        "d"
    )


@pytest.mark.slow(reason="a whole run")
@pytest.mark.property
def test_a_bags_road_lies_where_it_was_or_elsewhere(recorded_run, tmp_path):
    """As it was recorded; or begun elsewhere, reversed, repeated, as a file's profile is."""
    recorded, text = find_road(str(recorded_run / "bag"), 2.8), f"file: {recorded_run / 'bag'}"
    expected = Iso8608Road("E", 1).heights(0, 600)
    np.testing.assert_array_equal(recorded.heights(0, 600), expected)
    count = recorded.samples.shape[1]
    for options, samples in (("start: 5", recorded.samples), ("start: 5, reverse: true", recorded.samples[:, ::-1])):
        (tmp_path / "bag.yaml").write_text(f"ground: {{{text}, {options}}}\n")
        np.testing.assert_array_equal(
            find_road(str(tmp_path / "bag.yaml"), 2.8).heights(100, count), samples - samples[:, :1]
        )
    (tmp_path / "bag.yaml").write_text(f"ground: {{{text}, repeat: true}}\n")
    road = find_road(str(tmp_path / "bag.yaml"), 2.8)
    np.testing.assert_array_equal(road.heights(200, count - 1), road.heights(199 + count, count - 1))


@pytest.mark.parametrize(("road", "begins"), [("survey.csv", 10.0), ("E", 16.0)])
def test_the_road_node_tells_where_its_road_begins(start_node, observer, tmp_path, road, begins):
    """A profile after 10 m, a class on its full roughness: what an analysis of the bag takes the settling time from."""
    write_csv_profile(tmp_path / "survey.csv", 0.05 * np.arange(101), np.zeros((2, 101)))
    start_node("road_excitation", road=tmp_path / road if "." in road else road)
    client = AsyncParameterClient(observer.node, "road_excitation")
    observer.wait_for_service(client.services_are_ready)
    told = client.get_parameters(["begins"])
    observer.wait_until(told.done)
    assert told.result().values[0].double_value == begins


@pytest.mark.slow(reason="runs four nodes, three times")
@pytest.mark.cross_engine
def test_a_road_of_a_file_is_driven_to_the_same_bits(recorded_run, tmp_path, env):
    """By CSV, by OpenCRG and by the bag of the first run: the accelerations of all are those of the class itself."""
    heights, tread = Iso8608Road("E", 1).heights(0, 3001), 2.8
    write_csv_profile(tmp_path / "c.csv", 0.05 * np.arange(3001), heights)
    (tmp_path / "c.yaml").write_text("ground: {file: c.csv, start: 0}\n")
    trackvib("road", "E", "--seed", 1, "--begin", 0, "--length", 150, "--tread", tread,
             "--crg", tmp_path / "c.crg", "--out", tmp_path / "c.png")  # fmt: skip
    (tmp_path / "crg.yaml").write_text("ground: {file: c.crg, start: 0}\n")
    expected = read_recording(recorded_run / "bag").powertrain.specific_force
    assert json.loads((recorded_run / "summary.json").read_text())["run"]["road"] == "E"
    like_it = ("--law", "skyhook", "--duration", "3.2")
    for name, road in (("csv", "c.yaml"), ("crg", "crg.yaml"), ("bag", recorded_run / "bag")):
        trackvib("run", "--road", road, *like_it, "--out", name, cwd=tmp_path, env=env)
        found = read_recording(tmp_path / name / "bag").powertrain.specific_force
        assert found.tobytes() == expected.tobytes(), name
        assert json.loads((tmp_path / name / "summary.json").read_text())["run"]["road"] == str(road)
    assert "identical to the last bit" in trackvib("replay", "csv/bag", "--verify", cwd=tmp_path, env=env)
    with (next((tmp_path / "csv" / "bag").glob("*.mcap"))).open("rb") as file:
        told = {record.name: record.metadata for record in make_reader(file).iter_metadata()}
    assert any(values.get("road", "").endswith("/c.yaml") for values in told.values())
