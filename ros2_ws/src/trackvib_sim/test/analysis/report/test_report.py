"""The report without a browser: valid HTML, all in one file, nothing from a bag but text, bags set side by side."""

import re
from pathlib import Path

import html5lib
import numpy as np
import pytest
from plotly.offline import get_plotlyjs
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.report import bag_figures, facts
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.report_data import build_report_data

from ..hostile_recordings import SCRIPT, hostile_report_data
from ..made_recordings import made_recording

HTML = "{http://www.w3.org/1999/xhtml}"
LIBRARY = get_plotlyjs()


@pytest.fixture(scope="module", params=[1, 3])
def hostile_page(request, tmp_path_factory):
    """The report on one hostile bag, or on three, as text without Plotly's own."""
    path = tmp_path_factory.mktemp("report") / "report.html"
    write_report([hostile_report_data(str(number)) for number in range(request.param)], path)
    return _own(path)


@pytest.fixture
def report(tmp_path):
    """A function that returns the report on recordings, as text without Plotly's own."""

    def make(*recordings):
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.html"
        write_report([build_report_data(recording, analyse(recording)) for recording in recordings], path)
        return _own(path)

    return make


def _own(path):
    text = path.read_text(encoding="utf-8")
    assert text.count(LIBRARY) == 1
    return text.replace(LIBRARY, "")


def _tree(text):
    return html5lib.HTMLParser(strict=True).parse(text)  # raises what a browser would have to guess


def _words(text):
    return " ".join(" ".join(_tree(text).find(f"{HTML}body").itertext()).split())


@pytest.mark.property
def test_bag_brings_no_elements_into_the_page(hostile_page):
    """The only scripts are the page's own, no element handles events, and hostile words stand there as words."""
    tree = _tree(hostile_page)
    nonces = {script.get("nonce") for script in tree.iter(f"{HTML}script")}
    assert len(list(tree.iter(f"{HTML}script"))) == 2 and len(nonces) == 1
    assert f"script-src 'nonce-{nonces.pop()}'" in tree.find(f".//{HTML}meta[@http-equiv]").get("content")
    for element in tree.iter():
        assert str(element.tag).removeprefix(HTML) not in ("img", "iframe", "object", "link")
        assert not any(name.startswith("on") for name, _ in element.items())
    assert hostile_page.count("window.injected") > 5
    texts = ["".join(each.itertext()) for each in tree.iter(f"{HTML}td")]
    assert SCRIPT in texts


@pytest.mark.property
def test_page_needs_nothing_from_elsewhere(hostile_page):
    """No element refers to anything outside, and the style loads nothing."""
    tree = _tree(hostile_page)
    targets = [value for element in tree.iter() for name, value in element.items() if name in ("src", "href", "srcset")]
    assert targets and all(target.startswith("#") for target in targets)
    ids = {element.get("id") for element in tree.iter()}
    assert {target[1:] for target in targets} <= ids
    style = "".join(each.text for each in tree.iter(f"{HTML}style"))
    assert "prefers-color-scheme: dark" in style and not re.search(r"url\(|@import", style)
    assert "</script" not in LIBRARY.lower()


@pytest.mark.property
def test_reports_are_small(hostile_page):
    """With Plotly's 5 MB, three bags stay far below 15."""
    assert len(hostile_page) + len(LIBRARY) < 10e6


@pytest.mark.property
def test_what_stands_there_is_overwritten_never(tmp_path):
    """The file that was there is as it was."""
    path = tmp_path / "report.html"
    path.write_text("mine")
    with pytest.raises(FileExistsError):
        write_report([hostile_report_data()], path)
    assert path.read_text() == "mine"


@pytest.mark.property
def test_report_of_sensors_alone(report):
    """A bag without mounts, answers, odometry, parameters and vehicle is reported, and says what it lacks."""
    lacking = dict.fromkeys(("mounts", "answers", "odometry", "vehicle"))
    words = _words(report(made_recording(np.arange(1, 4001))._replace(**lacking, provenance={})))
    for absent in (
        "no odometry in the recording",
        "no mount_state in the recording",
        "no coil_current in the recording",
        "unknown",
    ):
        assert absent in words
    assert "Numbers" in words and "force over deflection" not in words
    assert "bag, 4 s" in words and not re.search(r"\bnan\b|unanswered", words)
    assert words.count("no odometry") == 1


