"""The tables of the vehicle say what its file says; what they derive from it is right."""

import re

import numpy as np
import pytest
import yaml
from trackvib_sim.data import find_vehicle
from trackvib_sim.drawings.vehicle_table import figures, longest_step, parameters
from trackvib_sim.vehicle.vehicle_file import parse_vehicle


@pytest.fixture(scope="module")
def text():
    """The shipped vehicle file."""
    return find_vehicle().read_text(encoding="utf-8")


@pytest.mark.property
def test_every_item_of_the_file_is_in_the_table(text):
    """Each has its row with value, unit and source, and nothing else has."""
    content, found = yaml.safe_load(text), parameters(text)
    assert list(found) == list(content)
    for section, items in content.items():
        assert [row.item for row in found[section]] == list(items)
        for row, item in zip(found[section], items.values(), strict=True):
            assert (row.unit, row.source, row.note) == (item["unit"], item["source"], item.get("note", ""))
            if row.value != item["value"]:  # a number, not a word
                value = np.array(yaml.safe_load(row.value), dtype=float)
                assert value == pytest.approx(np.array(item["value"], dtype=float), rel=1e-5)


@pytest.mark.property
def test_a_change_of_the_vehicle_shows(text):
    """Another mass changes its own row and the figures that follow."""
    heavier = re.sub(r"(?<=hull:\n  mass: {value: )[^,]*", "54321.0", text)
    assert parameters(heavier)["hull"][0].value == "54321" != parameters(text)["hull"][0].value
    old, new = (figures(parse_vehicle(each, "the vehicle file")) for each in (text, heavier))
    different = {was.quantity for was, now in zip(old, new, strict=True) if was != now}
    assert different >= {"mass", "centre of mass"}


@pytest.mark.analytic
def test_mass_is_the_sum(vehicle, text):
    """41 bodies and 240 shoes by hand."""
    items = {section: {row.item: row.value for row in rows} for section, rows in parameters(text).items()}
    count = {"hull": 1, "turret": 1, "gun_mount": 1, "recoil_part": 1, "powertrain": 1, "swing_arms": 12,
             "road_wheels": 12, "sprockets": 2, "carrier_rollers": 8, "idlers": 2}  # fmt: skip
    bodies = sum(number * float(items[section]["mass"]) for section, number in count.items())
    shoes = 2.0 * float(items["tracks"]["links"]) * float(items["tracks"]["shoe_mass"])
    by_name = {figure.quantity: figure for figure in figures(vehicle)}
    assert float(by_name["mass"].value) == pytest.approx((bodies + shoes) / 1e3, abs=0.006)
    assert float(by_name["length of a track"].value) == pytest.approx(vehicle.tracks.links * vehicle.tracks.pitch)


@pytest.mark.analytic
def test_longest_step_is_the_limit_of_symplectic_euler(vehicle):
    """Just below it the step's matrix for a pin between two links on a tooth keeps within 1, just above it does not."""
    t, teeth = vehicle.tracks, vehicle.sprocket_teeth
    k, c = 4.0 * t.link_stiffness + teeth.stiffness, 4.0 * t.link_damping + teeth.damping
    for factor, stable in ((1.0 - 1e-6, True), (1.0 + 1e-6, False)):
        h = factor * longest_step(vehicle)
        faster = np.array([[1.0, 0.0], [-h * k / t.shoe_mass, 1.0 - h * c / t.shoe_mass]])  # place, speed
        step = np.array([[1.0, h], [0.0, 1.0]]) @ faster
        assert (np.abs(np.linalg.eigvals(step)).max() <= 1.0) == stable


@pytest.mark.property
def test_shipped_step_is_stable(vehicle):
    """The default step is below the longest one with room to spare."""
    assert longest_step(vehicle) > 1.5e-4
