"""A calibration's plan, and its values in the text of a vehicle file (property tests)."""

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.data import calibration_plan_file, find_vehicle, paper_table_file
from trackvib_sim.studies.calibration.plan import DIGITS, Parameter, PlanError, read_plan
from trackvib_sim.studies.calibration.vehicle_text import calibrated_vehicle_text, number
from trackvib_sim.studies.paper.paper_table import read_table
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle

pytestmark = pytest.mark.property


@pytest.fixture(scope="module")
def text():
    """The text of the vehicle file that comes with the package."""
    return read_vehicle(find_vehicle())[1]


@pytest.fixture(scope="module")
def paper():
    """The rows of the paper's table that are given."""
    return read_table(paper_table_file())


@pytest.fixture
def plan_with(tmp_path, text, paper):
    """A function that reads the shipped plan with two parameters, and some items or some of the first one changed."""

    def read(parameter=None, **items):
        content = yaml.safe_load(calibration_plan_file().read_text())
        content["parameters"] = [dict(of("hull.mass", 1e4, 3e4, "log")), dict(of("tracks.pretension", 5e3, 4e4))]
        content["parameters"][0].update(parameter or {})
        content.update(items)
        path = tmp_path / "plan.yaml"
        path.write_text(yaml.safe_dump(content))
        return read_plan(path, text, paper)

    return read


def of(item, low, high, scale="linear"):
    """A parameter."""
    return Parameter(item=item, low=low, high=high, scale=scale, source="a test")


# --- plan --------------------------------------------------------------------------------------------------------


@given(st.sampled_from(["linear", "log"]), st.floats(1e-3, 1e9), st.floats(1.1, 1e3), st.floats(0.0, 1.0))
def test_scaling_goes_round(scale, low, ratio, share):
    """A share of the range gives a value within the bounds that has that share, but for its rounding."""
    parameter = of("tracks.pretension", low, low * ratio, scale)
    value = parameter.value(share)
    assert low <= value <= low * ratio
    rounding = 10.0 ** (1 - DIGITS) * (ratio / (ratio - 1.0) if scale == "linear" else 1.0 / np.log(ratio))
    assert abs(parameter.share(value) - share) <= rounding
    assert parameter.value(parameter.share(value)) == value


def test_values_beyond_the_bounds_are_clipped():
    """A value outside the range has the share of the nearer bound."""
    parameter = of("sprockets.z", 0.7, 0.79)
    assert [parameter.share(value) for value in (0.2, 0.7, 0.79, 5.0)] == [0.0, 0.0, 1.0, 1.0]
    assert (parameter.value(0.0), parameter.value(1.0)) == (0.7, 0.79)


def test_the_shipped_plan_goes_with_the_shipped_vehicle(text, vehicle, paper):
    """It uses all rows that are given, and the vehicle's values lie within its bounds."""
    plan = read_plan(calibration_plan_file(), text, paper)
    assert plan.rows == list(paper)
    assert len(plan.parameters) > 10
    assert all(parameter.low <= parameter.of(vehicle) <= parameter.high for parameter in plan.parameters)


@pytest.mark.parametrize(
    ("parameter", "items", "words"),
    [
        ({"item": "tracks.colour"}, {}, ("tracks.colour", "no 'colour'")),
        ({"item": "wings.area"}, {}, ("wings.area", "no 'wings'")),
        ({"item": "tracks"}, {}, ("'tracks'", "section.item")),
        ({"item": "hull.centre"}, {}, ("hull.centre", "list of 3", "hull.centre[0]")),
        ({"item": "hull.centre[3]"}, {}, ("hull.centre[3]", "no such element")),
        ({"item": "hull.mass[0]"}, {}, ("hull.mass[0]", "no such element")),
        ({"low": 2.0, "high": 2.0}, {}, ("low is 2", "below high")),
        ({"low": -1.0}, {}, ("low is -1", "> 0", "log")),
        ({"low": 5e-324}, {}, ("low is 4.94066e-324", "at least 1.7e-304", "log")),
        ({"item": "ground.friction", "low": 0.0, "scale": "linear"}, {}, ("low bounds", "ground.friction", "than 0")),
        ({"scale": "cubic"}, {}, ("scale", "'cubic'", "linear")),
        ({"high": float("nan")}, {}, ("high", "finite")),
        ({"source": ""}, {}, ("source", "at least 1")),
        ({"item": "tracks.pretension"}, {}, ("tracks.pretension", "2 times")),
        ({}, {"rows": [["B", 5]]}, ("[B, 5]", "[A, 5]")),
        ({}, {"rows": [["\x1b" + "x" * 5000, 5]]}, ("[\\x1bx", "xxx ... xxx", "[A, 5]")),
        ({}, {"seeds": 0}, ("seeds", "0", "greater than or equal to 1")),
        ({}, {"colour": 1}, ("colour", "unknown item; accepted:")),
        ({}, {"parameters": []}, ("parameters", "at least 2")),
    ],
)
def test_a_bad_plan_gets_one_clear_error(plan_with, parameter, items, words):
    """It names file, item, value and what is accepted."""
    with pytest.raises(PlanError) as error:
        plan_with(parameter, **items)
    message = str(error.value)
    assert "plan.yaml" in message and all(word in message for word in words), message


