"""`trackvib modes`, as a user calls it."""

import re

import pytest

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="each case starts the command line")

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def modes(start_cli):
    """Run `trackvib modes` to its end, in a directory of the test: exit code and output."""

    def make(*arguments):
        process = start_cli("modes", *arguments)
        return process.wait(), process.output

    return make


@pytest.mark.slow(reason="settles a vehicle and draws")
def test_prints_a_table_and_draws(modes, tmp_path):
    """Frequencies stand in a table in ascending order, up to the limit; the picture is where it was asked for."""
    picture = tmp_path / "pictures" / "shapes.png"
    picture.parent.mkdir()
    code, output = modes("--current", 2, "--highest", 12, "--out", picture)
    assert code == 0, output
    assert "2 A in its coils" in output and "damping ratio" in output and "powertrain" in output
    oscillations = output.partition("creep")[0]
    frequencies = [float(first) for first in re.findall(r"^\W*(\d+\.\d{3})\b", oscillations, re.MULTILINE)]
    assert len(frequencies) > 5
    assert frequencies == sorted(frequencies) and frequencies[0] > 0.0 and frequencies[-1] <= 12.0
    assert picture.read_bytes().startswith(PNG)
    assert [path.name for path in tmp_path.rglob("*.png")] == ["shapes.png"]


@SLOW
def test_leaves_its_picture_where_the_user_stands(modes, tmp_path):
    """Without options it works from any directory, and its picture is there."""
    code, output = modes()
    assert code == 0, output
    assert "1 A in its coils" in output
    assert (tmp_path / "modes.png").read_bytes().startswith(PNG)


@SLOW
def test_takes_another_vehicle(modes):
    """A free powertrain has six modes of its own; a vehicle without coils has no current in them."""
    code, output = modes("--vehicle", "tao2025_free", "--highest", 30)
    assert code == 0, output
    assert len(re.findall("powertrain [89][0-9]%", output)) >= 3
    code, output = modes("--vehicle", "m113", "--highest", 5)
    assert code == 0, output
    assert "standing vehicle" in output and "coils" not in output


@SLOW
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--current", 5), ("current is 5 A", "0 to 4 A")),
        (("--out", "nowhere/modes.png"), ("nowhere/modes.png", "folder must exist")),
    ],
)
def test_refuses_in_one_line(modes, tmp_path, arguments, words):
    """A current outside the mounts' valid range and a missing folder end in one line, exit code 1 and no picture."""
    code, output = modes(*arguments)
    assert code == 1
    assert output.startswith("error: ") and output.count("\n") == 1 and output.endswith("\n")
    assert all(word in output for word in words)
    assert not list(tmp_path.rglob("*.png"))
