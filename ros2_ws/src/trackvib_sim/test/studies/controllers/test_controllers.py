"""The controller study: its scenarios on the vehicle, its table, report and picture, and that it goes on."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from mr_mount_controller.laws import find_law
from rich.progress import Progress
from trackvib_sim.commands import study_cli
from trackvib_sim.studies.case_store import CaseStore
from trackvib_sim.studies.controllers.picture import controllers_picture
from trackvib_sim.studies.controllers.report import report
from trackvib_sim.studies.controllers.scenario import (
    GOOD,
    PASSIVE,
    QUANTITIES,
    SCENARIOS,
    ControlCase,
    ControlResult,
    control,
)
from trackvib_sim.studies.controllers.study import GRID, cases, controllers
from trackvib_sim.studies.controllers.table import JUDGED, Row, best_by_others, gain, table_csv, table_rows, verdict
from trackvib_sim.studies.run_missing import run_missing

BUMP = ControlCase("bump", 1, 0.3, PASSIVE)


def made_up():
    """Results of one scenario: constant currents at which all quantities are the current, and a law at 0.8 of 0.7."""
    found = {}
    for case in cases(["skyhook"], ["e10", "run_up"], 2):
        value = case.seed * (case.current if case.law == PASSIVE else 0.56)
        found[case] = ControlResult(GOOD, dict.fromkeys(QUANTITIES, value))
    return found


@pytest.mark.slow(reason="drives every scenario")
@pytest.mark.property
@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_gives_every_quantity(vehicle, name):
    """Finite and positive; with passive mounts the current is the one held, and nothing is lost by switching."""
    result = control(vehicle, ControlCase(name, 1, 0.3, PASSIVE))
    assert result.status == GOOD
    assert list(result.levels) == list(QUANTITIES)
    assert result.levels.pop("switching") == 0.0
    assert all(0.0 < value < 1e3 for value in result.levels.values())
    assert result.levels["current"] == pytest.approx(1.0, abs=1e-9)
    assert result.levels["powertrain_high"] < result.levels["powertrain"]


@pytest.mark.slow(reason="drives a scenario for each part")
@pytest.mark.property
@pytest.mark.parametrize("change", [{"law": "skyhook"}, {"current": 2.0}, {"track_phase": 0.6}])
def test_every_part_of_a_case_reaches_the_result(vehicle, change):
    """Law, constant current and phase of the tracks change the level; the same case gives the same bits."""
    one, again, other = (control(vehicle, case) for case in (BUMP, BUMP, replace(BUMP, **change)))
    assert one == again
    assert abs(other.levels["powertrain"] / one.levels["powertrain"] - 1.0) > 1e-4


@pytest.mark.property
def test_a_vehicle_that_cannot_roll_is_a_result(changed):
    """The reason is kept, and there are no levels."""
    failed = control(changed("driver", heading_gain=1e12), BUMP)
    assert failed.status.startswith("failed: the vehicle cannot roll") and failed.levels == {}


@pytest.mark.property
def test_cases_are_laws_and_constant_currents():
    """Each on the same roads; what does not vary is done once; the command knows the same scenarios."""
    wanted = cases(["skyhook", "hybrid"], ["e10", "run_up"], 3)
    assert len(wanted) == len(set(wanted)) == (3 + 1) * (2 + len(GRID))
    assert {case.seed for case in wanted if case.scenario == "run_up"} == {1}
    assert tuple(SCENARIOS) == study_cli.SCENARIOS


@pytest.mark.property
def test_no_seed_judges_its_own_choice():
    """Of two rows that win by chance on one seed each, the others choose the third."""
    levels = {"a": (0.1, 1.0, 1.0), "b": (1.0, 0.1, 1.0), "c": (0.6, 0.6, 0.6)}
    rows = [Row("e10", name, None, {"force": np.array(each)}, []) for name, each in levels.items()]
    # without the first seed b has the least, without the second a, without the third both have as little
    assert best_by_others(rows, "force").tolist() == [1.0, 1.0, 1.0]
    assert best_by_others(rows[2:], "force").tolist() == [0.6, 0.6, 0.6]
    single = [row._replace(levels={"force": row.levels["force"][:1]}) for row in rows]
    assert best_by_others(single, "force").tolist() == [0.1]


@pytest.mark.property
def test_verdict_compares_each_seed_with_itself():
    """A law at 0.56 against 1 and 0.7: 44 % and 20 % at every seed, without scatter though levels differ by two."""
    rows = table_rows(made_up())
    found = verdict(rows)
    assert len(found) == 2 * len(JUDGED)
    for each in found:
        assert (each.current, each.law) == (0.7, "skyhook")
        scatter = 0.0 if each.scenario == "e10" else np.nan  # of one run there is none
        for ours, expected in ((each.constant_gain, 30.0), (each.law_gain, 44.0), (each.over_best, 20.0)):
            assert ours == pytest.approx((expected, scatter), abs=1e-9, nan_ok=True)
            assert ours.text() == (f"{expected:+.1f} ± 0.0 *" if each.scenario == "e10" else f"{expected:+.1f}")
        assert each.chance == pytest.approx(100.0 * np.std((2.5, 3.0, 3.5, 4.0), ddof=1) / 3.25)
    worse = gain(*(row.levels["force"] for row in (next(row for row in rows if row.current == 2.0), rows[0])))
    assert worse.mean < -100.0


@pytest.mark.property
def test_a_failed_run_leaves_its_row_without_verdict():
    """It is told in report and table, and what is left is compared."""
    found = made_up()
    first = next(iter(found))
    found[first] = ControlResult("failed: it fell", {})
    rows = table_rows(found)
    assert not [each for each in verdict(rows) if each.scenario == first.scenario]
    assert "* skyhook: failed: it fell" in report(rows, 2, "my.yaml", "text")
    lines = list(csv.DictReader(table_csv(rows).splitlines()))
    assert len(lines) == len(rows)
    assert [(line["law"], line["force"]) for line in lines if line["status"] != GOOD] == [("skyhook", "")]
    assert {float(line["force"]) for line in lines if line["constant_current"] == "2"} == {2.0, 3.0}


@pytest.mark.property
def test_report_and_picture_can_be_made(tmp_path):
    """The report has vehicle, verdict, what is above the band, and all rows."""
    rows = table_rows(made_up())
    text = report(rows, 2, "my.yaml", "text of the vehicle")
    assert "`my.yaml`, SHA-256 `" in text
    gains = "+30.0 ± 0.0 * | `skyhook` | +44.0 ± 0.0 * | +20.0 ± 0.0 * | 19.9"
    assert f"| class E, 10 m/s | `powertrain` | 0.7 | {gains} |" in text
    assert "| class E, 10 m/s | 1.50 | 100 % | 0.840 to 6.00 | 0.840 to 6.00 |" in text
    assert text.count("| `skyhook` |") == 2 * len(JUDGED) + 2
    controllers_picture(rows, tmp_path / "controllers.png")
    assert (tmp_path / "controllers.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")


@pytest.mark.property
def test_a_changed_law_makes_results_void(tmp_path, monkeypatch):
    """The hash of the controllers covers the file of a law that comes from elsewhere."""
    file = tmp_path / "law_from_elsewhere.py"
    file.write_text("from mr_mount_controller.laws.base import ControlLaw\nclass Law(ControlLaw):\n    pass\n")
    monkeypatch.syspath_prepend(tmp_path)
    law = find_law("law_from_elsewhere:Law")
    before = controllers([law])
    assert before == controllers([law]) != controllers([])
    file.write_text(file.read_text() + "# changed\n")
    assert controllers([law]) != before


@pytest.mark.slow(reason="starts worker processes")
@pytest.mark.system
def test_only_missing_cases_are_done(vehicle, tmp_path):
    """Workers give what a run in this process gives; a second call needs none."""
    wanted = [BUMP, replace(BUMP, law="skyhook")]
    store = CaseStore(tmp_path, "text", ControlCase, ControlResult)
    with Progress(disable=True) as progress:
        found = run_missing(vehicle, wanted, store, None, progress, "runs", control)
        assert found[BUMP] == control(vehicle, BUMP)
        before = {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()}
        assert len(before) == 2
        assert run_missing(vehicle, wanted, store, "tcp://127.0.0.1:1", progress, "runs", control) == found
        assert {file.name: file.stat().st_mtime_ns for file in tmp_path.iterdir()} == before
    assert np.isfinite(list(found[BUMP].levels.values())).all()
