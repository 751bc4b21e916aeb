"""`trackvib study controllers`, as a user calls it."""

import csv

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="drives every scenario")]

SMALL = ("--scenarios", "bump", "--laws", "skyhook", "--seeds", 1)  # twelve runs


@pytest.fixture
def controllers(start_cli):
    """Start `trackvib study controllers`."""
    return lambda *arguments: start_cli("study", "controllers", *arguments)


def test_leaves_table_report_and_picture(controllers, tmp_path):
    """A law beside the constant currents; again with what is there already, no worker is needed."""
    run = controllers(*SMALL)
    assert run.wait() == 0, run.output
    folder = tmp_path / "controllers"
    with (folder / "controllers.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 12 and {row["status"] for row in rows} == {"ok"}
    assert [row["law"] for row in rows if not row["constant_current"]] == ["skyhook"]
    assert "| `skyhook` |" in (folder / "controllers.md").read_text()
    assert (folder / "controllers.png").read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    table = (folder / "controllers.csv").read_bytes()
    again = controllers(*SMALL, "--scheduler", "tcp://127.0.0.1:1")
    assert again.wait() == 0, again.output
    assert (folder / "controllers.csv").read_bytes() == table


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--laws", "skyhok"), ("error:", "'skyhok'", "acceleration_driven", "package.module:Class")),
        (("--laws", "nowhere:Law"), ("error:", "'nowhere:Law'", "cannot be loaded")),
        (("--scenarios", "e10,moon"), ("--scenarios", "'moon'", "'e10', 'c20', 'run_up', 'bump'")),
        (("--seeds", "0"), ("--seeds", "0", "1 to 1000")),
        (("--vehicle", "none.yaml"), ("error: vehicle file 'none.yaml' cannot be read",)),
        (("--scheduler", "tcp://127.0.0.1:1"), ("error: no Dask scheduler answers at 'tcp://127.0.0.1:1'",)),
    ],
)
def test_bad_input_is_refused(controllers, tmp_path, arguments, words):
    """The error names the item, its value and what is accepted; nothing is run or left half done."""
    run = controllers(*arguments)
    assert run.wait() in (1, 2)
    output = " ".join(run.output.split())
    assert all(word in output for word in words), run.output
    assert "Traceback" not in output
    assert not (tmp_path / "controllers").exists()
