"""What the report of the table study says, and that its picture can be drawn, from rows made by hand."""

import numpy as np
import pytest
from trackvib_sim.studies.case import GOOD
from trackvib_sim.studies.paper.paper_table import Row
from trackvib_sim.studies.paper.predictions import Prediction
from trackvib_sim.studies.paper.table1_picture import table_picture
from trackvib_sim.studies.paper.table1_report import report

pytestmark = pytest.mark.property

PAPER = {("A", 5.0): np.array([2.0, 4.0, 1.0, 1.0, 1.0, 1.0])}
NOTHING = np.full(6, np.nan)
PREDICTIONS = [Prediction("trackvib", 2.0, np.nan), Prediction("power of the speed, 12 numbers", 1.1, 1.2)]
ROWS = [
    Row("A", 5.0, 2.0 * PAPER["A", 5.0], np.full(6, 0.25), np.array([4.0, 6.0, 1.0]), GOOD),
    Row("B", 5.0, np.ones(6), np.zeros(6), np.ones(3), "1 of 2 outside the valid range: it fell"),
    Row("H", 20.0, NOTHING, NOTHING, NOTHING[:3], "outside the valid range: it flew"),
]


@pytest.fixture
def lines():
    """The report's lines."""
    return report(ROWS, PAPER, 2, PREDICTIONS, "my.yaml", "text of the vehicle").splitlines()


def test_report_says_what_was_run(lines):
    """Band, seeds, vehicle file with hash, version."""
    head = " ".join(lines[:15])
    for words in ("0.5-500 Hz", "2 seeds", "`my.yaml`, SHA-256 `", "trackvib_sim ", "2100 r/min"):
        assert words in head


def test_report_sets_rows_beside_the_papers(lines):
    """Twice the paper's values: factor and biases are 2, and every cell shows both."""
    cells = "4.00 ± 0.25 (2.00) | 8.00 ± 0.25 (4.00) | 2.00 ± 0.25 (1.00) | " + "2.00 ± 0.25 (1.00) | " * 3
    assert f"| A | 5 | {cells}2.000 | ok |" in lines
    assert f"| B | 5 | {'1.00 ± 0.00 | ' * 6} | {ROWS[1].status} |" in lines
    assert f"| H | 20 | {'- | ' * 6} | {ROWS[2].status} |" in lines
    assert "Partly or wholly outside the valid range: class B at 5 m/s, H at 20 m/s." in lines
    assert "| trackvib | 2.000 | - |" in lines and "| power of the speed, 12 numbers | 1.100 | 1.200 |" in lines
    assert any("over the 1 common rows: **2.000**" in line for line in lines)
    assert f"| bias, geometric mean of ours / paper | {' | '.join(['2.000'] * 6)} |" in lines


def test_report_sets_reductions_beside_the_rigid_baseline(lines):
    """4 to 2, by a rigid mount 4 to 4, in the paper 2 to 1; and so on for the two other axes."""
    assert "| A | 5 | 50.0 | 0.0 | 50.0 | 75.0 | 25.0 | 75.0 | 0.0 | 50.0 | 0.0 |" in lines
    assert "| B | 5 | 0.0 | 0.0 |  | 0.0 | 0.0 |  | 0.0 | 0.0 |  |" in lines
    assert not any(line.startswith("| H | 20 |") and "outside" not in line for line in lines)


@pytest.mark.parametrize("rows", [ROWS, ROWS[:1], ROWS[2:]], ids=["all", "one", "none that is good"])
def test_picture_of_any_choice_can_be_drawn(tmp_path, rows):
    """Several speeds, one, and nothing but a failed row."""
    table_picture(rows, PAPER, 2, tmp_path / "table1.png")
    assert (tmp_path / "table1.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
