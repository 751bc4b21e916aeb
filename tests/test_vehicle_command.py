"""`trackvib vehicle`, as a user calls it."""

import json
import re

import pytest
import yaml
from trackvib_sim.data import find_vehicle, vehicle_names

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="each case starts the command line")

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def vehicle(start_cli):
    """Run `trackvib vehicle` to its end, in a directory of the test: exit code and output."""

    def make(*arguments):
        process = start_cli("vehicle", *arguments)
        return process.wait(), process.output

    return make


@pytest.fixture
def other(tmp_path):
    """Write the shipped vehicle file with another value of one item: `other("hull", "mass", 1.0)`."""

    def make(section, item, value):
        content = yaml.safe_load(find_vehicle().read_text(encoding="utf-8"))
        content[section][item]["value"] = value
        path = tmp_path / "mine.yaml"
        path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        return path

    return make


@pytest.mark.slow(reason="draws and settles a vehicle")
def test_prints_tables_and_draws(vehicle, tmp_path):
    """Without options the shipped vehicle stands in both tables, and its drawing lies where the user stands."""
    code, output = vehicle()
    assert code == 0, output
    for word in ("sprocket_teeth", "link_stiffness", "published", "literature", "assumed", "v/p", "vehicle.png"):
        assert word in output
    assert (tmp_path / "vehicle.png").read_bytes().startswith(PNG)
    assert [path.name for path in tmp_path.rglob("*.png")] == ["vehicle.png"]


@SLOW
def test_takes_another_vehicle(vehicle, other, tmp_path):
    """A file of the user's own is printed and drawn to where it was asked for."""
    code, output = vehicle("--vehicle", other("hull", "mass", 23456.0), "--out", tmp_path / "mine.png")
    assert code == 0, output
    assert "23456" in output and "mine.png" in output
    assert (tmp_path / "mine.png").read_bytes().startswith(PNG)


@SLOW
def test_takes_a_vehicle_by_its_name(vehicle, tmp_path):
    """One that comes with the package needs no path; nothing that lies about under its name is taken instead."""
    (tmp_path / "m113").mkdir()
    code, output = vehicle("--vehicle", "m113", "--out", tmp_path / "mine.png")
    assert code == 0, output
    assert "m113.yaml" in output and "recommended physics" in output


@pytest.mark.slow(reason="settles every vehicle")
def test_lists_vehicles(vehicle, tmp_path):
    """Each that comes with the package has its line; nothing is drawn."""
    code, output = vehicle("--list")
    assert code == 0, output
    assert all(re.search(rf"\b{name}\b", output) for name in vehicle_names())
    assert re.search(r"tao2025 .* 42\.8 t .* 6 .* rear .* 2 mr", output)
    assert re.search(r"m113 .* 5 .* front", output)
    assert not list(tmp_path.rglob("*.png"))


@SLOW
def test_prints_the_schema(vehicle, tmp_path):
    """Standard output is one JSON document and nothing else; nothing is drawn."""
    code, output = vehicle("--schema")
    assert code == 0, output
    schema = json.loads(output)
    assert schema["$schema"].startswith("https://json-schema.org/") and "swing_arms" in schema["properties"]
    assert not list(tmp_path.rglob("*.png"))


@SLOW
@pytest.mark.parametrize(
    ("item", "words"),
    [
        (("hull", "mass", -1.0), ("mine.yaml: hull.mass is -1.0", "greater than 0")),
        (("tracks", "links", 150), ("tracks.links x tracks.pitch is", "must be")),
    ],
)
def test_refuses_a_bad_vehicle_in_one_line(vehicle, other, tmp_path, item, words):
    """A value out of range and a track that does not fit end in one line, exit code 1 and no drawing."""
    code, output = vehicle("--vehicle", other(*item))
    assert code == 1
    assert output.startswith("error: ") and output.count("\n") == 1 and output.endswith("\n")
    assert all(word in output for word in words)
    assert not list(tmp_path.rglob("*.png"))


@SLOW
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--vehicle", "nowhere.yaml"), ("'nowhere.yaml'", "cannot be read")),
        (("--out", "nowhere/vehicle.png"), ("nowhere/vehicle.png", "folder must exist")),
    ],
)
def test_refuses_places_that_are_not_there(vehicle, tmp_path, arguments, words):
    """A missing file and a missing folder end in one line, exit code 1 and no drawing."""
    code, output = vehicle(*arguments)
    assert code == 1
    assert output.startswith("error: ") and output.count("\n") == 1
    assert all(word in output for word in words)
    assert not list(tmp_path.rglob("*.png"))


@SLOW
@pytest.mark.parametrize(
    "words", [("--list", "--schema"), ("--schema", "--out", "x.png"), ("--vehicle", "m113", "--list")]
)
def test_what_only_prints_stands_alone(vehicle, words):
    """No option is passed over."""
    code, output = vehicle(*words)
    assert code == 2 and "only prints, so it cannot be combined with --" in output
