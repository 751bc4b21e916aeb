"""`trackvib mount`, as a user calls it."""

import csv

import pytest
import yaml

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="draws loops in processes of their own")]

PNG = b"\x89PNG\r\n\x1a\n"


def test_shakes_a_mount_and_fits_its_loops(start_cli, tmp_path):
    """The bench leaves table, picture and loops; the fit of these gives the vehicle's own numbers back."""
    bench = start_cli("mount", "--amplitudes", "1", "--frequencies", "8.7", "--currents", "0,1,2,4")
    assert bench.wait() == 0, bench.output
    for stiffness in ("0.904", "3.196", "5.572"):  # kN/mm, k(0), k(1 A), k(4 A)
        assert stiffness in bench.output
    folder = tmp_path / "mount"
    assert sorted(path.name for path in folder.iterdir()) == ["loops.csv", "loops.png"]
    assert (folder / "loops.png").read_bytes().startswith(PNG)
    with (folder / "loops.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4 * 1000 and {float(row["current_A"]) for row in rows} == {0.0, 1.0, 2.0, 4.0}

    fit = start_cli("mount", "fit", "mount/loops.csv", "--law", "viscoelastic", "--out", "fitted")
    assert fit.wait() == 0, fit.output
    items = yaml.safe_load((tmp_path / "fitted" / "mount_type.yaml").read_text())
    assert items["stiffness_fit"]["value"] == pytest.approx([0.0412, -0.581, 2.8317, 0.904], abs=0.01)
    assert (tmp_path / "fitted" / "fit.png").read_bytes().startswith(PNG)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--mount", "roof"), "not one of left, right"),
        (("--currents", "7"), "accepted: 0 to 4 A"),
        (("--vehicle", "m113"), "has no mounts"),
        (("--amplitudes", "0"), "0"),
        (("fit", "nowhere.csv"), "nowhere.csv"),
        (("fit", "/dev/zero"), "/dev/zero cannot be read: it is not a regular file"),
    ],
)
def test_refuses_in_one_line(start_cli, tmp_path, arguments, words):
    """And nothing is left."""
    process = start_cli("mount", *arguments)
    assert process.wait() != 0
    assert words in process.output and "Traceback" not in process.output
    assert not (tmp_path / "mount").exists()
