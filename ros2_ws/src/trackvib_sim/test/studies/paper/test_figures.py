"""Pictures and text of `trackvib study figures` from made-up drives whose numbers are known."""

import re

import numpy as np
import pytest
from trackvib_sim.studies.case import GOOD, PROBES, Case, Drive, Result
from trackvib_sim.studies.paper.figures import CLASSES, SEED, SHOWN, SPEEDS, TRACK_PHASE, draw
from trackvib_sim.studies.paper.second_solver import Comparison

pytestmark = [pytest.mark.analytic, pytest.mark.slow(reason="draws every figure")]

PNG = b"\x89PNG\r\n\x1a\n"
FAILED = Case("C", 20.0, SEED, TRACK_PHASE)


def made_up(amplitude, line):
    """A drive of 3 s with a line [Hz] in all axes, of 1, 2 and 3 times an amplitude [m/s^2]."""
    rate = 10_000.0
    time = np.arange(1, 30_001) / rate
    wave = amplitude * np.sin(2.0 * np.pi * line * time)[:, None] * (1.0, 2.0, 3.0)
    force = {probe: wave for probe in PROBES}
    return Drive(rate, time, force, force, np.full(len(time), 10.0))


@pytest.fixture(scope="module")
def drawn(vehicle, tmp_path_factory):
    """The folder with all figures: the second solver's lines are one percent higher and 3 Hz further up."""
    folder = tmp_path_factory.mktemp("figures")
    level = {probe: (1.0, 2.0, 3.0) for probe in PROBES}
    found = {
        Case(road_class, speed, SEED, TRACK_PHASE): Result(GOOD, level, speed)
        for road_class in CLASSES
        for speed in SPEEDS
    }
    found[FAILED] = Result("failed: the vehicle has overturned after t = 1.000 s", {}, None)
    comparison = Comparison({"Rui method": made_up(1.0, 86.0), "Pinocchio": made_up(1.01, 89.0)}, 1e-14)
    names = draw(folder, vehicle, found, comparison)
    assert sorted(names) == sorted(path.name for path in folder.iterdir())
    return folder


def test_every_picture_is_drawn_and_shown(drawn):
    """Five pictures, each shown in the text; three are of the case that is drawn."""
    text = (drawn / "figures.md").read_text(encoding="utf-8")
    shown = re.findall(r"!\[(.+)\]\((.+)\)", text)
    assert len(shown) == 5
    assert all((drawn / name).read_bytes().startswith(PNG) for _, name in shown)
    assert sum(f"class {SHOWN.road_class} at {SHOWN.speed:g} m/s" in title for title, _ in shown) == 3


def test_text_gives_the_numbers_of_both_solvers(drawn):
    """RMS of a sine of amplitude a is a / sqrt(2); one percent more is +1.00%; lines stand where they are."""
    text = (drawn / "figures.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\w+) \| .+ \| ([\d.]+) \| ([\d.]+) \| \+1\.00% \|$", text, re.MULTILINE)
    expected = [(f"{k / np.sqrt(2.0):.3f}", f"{1.01 * k / np.sqrt(2.0):.3f}") for k in (1, 2, 3)]
    assert [row[1:] for row in rows] == 2 * expected
    assert [row[0] for row in rows] == 3 * ["chassis"] + 3 * ["powertrain"]
    for sensor in ("chassis", "powertrain"):
        assert f"| {sensor} | Rui method | 86 Hz | 86 Hz |" in text
        assert f"| {sensor} | Pinocchio | 89 Hz | 89 Hz |" in text
    assert "**1.0e-14**" in text


def test_text_names_runs_that_failed(drawn):
    """A run outside the valid range is named with its reason, and only that one."""
    text = (drawn / "figures.md").read_text(encoding="utf-8")
    assert re.findall(r"No values for .+", text) == [
        "No values for class C at 20 m/s: failed: the vehicle has overturned after t = 1.000 s."
    ]
