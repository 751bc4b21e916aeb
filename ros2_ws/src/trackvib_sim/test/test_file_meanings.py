"""Every item of the files that users write has a meaning in its schema, for editors and documents."""

import pytest
from trackvib_sim.road_sources.road_file import RoadFile
from trackvib_sim.vehicle.drive.drive_file import DriveFile
from trackvib_sim.vehicle.parameters import Vehicle

pytestmark = pytest.mark.property


@pytest.mark.parametrize("model", [Vehicle, RoadFile, DriveFile])
def test_every_item_has_a_meaning(model):
    """A phrase of its own that ends in a full stop; sections that are classes have their docstrings."""
    schema, count = model.model_json_schema(), 0
    for name, section in {**schema["$defs"], "the whole file": schema}.items():
        assert section["description"], name
        for item, each in section.get("properties", {}).items():
            told = each.get("description", "")
            is_section = "$ref" in str(each)
            assert is_section or (told.endswith(".") and len(told) > 4), f"{name}.{item}"
            count += not is_section
    assert count > 4
