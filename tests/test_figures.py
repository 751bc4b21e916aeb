"""`trackvib study figures`, as a user calls it."""

import re
import signal
import time

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="draws four drives and their second solver")]

PNG = b"\x89PNG\r\n\x1a\n"
PICTURES = ("road.png", "histories.png", "spectra.png", "levels.png", "solvers.png")
SOLVERS_AGREE = 1e-9
LONG = 600.0  # s, a bound for what hangs


def wait_for_files(process, folder, pattern, count):
    """Wait until a folder holds as many files."""
    end = time.monotonic() + LONG
    while len(list(folder.glob(pattern))) < count:
        assert process.running and time.monotonic() < end, process.output
        time.sleep(0.1)


def test_is_interrupted_goes_on_and_draws(start_cli, tmp_path):
    """Ctrl-C keeps finished runs and leaves nothing half-written; the same command then does the rest and draws."""
    folder = tmp_path / "pictures"
    first = start_cli("study", "figures", "--out", "pictures")
    wait_for_files(first, folder / "cases", "*.json", 2)
    first.signal(signal.SIGINT)
    assert first.wait() == 130, first.output
    assert "interrupted" in first.output and "Traceback" not in first.output
    assert [path.name for path in folder.iterdir()] == ["cases"]
    kept = {path: path.stat().st_mtime_ns for path in (folder / "cases").iterdir()}
    assert 2 <= len(kept) < 15 and all(path.suffix == ".json" for path in kept)

    second = start_cli("study", "figures", "--out", "pictures")
    wait_for_files(second, folder / "cases", "*.json", 15)
    wait_for_files(second, folder, "*.png", 1)  # drawn when the second solver is done
    assert second.wait() == 0, second.output
    assert all(path.stat().st_mtime_ns == time for path, time in kept.items())
    assert sorted(path.name for path in folder.iterdir()) == sorted(("cases", "figures.md", *PICTURES))
    assert all((folder / name).read_bytes().startswith(PNG) for name in PICTURES)
    text = (folder / "figures.md").read_text(encoding="utf-8")
    assert all(f"]({name})" in text for name in PICTURES)
    assert 0.0 < float(re.search(r"largest one, was \*\*(.+?)\*\*", text)[1]) < SOLVERS_AGREE
    differences = re.findall(r"\| ([-+][\d.]+)% \|$", text, re.MULTILINE)
    # contacts amplify rounding until only the statistics of the two runs, over five seconds, agree: 6 % seen
    assert len(differences) == 6 and max(abs(float(each)) for each in differences) < 25.0


def test_refuses_in_one_line(start_cli, tmp_path):
    """A scheduler that does not answer is named in one line, exit code 1, and nothing is drawn."""
    process = start_cli("study", "figures", "--scheduler", "tcp://127.0.0.1:9")
    assert process.wait() == 1
    last = process.output.splitlines()[-1]
    assert last.startswith("error: ") and "tcp://127.0.0.1:9" in last and "Traceback" not in process.output
    assert not list(tmp_path.rglob("*.png")) and not list(tmp_path.rglob("*.md"))
