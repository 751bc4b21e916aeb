"""The report on bags of a drive: sections along the way, by speed, of orders and Campbell diagrams."""

import html5lib
import numpy as np
import pytest
from plotly.offline import get_plotlyjs
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.report import order_figures, speed_figures, tables
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.report_data import build_report_data
from trackvib_sim.analysis.report.sections import of_one, of_several

from ..made_recordings import driven, made_recording

MILLISECONDS = np.arange(1, 20_001)
DRIVE = ("By distance", "By speed", "Engine orders", "Campbell diagrams")


def speed(time):
    """From 4 to 12 m/s."""
    return 4.0 + 8.0 * time / 20.0


@pytest.fixture(scope="module")
def drives():
    """A run-up in one gear, and the same without a recorded drive and at a steady speed."""
    made = made_recording(MILLISECONDS)
    driving = driven(made, speed, lambda time: 180.0 * speed(time))
    return [build_report_data(each, analyse(each)) for each in (driving, made._replace(path="steady"))]


@pytest.mark.slow(reason="reports of whole drives")
@pytest.mark.property
def test_a_drive_has_its_sections_and_a_steady_run_has_not(drives):
    """By speed, orders and Campbell diagrams only where a speed varies; the way is always there."""
    driving, steady = ([section.title for section in of_one(each)] for each in drives)
    assert [title for title in driving if title in DRIVE] == list(DRIVE)
    assert [title for title in steady if title in DRIVE] == ["By distance"]
    compared = [section.title for section in of_several(drives, ["a", "b"])]
    assert [title for title in compared if title in DRIVE] == list(DRIVE[:3])


@pytest.mark.property
def test_figures_and_tables_show_the_numbers(drives):
    """What is drawn is what the analysis says."""
    analysis = drives[0].analysis
    rms = speed_figures.by_speed(analysis).data[0]
    assert list(rms.x[::2]) == [band.low for band in analysis.by_speed]
    assert list(rms.y[1::2]) == [band.rms["chassis"]["z"] for band in analysis.by_speed]
    assert len(tables.by_speed(analysis).rows) == len(analysis.by_speed) > 2
    assert tables.accelerations(analysis).rows[-1][0] == "absorbed power"
    maps = order_figures.of_sensors(analysis)
    assert len(maps) == 4 and maps[0].data[0].z.shape == (
        len(analysis.order_spectra.order),
        len(analysis.order_spectra.engine_speed),
    )
    level = next(each for each in analysis.order_levels if each.order == 3.0)
    line = next(trace for trace in maps[3].data if trace.name == "order 3")
    assert line.y[0] == level.rms["powertrain"]["z"]
    diagrams = order_figures.campbells(analysis)
    assert len(diagrams) == 4
    for diagram in diagrams:
        rays = [trace for trace in diagram.data[1:] if trace.mode == "lines"]
        assert len(rays) == 6  # three of link passing, three orders
        assert all(np.isfinite(ray.y).all() and ray.y[1] > ray.y[0] for ray in rays)
        names = [trace.text[0] for trace in diagram.data[1:] if trace.mode == "text"]
        assert len(set(names)) == len(names) and any("order 6" in name for name in names)


@pytest.mark.slow(reason="reports of whole drives")
@pytest.mark.property
@pytest.mark.parametrize("count", [1, 2])
def test_page_is_valid(drives, tmp_path, count):
    """Valid HTML with a link to each section."""
    write_report(drives[:count], tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8").replace(get_plotlyjs(), "")
    html5lib.HTMLParser(strict=True).parse(text)
    assert all(f">{title}</a>" in text for title in DRIVE[:3])
