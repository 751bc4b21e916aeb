"""`trackvib study calibrate`, as a user calls it, on a small plan."""

import csv
import signal
import time

import pytest
import yaml
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.vehicle_file import read_vehicle

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="searches over many drives")]

PICTURES = ("convergence.png", "frontier.png", "sensitivity.png")
PNG = b"\x89PNG\r\n\x1a\n"
BOUNDS = {"tracks.pretension": (1e4, 3e4), "sprockets.z": (0.72, 0.77)}
PLAN = {
    "rows": [["A", 20]],
    "seeds": 1,
    "measuring": 1.0,
    "population": 4,
    "step": 0.2,
    "generations": 2,
    "seed": 1,
    "parameters": [
        {"item": item, "low": low, "high": high, "scale": "linear", "source": "a test"}
        for item, (low, high) in BOUNDS.items()
    ],
}


@pytest.fixture
def plan(tmp_path):
    """The path of a small plan."""
    path = tmp_path / "plan.yaml"
    path.write_text(yaml.safe_dump(PLAN))
    return path


def lines(path):
    """Return the lines of a history, those of candidates in a fixed order: two workers can finish in any."""
    comment, header, *candidates = path.read_text().splitlines()
    return [comment, header, *sorted(candidates)]


def test_interrupted_and_continued_is_the_same_as_at_one_go(start_cli, tmp_path, plan):
    """Ctrl-C loses no candidate; continued and extended, the search takes the way that it takes in one go."""
    whole, parts = tmp_path / "whole", tmp_path / "parts"
    process = start_cli("study", "calibrate", "--plan", plan, "--out", whole)
    assert process.wait() == 0, process.output
    assert len(lines(whole / "history.csv")) == 2 + 1 + 2 * 4

    process = start_cli("study", "calibrate", "--plan", plan, "--out", parts, "--generations", 1)
    end = time.monotonic() + 90.0
    while not ((parts / "history.csv").exists() and len(lines(parts / "history.csv")) > 3):
        assert process.running and time.monotonic() < end, process.output
        time.sleep(0.02)
    process.signal(signal.SIGINT)
    assert process.wait() == 130, process.output
    assert "the same command continues" in process.output
    kept = lines(parts / "history.csv")[2:]
    assert 2 <= len(kept) < 9 and not (parts / "calibration.md").exists()

    process = start_cli("study", "calibrate", "--plan", plan, "--out", parts)
    assert process.wait() == 0, process.output
    assert set(kept) <= set(lines(parts / "history.csv"))
    assert lines(parts / "history.csv") == lines(whole / "history.csv")
    for name in ("vehicle.yaml", "sensitivity.csv"):
        assert (parts / name).read_bytes() == (whole / name).read_bytes()

    check_files(whole)


def check_files(folder):
    """The vehicle has the values of the candidate that rolls most easily, of those within 5 % of the least objective;
    report, pictures and table of sensitivities are there."""
    with (folder / "history.csv").open() as file:
        candidates = list(csv.DictReader(file.readlines()[1:]))
    least = min(float(line["objective"]) for line in candidates)
    alike = [line for line in candidates if float(line["objective"]) <= 1.05 * least]
    best = min(alike, key=lambda line: float(line["resistance_20_over_high"]) * float(line["resistance_25_over_high"]))
    assert yaml.safe_load((folder / "values.yaml").read_text()) == {item: float(best[item]) for item in BOUNDS}
    vehicle, text = read_vehicle(folder / "vehicle.yaml")
    assert vehicle.tracks.pretension == [float(best["tracks.pretension"])] * 2
    assert vehicle.sprockets.z == float(best["sprockets.z"])
    pairs = zip(find_vehicle().read_text().splitlines(), text.splitlines(), strict=True)
    assert sum(old != new for old, new in pairs) == 2
    for item, (low, high) in BOUNDS.items():
        assert low <= float(best[item]) <= high
        assert f"`{item}`" in (folder / "calibration.md").read_text()
    with (folder / "sensitivity.csv").open() as file:
        table = list(csv.reader(file))
    assert [line[0] for line in table] == ["item", *BOUNDS] and {len(line) for line in table} == {1 + 6}
    assert all((folder / name).read_bytes().startswith(PNG) for name in PICTURES)


def test_refuses_in_one_line(start_cli, tmp_path, plan):
    """A bad plan and a folder with another calibration end in one line, exit code 1, and leave everything as it is."""
    bad = tmp_path / "bad.yaml"
    bad.write_text(plan.read_text().replace("sprockets.z", "sprockets.zz"))
    taken = tmp_path / "taken"
    taken.mkdir()
    (taken / "history.csv").write_text("# something else\n")
    calls = (
        (("--plan", bad, "--out", "new"), ("bad.yaml", "sprockets.zz")),
        (("--plan", plan, "--out", "taken"), ("history.csv", "another", "--out")),
        (("--plan", plan, "--vehicle", "none.yaml", "--out", "new"), ("none.yaml", "cannot be read")),
        (("--plan", plan, "--scheduler", "tcp://127.0.0.1:9", "--out", "fresh"), ("127.0.0.1:9", "scheduler")),
    )
    for arguments, words in calls:
        process = start_cli("study", "calibrate", *arguments)
        assert process.wait() == 1, process.output
        assert process.output.startswith("error: ") and process.output.count("\n") == 1, process.output
        assert all(word in process.output for word in words), process.output
    assert not (tmp_path / "new").exists()
    assert (taken / "history.csv").read_text() == "# something else\n"
