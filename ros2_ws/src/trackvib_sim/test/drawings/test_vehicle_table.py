"""The tables of the vehicle say what its file says; what they derive from it is right."""

import re

import numpy as np
import pytest
import yaml
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.drawings.vehicle_table import figures, parameters
from trackvib_sim.vehicle.body_tree import GRAVITY, build_body_table
from trackvib_sim.vehicle.mounts import mount_turn
from trackvib_sim.vehicle.standing import standing
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle


@pytest.fixture(scope="module")
def text():
    """The shipped vehicle file."""
    return find_vehicle().read_text(encoding="utf-8")


@pytest.mark.property
@pytest.mark.parametrize("name", vehicle_names())
def test_every_item_of_the_file_is_in_the_table(name):
    """Each has its row with value, unit and source, however deep it stands, and nothing else has."""
    text = find_vehicle(name).read_text(encoding="utf-8")
    rows = {(section, row.item): row for section, items in parameters(text).items() for row in items}
    seen = set()
    for path, item in leaves(yaml.safe_load(text)):
        row = rows[".".join(path[:-1]) or "vehicle", path[-1]]
        seen.add(id(row))
        if not isinstance(item, dict):
            assert row[1:] == (str(item), "", "", "")
            continue
        assert row[2:] == (item["unit"], item["source"], item.get("note", ""))
        if row.value != item["value"]:  # a number, not a word
            value = np.array(yaml.safe_load(row.value), dtype=float)
            assert value == pytest.approx(np.array(item["value"], dtype=float), rel=1e-5)
    assert seen == {id(row) for row in rows.values()}


def leaves(content, path=()):
    """Yield path and content of every quantity and bare word of a file."""
    for name, each in content.items():
        if isinstance(each, dict) and "value" not in each:
            yield from leaves(each, (*path, name))
        else:
            yield (*path, name), each


@pytest.mark.property
def test_tables_of_files_of_the_format_before():
    """Their sections are listed as they stand in the file."""
    text = (
        "hull:\n  mass: {value: 1.0e3, unit: kg, source: assumed}\n"
        "coil:\n  model: {value: lag, unit: '-', source: assumed}\n"
    )
    found = parameters(text)
    assert {section: [row.value for row in rows] for section, rows in found.items()} == {
        "hull": ["1000"],
        "coil": ["lag"],
    }


@pytest.mark.property
def test_a_change_of_the_vehicle_shows(text):
    """Another mass changes its own row and the figures that follow."""
    heavier = re.sub(r"(?<=hull:\n  mass: {value: )[^,]*", "21098.0", text)
    assert parameters(heavier)["hull"][0].value == "21098" != parameters(text)["hull"][0].value
    old, new = (figures(parse_vehicle(each, "the vehicle file")) for each in (text, heavier))
    different = {was.quantity for was, now in zip(old, new, strict=True) if was != now}
    assert different >= {"mass", "centre of mass"}


@pytest.mark.analytic
def test_mass_is_the_sum(vehicle, text):
    """41 bodies and 240 shoes by hand."""
    items = {section: {row.item: row.value for row in rows} for section, rows in parameters(text).items()}
    count = {"hull": 1, "bodies.turret": 1, "bodies.gun_mount": 1, "bodies.recoil_part": 1, "powertrain": 1,
             "swing_arms": 12, "road_wheels": 12, "sprockets": 2, "carrier_rollers": 8, "idlers": 2}  # fmt: skip
    bodies = sum(number * float(items[section]["mass"]) for section, number in count.items())
    shoes = 2.0 * float(items["tracks"]["links"]) * float(items["tracks"]["shoe_mass"])
    by_name = {figure.quantity: figure for figure in figures(vehicle)}
    assert float(by_name["mass"].value) == pytest.approx((bodies + shoes) / 1e3, abs=0.006)
    length = vehicle.tracks.links[0] * vehicle.tracks.pitch
    assert float(by_name["length of a track"].value) == pytest.approx(length)


@pytest.mark.property
def test_sides_that_differ_are_told_apart(vehicle):
    """Staggered wheels and another pretension on the right show as two values; those of the shipped vehicle as one."""
    arms = vehicle.swing_arms
    staggered = arms.model_copy(update={"right_wheel_x": [x + 0.05 for x in arms.wheel_x]})
    other = vehicle.model_copy(update={"swing_arms": staggered})
    for each, words in ((vehicle, 0), (other, 1)):
        rows = {figure.quantity: figure.value for figure in figures(each)}
        for quantity in ("loads of the road wheels", "travel of the tensioners"):
            assert rows[quantity].count("right") == words


@pytest.mark.analytic
@pytest.mark.parametrize("name", vehicle_names())
def test_ground_carries_the_weight(name):
    """Loads of all road wheels sum up to the weight of the bodies and of what hangs on them of the tracks."""
    vehicle, _ = read_vehicle(find_vehicle(name))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    weight = GRAVITY * sum(body.mass for body in build_body_table(vehicle)) + system.supports.upper_weight.sum()
    assert standing(vehicle).wheel.sum() == pytest.approx(weight, rel=1e-6)


@pytest.mark.analytic
def test_free_powertrain_is_carried_by_its_mounts():
    """The parts of the mounts' loads along the vertical sum up to its weight."""
    vehicle, _ = read_vehicle(find_vehicle("tao2025_free"))
    loads = standing(vehicle).mount
    carried = sum((mount_turn(mount) @ loads[name])[2] for name, mount in vehicle.mounts.items())
    assert carried == pytest.approx(vehicle.powertrain.mass * GRAVITY, rel=1e-4)  # the hull leans a little
