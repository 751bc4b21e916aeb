"""What a calibration is made of: objective, scaling, plan, vehicle file, history (analytic and property tests)."""

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from rich.progress import Progress
from trackvib_sim.installed import calibration_plan_file, default_vehicle_file, paper_table_file
from trackvib_sim.studies.calibration_history import Candidate, History, HistoryError
from trackvib_sim.studies.calibration_objective import FAILED, cases, objective, ratios
from trackvib_sim.studies.calibration_plan import DIGITS, Parameter, PlanError, read_plan
from trackvib_sim.studies.calibration_search import Candidates
from trackvib_sim.studies.drive import GOOD, Result
from trackvib_sim.studies.paper_table import read_table
from trackvib_sim.studies.sensitivity import sensitivity
from trackvib_sim.studies.vehicle_text import calibrated, number
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle

ROWS = [("A", 5.0), ("E", 20.0)]
ITEMS = ["tracks.pretension", "sprockets.z[0]"]
RATIOS = np.linspace(0.5, 2.0, 12).reshape(2, 6)


@pytest.fixture(scope="module")
def text():
    """The text of the vehicle file that comes with the package."""
    return read_vehicle(default_vehicle_file())[1]


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


def levels(chassis, powertrain):
    """A result with these RMS values, x, y, z of ROS."""
    return Result(GOOD, {"chassis": chassis, "powertrain": powertrain, "rigid": (9.0, 9.0, 9.0)}, 5.0)


# --- objective ---------------------------------------------------------------------------------------------------


@pytest.mark.analytic
def test_ratios_are_root_mean_squares_over_the_papers_values():
    """Root mean square over the runs of a row, in the paper's axes: X, Y, Z are x, z, y of ROS."""
    results = [levels((3.0, 2.0, 1.0), (6.0, 5.0, 4.0)), levels((4.0, 2.0, 1.0), (6.0, 5.0, 4.0))]
    found, scatter = ratios(results, {("A", 5.0): np.array([1.0, 1.0, 2.0, 3.0, 2.0, 10.0])})
    assert_allclose(found, [[np.sqrt(12.5), 1.0, 1.0, 2.0, 2.0, 0.5]])
    # only chassis X scatters: variance of log(3), log(4) is log(4/3)^2 / 2, over six columns and two runs
    assert_allclose(scatter, np.log(4.0 / 3.0) / np.sqrt(24.0))


@pytest.mark.analytic
def test_objective_by_hand():
    """All ratios e^a: rms |a|, and a bias of every column, punished twice beyond 1.05."""
    for ratio in (1.5, 1.0 / 1.5):
        assert_allclose(objective(np.full((3, 6), ratio)), np.log(1.5) + 2.0 * np.log(1.5 / 1.05))
    assert_allclose(objective(np.full((3, 6), 1.04)), np.log(1.04))  # a small bias is free


@pytest.mark.analytic
def test_objective_sees_scatter_and_bias():
    """Ratios of 2 and 1/2 in turns have no bias; in one column alone, all of them 2, a sixth of them is biased."""
    assert_allclose(objective(np.array([[2.0] * 6, [0.5] * 6])), np.log(2.0))
    one = np.ones((2, 6))
    one[:, 3] = 2.0
    assert_allclose(objective(one), np.log(2.0) / np.sqrt(6.0) + 2.0 * np.log(2.0 / 1.05) / 6.0)


