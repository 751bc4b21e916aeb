"""What a calibration is made of: objective, history, sensitivity (analytic and property tests)."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rich.progress import Progress
from trackvib_sim.data import find_vehicle, paper_table_file
from trackvib_sim.studies.calibration.history import Candidate, History, HistoryError
from trackvib_sim.studies.calibration.objective import FAILED, cases, level_cases, objective, ratios, resistance_outside
from trackvib_sim.studies.calibration.plan import Parameter, Plan
from trackvib_sim.studies.calibration.search import Candidates, attempt
from trackvib_sim.studies.calibration.sensitivity import sensitivity
from trackvib_sim.studies.case import GOOD, Result
from trackvib_sim.studies.paper.paper_table import read_table

ROWS = [("A", 5.0), ("E", 20.0)]
ITEMS = ["tracks.pretension", "sprockets.z[0]"]
RATIOS = np.linspace(0.5, 2.0, 12).reshape(2, 6)
RESISTANCE = np.array([[1.5, 1.2], [2.5, 2.0], [0.8, 0.5]])  # at the speeds of the rows and at 25 m/s


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


WITHIN = np.array([[1.2, 0.8]] * 2)  # over the low and the high end of its range


@pytest.mark.analytic
def test_objective_by_hand():
    """All ratios e^a: |a|; in one column alone, all of them 2, log(2) / sqrt(6)."""
    for ratio in (1.5, 1.0 / 1.5):
        assert_allclose(objective(np.full((3, 6), ratio), WITHIN), np.log(1.5))
    one = np.ones((2, 6))
    one[:, 3] = 2.0
    assert_allclose(objective(one, WITHIN), np.log(2.0) / np.sqrt(6.0))


@pytest.mark.analytic
def test_resistance_counts_where_it_is_outside_its_range():
    """Half the low end, or twice the high end, at one speed of two: log(2) / sqrt(2) more."""
    for one in ([0.5, 0.3], [3.0, 2.0]):
        assert_allclose(objective(np.ones((2, 6)), np.array([one, WITHIN[0]])), np.log(2.0) / np.sqrt(2.0))
    assert_allclose(resistance_outside(WITHIN), [0.0, 0.0])


@pytest.mark.analytic
def test_a_failed_run_costs_a_fixed_value():
    """One failed run makes its row count as `FAILED`, whatever the other runs gave; other rows keep their values."""
    good, bad = levels((1.0, 1.0, 1.0), (1.0, 1.0, 1.0)), Result("failed: overturned", {}, None)
    found, _ = ratios([good, bad, good, good], dict.fromkeys(ROWS, np.ones(6)))
    assert np.isnan(found[0]).all() and (found[1] == 1.0).all()
    assert_allclose(objective(found, WITHIN), FAILED / np.sqrt(2.0))
    stuck = np.array([[np.nan, np.nan], WITHIN[0]])
    assert_allclose(objective(np.ones((2, 6)), stuck), FAILED / np.sqrt(2.0))
    assert objective(found, WITHIN) < objective(np.full((2, 6), np.nan), WITHIN)


@pytest.mark.property
@pytest.mark.parametrize("pitch", ["0.2", "-1.0"])
def test_a_vehicle_that_cannot_be_built_is_a_failed_run(pitch):
    """Links too long for the running gear and a value that no vehicle file may have give a reason, not an end."""
    text = find_vehicle().read_text()
    assert "pitch: {value: 0.115," in text
    result = attempt(text.replace("pitch: {value: 0.115,", f"pitch: {{value: {pitch},"), cases(ROWS, 1)[0], 1.0)
    assert result.status.startswith("failed: ") and "tracks.pitch" in result.status and not result.rms
    assert np.isnan(attempt("nothing", level_cases(ROWS)[0], 1.0)).all()


@pytest.mark.property
def test_cases_cover_each_row_with_own_roads_and_phases():
    """Every row has its runs one after the other; seeds and phases differ within it and no phase mirrors another."""
    paper = read_table(paper_table_file())
    found = cases(paper, 3)
    assert [(case.road_class, case.speed) for case in found] == [row for row in paper for _ in range(3)]
    for k in range(0, len(found), 3):
        row = found[k : k + 3]
        assert len({case.seed for case in row}) == 3
        assert len({round(min(case.track_phase, 1.0 - case.track_phase), 6) for case in row}) == 3


@pytest.mark.property
def test_every_speed_has_a_run_on_level_ground():
    """Once, whatever the number of classes, and one at the end of the valid range."""
    assert [case.speed for case in level_cases(read_table(paper_table_file()))] == [5.0, 10.0, 20.0, 25.0]


# --- history -----------------------------------------------------------------------------------------------------


@pytest.fixture
def history(tmp_path):
    """A function that opens the history in the test's folder."""
    return lambda key="key": History(tmp_path / "history.csv", key, ITEMS, ROWS)


def candidate(index, objective=0.5, ratios=RATIOS):
    """A candidate of generation 2."""
    return Candidate(2, index, objective, 0.1 + 0.2, [1.0 / 3.0 + index, -0.0009], ratios, RESISTANCE)


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
    assert_allclose([each.resistance for each in again.candidates], [RESISTANCE] * 3, rtol=1e-5)
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
def test_sensitivity_of_a_power_law(tmp_path):
    """Ratios exp(a share) have the sensitivity a / 10; at a bound, where one side is missing, too."""
    parameters = [Parameter(item=item, low=1.0, high=2.0, scale="linear", source="a test") for item in ITEMS]
    plan = Plan(rows=ROWS, seeds=1, measuring=1.0, population=4, generations=1, step=0.2, seed=1, parameters=parameters)
    slope, values = RATIOS - 1.0, [2.0, 1.6]
    history = History(tmp_path / "runs.csv", "key", plan.items, ROWS)
    for k, side, share in ((0, 0, 0.95), (0, 1, 1.0), (1, 0, 0.55), (1, 1, 0.65)):
        moved = list(values)
        moved[k] = plan.parameters[k].value(share)
        history.append(Candidate(k, side, 0.0, 0.02, moved, np.exp((k + 1) * slope * share), RESISTANCE))
    candidates = Candidates(None, "", plan, cases(ROWS, 1), {})
    found = sensitivity(candidates, history, values, Progress(disable=True))
    assert_allclose(found.change, [0.1 * slope, 0.2 * slope], atol=1e-9)
    assert found.order.tolist() == [1, 0]
    assert_allclose(found.strength, np.sqrt(np.mean(found.change**2, axis=(1, 2))))