@pytest.mark.parametrize("content", [b"rows: [", b"\xff\xfe", b"7", b""])
def test_what_is_no_plan_is_refused(tmp_path, text, paper, content):
    """Files that are not YAML, not text or not a plan, and a missing one, are named in the error."""
    path = tmp_path / "plan.yaml"
    path.write_bytes(content)
    with pytest.raises(PlanError, match="plan.yaml"):
        read_plan(path, text, paper)
    with pytest.raises(PlanError, match="nowhere.yaml.*cannot be read"):
        read_plan(tmp_path / "nowhere.yaml", text, paper)


# --- vehicle file ------------------------------------------------------------------------------------------------


def test_calibrated_file_differs_in_the_values_and_their_marks_alone(text):
    """Every other byte stays; the file is valid and has the values, sources and bounds; old notes are kept."""
    parameters = [of("tracks.pretension", 5e3, 4e4, "log"), of("hull.inertia[0]", 1.7e4, 3.2e4),
                  of("hull.inertia[2]", 6.5e4, 1.2e5), of("mount_types.mr.carried_mass", 500.0, 2e3)]  # fmt: skip
    values = [23450.0, 17890.0, 101200.0, 1234.0]
    new = calibrated_vehicle_text(text, parameters, values)
    vehicle = parse_vehicle(new, "new")
    assert [parameter.of(vehicle) for parameter in parameters] == values
    pairs = list(zip(text.splitlines(), new.splitlines(), strict=True))
    changed = [pair for pair in pairs if pair[0] != pair[1]]
    assert len(changed) == 3
    assert all(old.split("{")[0] == line.split("{")[0] for old, line in changed)
    quantity = yaml.safe_load(new)
    assert quantity["tracks"]["pretension"]["source"] == "calibrated"
    assert "[0] within 17000.0 to 32000.0; [2] within 65000.0 to 1.2e+5" in quantity["hull"]["inertia"]["note"]
    before = yaml.safe_load(text)["mount_types"]["mr"]["carried_mass"]["note"]
    assert quantity["mount_types"]["mr"]["carried_mass"]["note"] == f"{before}; within 500.0 to 2000.0"


def test_calibrating_again_replaces_the_bounds(text):
    """A file that has been calibrated keeps what its notes said before, and only the latest bounds."""
    wide, narrow = (of("tyres.radial_stiffness", 1e6, high) for high in (1e7, 5e6))
    again = calibrated_vehicle_text(calibrated_vehicle_text(text, [wide], [4e6]), [narrow], [2e6])
    assert again == calibrated_vehicle_text(text, [narrow], [2e6])


def test_other_layouts_are_kept_too():
    """Block style, comments at the end of a line and quoted words are left alone."""
    item = ("value: 1.7e4  # taut", "unit: N", "source: assumed", "note: 'a \"b\"'")
    old = "\n    ".join(("tracks:  # both\n  pretension:", *item)) + "\n"
    new = calibrated_vehicle_text(old, [of("tracks.pretension", 5e3, 4e4)], [23450.0])
    assert new == old.replace("1.7e4", "23450.0").replace("assumed", "calibrated").replace(
        "'a \"b\"'", '"a \\"b\\"; within 5000.0 to 40000.0"'
    )


@given(st.floats(-1e300, 1e300))
def test_numbers_read_back(value):
    """YAML reads every value as the same float."""
    assert yaml.safe_load(number(value)) == value
    assert isinstance(yaml.safe_load(number(value)), float)