@pytest.mark.analytic
def test_a_failed_run_costs_a_fixed_value():
    """One failed run makes its row count as `FAILED`, whatever the other runs gave; other rows keep their values."""
    good, bad = levels((1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), Result("failed: overturned", {}, None)
    found, _ = ratios([good, bad, good, good], dict.fromkeys(ROWS, np.ones(6)))
    assert np.isnan(found[0]).all() and (found[1] == 1.0).all()
    assert_allclose(objective(found), FAILED / np.sqrt(2.0) + 2.0 * (FAILED / 2.0 - np.log(1.05)))
    assert objective(found) < objective(np.full((2, 6), np.nan))


@pytest.mark.property
def test_cases_cover_each_row_with_own_roads_and_phases(paper):
    """Every row has its runs one after the other; seeds and phases differ within it and no phase mirrors another."""
    found = cases(paper, 3)
    assert [(case.road_class, case.speed) for case in found] == [row for row in paper for _ in range(3)]
    for k in range(0, len(found), 3):
        row = found[k : k + 3]
        assert len({case.seed for case in row}) == 3
        assert len({round(min(case.track_phase, 1.0 - case.track_phase), 6) for case in row}) == 3


# --- plan --------------------------------------------------------------------------------------------------------


@pytest.mark.property
@given(st.sampled_from(["linear", "log"]), st.floats(1e-3, 1e9), st.floats(1.1, 1e3), st.floats(0.0, 1.0))
def test_scaling_goes_round(scale, low, ratio, share):
    """A share of the range gives a value within the bounds that has that share, but for its rounding."""
    parameter = of("tracks.pretension", low, low * ratio, scale)
    value = parameter.value(share)
    assert low <= value <= low * ratio
    rounding = 10.0 ** (1 - DIGITS) * (ratio / (ratio - 1.0) if scale == "linear" else 1.0 / np.log(ratio))
    assert abs(parameter.share(value) - share) <= rounding
    assert parameter.value(parameter.share(value)) == value


@pytest.mark.property
def test_values_beyond_the_bounds_are_clipped():
    """A value outside the range has the share of the nearer bound."""
    parameter = of("sprockets.z[0]", 0.7, 0.79)
    assert [parameter.share(value) for value in (0.2, 0.7, 0.79, 5.0)] == [0.0, 0.0, 1.0, 1.0]
    assert (parameter.value(0.0), parameter.value(1.0)) == (0.7, 0.79)


@pytest.mark.property
def test_the_shipped_plan_goes_with_the_shipped_vehicle(text, vehicle, paper):
    """It uses all rows that are given, and the vehicle's values lie within its bounds."""
    plan = read_plan(calibration_plan_file(), text, paper)
    assert plan.rows == list(paper)
    assert len(plan.parameters) > 10
    assert all(parameter.low <= parameter.of(vehicle) <= parameter.high for parameter in plan.parameters)


@pytest.mark.property
@pytest.mark.parametrize(
    ("parameter", "items", "words"),
    [
        ({"item": "tracks.colour"}, {}, ("tracks.colour", "no 'colour'")),
        ({"item": "wings.area"}, {}, ("wings.area", "no 'wings'")),
        ({"item": "tracks"}, {}, ("'tracks'", "section.item")),
        ({"item": "sprockets.z"}, {}, ("sprockets.z", "list of 1", "sprockets.z[0]")),
        ({"item": "sprockets.z[1]"}, {}, ("sprockets.z[1]", "no such element")),
        ({"item": "hull.mass[0]"}, {}, ("hull.mass[0]", "no such element")),
        ({"low": 2.0, "high": 2.0}, {}, ("low is 2", "below high")),
        ({"low": -1.0}, {}, ("low is -1", "> 0", "log")),
        ({"item": "ground.friction", "low": 0.0, "scale": "linear"}, {}, ("low bounds", "ground.friction", "than 0")),
        ({"scale": "cubic"}, {}, ("scale", "'cubic'", "linear")),
        ({"high": float("nan")}, {}, ("high", "finite")),
        ({"source": ""}, {}, ("source", "at least 1")),
        ({"item": "tracks.pretension"}, {}, ("tracks.pretension", "2 times")),
        ({}, {"rows": [["B", 5]]}, ("[B, 5]", "[A, 5]")),
        ({}, {"seeds": 0}, ("seeds", "0", "greater than or equal to 1")),
        ({}, {"colour": 1}, ("colour", "not permitted")),
        ({}, {"parameters": []}, ("parameters", "at least 2")),
    ],
)
def test_a_bad_plan_gets_one_clear_error(plan_with, parameter, items, words):
    """It names file, item, value and what is accepted."""
    with pytest.raises(PlanError) as error:
        plan_with(parameter, **items)
    message = str(error.value)
    assert "plan.yaml" in message and all(word in message for word in words), message


@pytest.mark.property
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


@pytest.mark.property
def test_calibrated_file_differs_in_the_values_and_their_marks_alone(text):
    """Every other byte stays; the file is valid and has the values, sources and bounds; old notes are kept."""
    parameters = [of("tracks.pretension", 5e3, 4e4, "log"), of("hull.inertia[0]", 1.7e4, 3.2e4),
                  of("hull.inertia[2]", 6.5e4, 1.2e5), of("tyres.radial_stiffness", 1e6, 1e7, "log")]  # fmt: skip
    values = [23450.0, 17890.0, 101200.0, 4.321e6]
    new = calibrated(text, parameters, values)
    vehicle = parse_vehicle(new, "new")
    assert [parameter.of(vehicle) for parameter in parameters] == values
    pairs = list(zip(text.splitlines(), new.splitlines(), strict=True))
    changed = [pair for pair in pairs if pair[0] != pair[1]]
    assert len(changed) == 3
    assert all(old.split("{")[0] == line.split("{")[0] for old, line in changed)
    quantity = yaml.safe_load(new)
    assert quantity["tracks"]["pretension"]["source"] == "calibrated"
    assert "[0] within 17000.0 to 32000.0; [2] within 65000.0 to 1.2e+5" in quantity["hull"]["inertia"]["note"]
    before = yaml.safe_load(text)["tyres"]["radial_stiffness"]["note"]
    assert quantity["tyres"]["radial_stiffness"]["note"] == f"{before}; within 1.0e+6 to 1.0e+7"


@pytest.mark.property
def test_calibrating_again_replaces_the_bounds(text):
    """A file that has been calibrated keeps what its notes said before, and only the latest bounds."""
    wide, narrow = (of("tyres.radial_stiffness", 1e6, high) for high in (1e7, 5e6))
    again = calibrated(calibrated(text, [wide], [4e6]), [narrow], [2e6])
    assert again == calibrated(text, [narrow], [2e6])


@pytest.mark.property
def test_other_layouts_are_kept_too():
    """Block style, comments at the end of a line and quoted words are left alone."""
    item = ("value: 1.7e4  # taut", "unit: N", "source: assumed", "note: 'a \"b\"'")
    old = "\n    ".join(("tracks:  # both\n  pretension:", *item)) + "\n"
    new = calibrated(old, [of("tracks.pretension", 5e3, 4e4)], [23450.0])
    assert new == old.replace("1.7e4", "23450.0").replace("assumed", "calibrated").replace(
        "'a \"b\"'", '"a \\"b\\"; within 5000.0 to 40000.0"'
    )


@pytest.mark.property
@given(st.floats(-1e300, 1e300))
def test_numbers_read_back(value):
    """YAML reads every value as the same float."""
    assert yaml.safe_load(number(value)) == value
    assert isinstance(yaml.safe_load(number(value)), float)


# --- history -----------------------------------------------------------------------------------------------------


@pytest.fixture
def history(tmp_path):
    """A function that opens the history in the test's folder."""
    return lambda key="key": History(tmp_path / "history.csv", key, ITEMS, ROWS)


def candidate(index, objective=0.5, ratios=RATIOS):
    """A candidate of generation 2."""
    return Candidate(2, index, objective, 0.1 + 0.2, [1.0 / 3.0 + index, -0.0009], ratios)


@pytest.mark.property
def test_history_reads_back_what_was_written(history):
    """Numbers are exact, ratios to six digits; a failed row stays one; the best is the one with least objective."""
    first = history()
    failed = RATIOS.copy()
    failed[1] = np.nan
    for each in (candidate(0), candidate(1, 0.1, failed), candidate(2, 0.2)):
        first.append(each)
    again = history()
    assert [each[:5] for each in again.candidates] == [each[:5] for each in first.candidates]
    assert_allclose(again.candidates[0].ratios, RATIOS, rtol=1e-5)
    assert_allclose(again.candidates[1].ratios, failed, rtol=1e-5)
    assert again.best.index == first.best.index == 1
    assert again.find(2, 2, candidate(2).values).objective == 0.2
    assert again.find(2, 2, [1.0, 2.0]) is None and again.find(3, 0, candidate(0).values) is None


@pytest.mark.property
def test_a_line_cut_short_is_dropped(history, tmp_path):
    """After a crash in the middle of a line, what was whole is there and the next line is whole."""
    first = history()
    first.append(candidate(0))
    first.append(candidate(1))
    path = tmp_path / "history.csv"
    whole = path.read_text()
    path.write_text(whole[:-20])
    again = history()
    assert [each.index for each in again.candidates] == [0]
    again.append(candidate(1))
    assert path.read_text() == whole


@pytest.mark.property
def test_a_history_of_something_else_is_refused(history, tmp_path):
    """Another vehicle, plan or program has another key; the file is left as it was."""
    history().append(candidate(0))
    before = (tmp_path / "history.csv").read_bytes()
    with pytest.raises(HistoryError, match="history.csv.*--out"):
        history("other")
    assert (tmp_path / "history.csv").read_bytes() == before


# --- sensitivity -------------------------------------------------------------------------------------------------


@pytest.mark.analytic
def test_sensitivity_of_a_power_law(tmp_path, plan_with):
    """Ratios exp(a share) have the sensitivity a / 10; at a bound, where one side is missing, too."""
    plan = plan_with(parameters=[dict(of(item, 1.0, 2.0)) for item in ITEMS], rows=ROWS)
    slope, values = RATIOS - 1.0, [2.0, 1.6]
    history = History(tmp_path / "runs.csv", "key", plan.items, ROWS)
    for k, side, share in ((0, 0, 0.95), (0, 1, 1.0), (1, 0, 0.55), (1, 1, 0.65)):
        moved = list(values)
        moved[k] = plan.parameters[k].value(share)
        history.append(Candidate(k, side, 0.0, 0.02, moved, np.exp((k + 1) * slope * share)))
    candidates = Candidates(None, "", plan, cases(ROWS, 1), {})
    found = sensitivity(candidates, history, values, Progress(disable=True))
    assert_allclose(found.change, [0.1 * slope, 0.2 * slope], atol=1e-9)
    assert found.order.tolist() == [1, 0]
    assert_allclose(found.strength, np.sqrt(np.mean(found.change**2, axis=(1, 2))))
