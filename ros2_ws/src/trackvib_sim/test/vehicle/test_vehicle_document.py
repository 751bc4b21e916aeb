"""docs/vehicle.md says what the vehicle file says; what the table derives from it is right."""

import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from trackvib_sim.data import default_vehicle_file
from trackvib_sim.drawings.vehicle_table import figures, longest_step, parameters, renewed

DOCUMENT = Path(__file__).parents[5] / "docs" / "vehicle.md"
MARKS = "<!-- figures -->\nold\n<!-- /figures -->\n<!-- parameters -->\nold\n<!-- /parameters -->\n"


@pytest.fixture(scope="module")
def text():
    """The shipped vehicle file."""
    return default_vehicle_file().read_text(encoding="utf-8")


@pytest.mark.property
def test_document_is_up_to_date(text):
    """Its tables are those of the shipped vehicle; `python -m trackvib_sim.analysis.vehicle_table` renews them."""
    document = DOCUMENT.read_text(encoding="utf-8")
    assert renewed(document, text) == document


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
    """Another mass changes its own row and the figures that follow, and nothing around the tables."""
    document = renewed(f"before\n{MARKS}after\n", text)
    heavier = renewed(document, re.sub(r"(?<=hull:\n  mass: {value: )[^,]*", "54321.0", text))
    assert "| mass | 54321 | kg |" in heavier and "| mass | 54321 | kg |" not in document
    different = [pair for pair in zip(document.splitlines(), heavier.splitlines(), strict=True) if pair[0] != pair[1]]
    assert {old.split(" | ")[0] for old, _ in different} >= {"| mass", "| centre of mass"}
    assert heavier.startswith("before\n<!-- figures -->\n| quantity |")
    assert heavier.endswith("<!-- /parameters -->\nafter\n")


@pytest.mark.property
@pytest.mark.parametrize("name", ["figures", "parameters"])
def test_missing_marks_are_named(text, name):
    """A document without the place for a table is refused with the mark that is missing."""
    with pytest.raises(ValueError, match=f"<!-- {name} -->.* stands 0 times, must be once"):
        renewed(MARKS.replace(f"<!-- /{name} -->", ""), text)


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
