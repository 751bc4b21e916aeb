"""README and docs/credibility.md tell the figures that other documents take from commands, the bad ones too."""

import re
from decimal import ROUND_HALF_UP, Decimal

import pytest

from .documents import ROOT, renew

pytestmark = pytest.mark.literature


def page(name):
    """Return the words of a document, with single blanks between them."""
    return " ".join((ROOT / name).read_text(encoding="utf-8").split())


def printed(name):
    """Return what the one command of a document prints, as rows of cells."""
    blocks = renew.blocks((ROOT / "docs" / name).read_text(encoding="utf-8"))
    (content,) = (block.content for block in blocks if block.kind == "output")
    return [[cell.strip() for cell in line.strip("│").split("│")] for line in content.splitlines() if "│" in line]


def row(name, first):
    """Return the cells behind the first one of a row."""
    return next(cells[1:] for cells in printed(name) if cells[0] == first)


def rounded(cell):
    """Return a number of a cell with two decimals, a half upwards as by hand."""
    return str(Decimal(cell).quantize(Decimal("0.01"), ROUND_HALF_UP))


def ratios(cells):
    """Return ours over theirs of each cell, and whether it is beyond its goal."""
    numbers = [re.findall(r"[\d.]+", cell) for cell in cells]
    return [(float(ours) / float(theirs), "!" in cell) for (ours, theirs), cell in zip(numbers, cells, strict=True)]


def test_table_of_the_paper():
    """Error factors of the vehicle and of both null models, fitted and left out."""
    models = ("trackvib", "mean of each speed, 18 numbers", "power of the speed, 12 numbers")
    (ours, left_out), mean, power = ([rounded(cell) for cell in row("studies.md", name)] for name in models)
    text = page("docs/credibility.md")
    assert f"error factor {ours}; {left_out} for classes left out of the fit" in text
    assert f"18 numbers | error factor {mean[0]}; {mean[1]} left out" in text
    assert f"12 numbers | error factor {power[0]}; {power[1]} left out" in text
    assert f"an error factor of {ours} over the nine rows; a power of the speed has {power[0]}" in page("README.md")


def test_independent_code():
    """Levels, lines and correlations of the M113, and how many of them are within their goals."""
    levels = [ratio for ratio, _ in ratios(row("m113.md", "100-500 Hz"))]
    lines = [ratios(row("m113.md", f"line {number}")) for number in (1, 2, 3)]
    slow, fast = (sum(not beyond for each in lines for _, beyond in each[part]) for part in (slice(2), slice(2, 4)))
    octaves = [beyond for cells in printed("m113.md") if cells[0].startswith("octave/3")
               for _, beyond in ratios(cells[1:])]  # fmt: skip
    first = [ratio for ratio, _ in lines[0][2:]]
    correlation = [re.search(r"[\d.]+", cell)[0] for cell in row("m113.md", "correlation") if cell]
    text = page("docs/credibility.md")
    for words in (
        f"{len(octaves) - sum(octaves)} of {len(octaves)} within 1.4",
        f"at 5 m/s | {slow} of 6 within the goal",
        f"at 10 m/s | {fast} of 6 within the goal, the first {min(first):.1f} to {max(first):.1f} times theirs",
        f"low-frequency motion | {correlation[0]} and {correlation[1]} |",
    ):
        assert words in text, words
    front = page("README.md")
    # the study knows more digits than the table shows
    told = [float(number) for number in re.search(r"four cases \| ([\d.]+) to ([\d.]+) times theirs", text).groups()]
    assert told == pytest.approx([min(levels), max(levels)], abs=0.011)
    assert f"are {100 * (told[0] - 1):.0f} to {100 * (told[1] - 1):.0f} % high" in front
    worst = max(max(ratio, 1.0 / ratio) for each in lines for ratio, _ in each)
    assert f"are off by up to {worst:.1f} times" in front


def test_running_resistance():
    """Force over the higher of both formulas."""
    forces = {cells[0]: (float(cells[1]), float(cells[5].split(",")[0]))
              for cells in printed("resistance.md") if cells[0] in ("5", "10", "20")}  # fmt: skip
    low, high, fast = (ours / formula for ours, formula in (forces["10"], forces["5"], forces["20"]))
    words = f"{low:.2f} to {high:.2f} times the higher one up to 10 m/s, {fast:.1f} times at 20 m/s"
    assert words in page("docs/credibility.md")


def test_what_control_gains():
    """The best law beside the best constant current on class E, as the study wrote it."""
    table = (ROOT / "docs" / "controllers" / "controllers.md").read_text(encoding="utf-8")
    gains = {}
    for quantity in ("powertrain_wk", "powertrain"):
        found = re.search(rf"^\| class E, 10 m/s \| `{quantity}` \|.*\| ([^|]+) \| [^|]+ \|$", table, re.MULTILINE)
        gains[quantity] = found[1].removesuffix(" *").lstrip("+")
    front = page("README.md")
    assert f"by {gains['powertrain_wk']} % against the best constant current" in front
    assert f"by {gains['powertrain']} %" in front


def test_named_tests_and_programs_are_there():
    """A path that the page gives to `test`, or a program, exists; verdicts are of the three kinds."""
    text = (ROOT / "docs" / "credibility.md").read_text(encoding="utf-8")
    paths = re.findall(r"(?:test|python) ((?:ros2_ws|docs|bench)/[\w/.]+)", text)
    assert len(paths) > 10
    for path in paths:
        assert (ROOT / path).exists(), path
    verdicts = [line.rstrip("| ").rsplit("| ", 1)[1] for line in text.splitlines() if line.startswith("| ")]
    told = [verdict for verdict in verdicts if verdict not in ("verdict", "---")]
    assert len(told) > 25
    for verdict in told:
        assert re.match(r"(the same$|does better|agrees|holds|\*\*(fails|limited)\*\*)", verdict), verdict
