"""What the comparison of several bags sets side by side: vehicles, times, and what one of them lacks."""

import json

import numpy as np
import pytest
from markupsafe import escape
from plotly.offline import get_plotlyjs
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.report import comparison_tables
from trackvib_sim.analysis.report.differences import differing
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.report_data import build_report_data
from trackvib_sim.analysis.report.sections import of_several
from trackvib_sim.analysis.report.tables import number

from ..hostile_recordings import SCRIPT, hostile_report_data
from ..made_recordings import made_recording

NAMES = ("one", "other")


@pytest.fixture(scope="module")
def whole():
    """4 s of noise."""
    return made_recording(np.arange(1, 4001))


@pytest.fixture(scope="module")
def differences(whole):
    """A function that returns what differs between runs that had some vehicle files."""
    analysis = analyse(whole)

    def find(*texts):
        return differing([build_report_data(whole._replace(vehicle=text), analysis) for text in texts])

    return find


def _cells(tables):
    """Numbers by title and name of their row."""
    return {(table.head[0], row[0]): row[1:] for table in tables for row in table.rows}


@pytest.mark.property
def test_vehicles_are_compared_item_by_item(whole, differences):
    """By their values and units; notes, sources and the order of the items change no run."""
    mass, heavier = "mass: {value: 18000.0, unit: kg,", "mass: {value: 18300.0, unit: kg,"
    assert mass in whole.vehicle
    row = ("vehicle", "hull.mass", "18000.0 kg", "18300.0 kg")
    assert differences(whole.vehicle, whole.vehicle.replace(mass, heavier, 1)) == [row]
    assert differences(whole.vehicle, whole.vehicle.replace("source: assumed", "source: published")) == []
    assert differences("a: {b: {c: 1}, d: 2}", "a: {d: 2, b: {e: [3, 4]}}") == [
        ("vehicle", "a.b.c", "1", "unknown"),
        ("vehicle", "a.b.e", "unknown", "[3, 4]"),
    ]


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        (None, "unknown"),
        ("", "unknown"),
        ("a: [", "not a YAML file with sections"),
        ("a: 2001-99-99", "not a YAML file with sections"),
        ("nothing but words", "not a YAML file with sections"),
        ("a: &a {b: *a}", "not a YAML file with sections"),
        ("a: !!bool x", "not a YAML file with sections"),
        (f"a: 0x{'f' * 5000}", "not a YAML file with sections"),
        ("[" * 5000, "not a YAML file with sections"),
    ],
)
def test_vehicle_file_that_cannot_be_read_is_one_row(differences, text, words):
    """It says so, and the other ones are compared all the same; of files that are all alike there is nothing to say."""
    rows = [("vehicle", "file", "there", words, "there"), ("vehicle", "a", "1", "–", "2")]
    assert differences("a: 1", text, "a: 2") == rows
    assert differences(text, text) == []


@pytest.mark.slow(reason="a whole report")
@pytest.mark.property
def test_vehicle_files_bring_no_elements(differences, tmp_path):
    """Their names and values are words in a table like all else, whatever they say."""
    text = json.dumps({SCRIPT: {"value": 1, "unit": SCRIPT}})
    assert differences("a: 1", text)[1:] == [("vehicle", SCRIPT, "unknown", f"1 {SCRIPT}")]
    report_data_list = [hostile_report_data("one"), hostile_report_data("other")._replace(vehicle=text)]
    write_report(report_data_list, tmp_path / "report.html")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert f"<td>{escape('1 ' + SCRIPT)}</td>" in page and "<img" not in page.replace(get_plotlyjs(), "")


@pytest.mark.property
def test_numbers_that_grow_with_time_are_not_compared_in_silence(whole):
    """Where less time counts, the doses say over which; of heat it is the mean power that is compared."""
    longer = analyse(made_recording(np.arange(1, 6001)))
    first = analyse(whole)
    same, different = (comparison_tables.accelerations([first, other], NAMES) for other in (first, longer))
    assert ("vibration dose value, weighted (VDV), m/s¹·⁷⁵", *NAMES) in [table.head for table in same]
    head = ("vibration dose value, weighted (VDV), m/s¹·⁷⁵, grows with time", "one, over 2 s", "other, over 4 s")
    assert [table.head for table in different if table.head[0].startswith("vibration dose value")] == [head]
    mounts = _cells(comparison_tables.mounts([first, longer], NAMES))
    assert mounts["left mount, vertical", "power dissipated, mean, W"] == ("5.000", "5.000 (+0.0 %)")
    assert not any(row.endswith(", J") for _, row in mounts)


@pytest.mark.property
def test_missing_numbers_are_dashes(whole):
    """A number without a first one stands alone, and there is a dash for none, without another in brackets."""
    full, bare = analyse(whole), analyse(whole._replace(mounts=None, odometry=None))
    frequency = number(full.lines[0].frequency)
    for pair, expected in (((full, bare), (frequency, "–")), ((bare, full), ("–", frequency))):
        cells = _cells(comparison_tables.lines(pair, NAMES))
        assert cells["link passing 1", "frequency, Hz"] == expected
        assert cells["link passing 1", "chassis z"].count("–") == 1
        assert all("(" not in "".join(cells) for cells in _cells(comparison_tables.mounts(pair, NAMES)).values())


@pytest.mark.slow(reason="a whole report")
@pytest.mark.property
def test_comparison_has_all_that_a_report_on_one_bag_has(whole):
    """Every quantity, the levels about lines, coherence, and the stamps of each bag."""
    found = build_report_data(whole, analyse(whole))
    sections = {section.title: section for section in of_several([found, found], NAMES)}
    heads = [table.head[0] for table in sections["Numbers"].tables]
    for words in (
        "RMS, raw",
        "crest factor",
        "greatest RMS over 1 s",
        "vibration dose value",
        "peak",
        "mean",
        "left mount",
        "right mount",
    ):
        assert any(head.startswith(words) for head in heads), words
    lines = [table.head[0] for table in sections["Link passing and engine orders"].tables]
    assert lines == [line.name for line in found.analysis.lines] and len(lines) == 6
    titles = [figure.layout.title.text for figure in sections["From chassis to powertrain"].figures]
    assert len(titles) == 6 and titles[5] == "Coherence, vertical z"
    assert [table.head[0] for table in sections["Stamps"].tables] == list(NAMES)