@pytest.mark.property
def test_levels_along_a_bag_without_speed():
    """Of a long bag the levels are drawn, without an empty figure of the speed."""
    whole = made_recording(np.arange(1, 31_001))
    for recording, drawn in ((whole, 3), (whole._replace(odometry=None), 2)):
        assert len(bag_figures.levels(build_report_data(recording, analyse(recording))).data) == drawn


@pytest.mark.property
def test_gaps_are_told(report):
    """Each gap stands in the table, and the notes say so at the top."""
    time = np.delete(np.arange(1, 10_001), slice(4999, 5249))
    words = _words(report(made_recording(time)))
    assert "chassis/imu: gaps: 1, in which 250 samples are missing" in words
    assert "chassis/imu 4.999 0.251 250" in words


@pytest.mark.property
@pytest.mark.parametrize(
    ("told", "words"),
    [
        ({"late": "0", "state": "finished"}, "nothing lost, nothing late, every sample answered"),
        ({"late": "3", "saturated": "2"}, "Loop: 3 late, 2 saturated."),
        ({"late": "0", "state": "failed"}, "Loop: the run failed."),
        ({}, "Loop: the recording does not contain the simulator's counters."),
    ],
)
def test_loop_health_stands_at_the_top(report, told, words):
    """What went wrong in the loop is said, and that nothing did only if that is known."""
    assert words in _words(report(made_recording(np.arange(1, 4001))._replace(diagnostics=told)))


@pytest.mark.property
def test_without_answers_in_the_bag_none_is_claimed(report):
    """Neither that every sample was answered nor that one was not."""
    words = _words(report(made_recording(np.arange(1, 4001))._replace(answers=None)))
    assert "Loop: nothing lost, nothing late. no coil_current in the recording" in words and "unanswered" not in words


@pytest.mark.slow(reason="a long recording")
@pytest.mark.analytic
def test_heat_in_the_mounts_is_that_of_their_samples(report):
    """5 W in each mount from 2 s on: gaps of the sensors, over which less counts, do not change it."""
    time = np.arange(1, 10_001)
    whole = made_recording(time)
    holed = made_recording(np.delete(time, slice(4999, 5249)))._replace(mounts=whole.mounts)
    for recording in (whole, holed):
        assert "dissipated in the mounts 80.0 J 10.0 W on average" in _words(report(recording))


@pytest.mark.slow(reason="long recordings")
@pytest.mark.property
@pytest.mark.parametrize(("samples", "thinned"), [(8000, False), (8001, True)])
def test_thinning_is_told_where_lines_are_thinned(report, samples, thinned):
    """The caption of the histories speaks of long bags only below those of one."""
    page = report(made_recording(np.arange(1, samples + 1)))
    assert ("For long recordings the least" in _words(page)) == thinned


@pytest.mark.property
def test_reduction_is_that_of_the_sensors(report):
    """The powertrain with half the chassis's accelerations has 50 % less."""
    words = _words(report(made_recording(np.arange(1, 4001))))
    assert words.count("−50.0 % against the chassis") == 4


@pytest.mark.property
def test_bags_are_compared_with_the_first(report):
    """Twice the acceleration is +100 % in every number of acceleration, and only what differs is listed."""
    one = made_recording(np.arange(1, 4001))._replace(path=Path("runs/one/bag"))
    other = made_recording(np.arange(1, 4001), chassis=2.0 * one.chassis.specific_force)
    parameters = {**one.provenance, "parameters of /controller": {"law": "skyhook"}}
    words = _words(report(one, other._replace(path=Path("runs/two/bag"), provenance=parameters)))
    assert words.count("(+100.0 %)") == 5 * 6 + 8 + 6 * 6  # quantities with totals, and lines
    assert words.count("crest factor (peak / RMS), weighted") == 1 and "(–)" not in words
    assert "controller law unknown skyhook" in words and "simulator speed 10.0 10.0" not in words
    assert "In brackets: difference from one." in words


@pytest.mark.property
@pytest.mark.parametrize(
    ("paths", "names"),
    [
        (["runs/a/bag"], ["a/bag"]),
        (["runs/a/bag", "runs/b/bag"], ["a", "b"]),
        (["/x/a/bag", "/x/a/bag_epoch_2"], ["bag", "bag_epoch_2"]),
        (["bag", "bag"], ["bag (1)", "bag (2)"]),
        (["/x/bag", "y/bag"], ["/x", "y"]),
        (["."], ["/".join(Path.cwd().parts[-2:])]),
    ],
)
def test_names_are_what_paths_do_not_share(paths, names):
    """Short, and no two alike."""
    assert facts.names(paths) == names
