"""`trackvib analyze` with bad input, as a real process: one line that names what is wrong, and nothing is left."""

import pytest

pytestmark = pytest.mark.system


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["missing", "--out", "new"], ["'missing' is not there"]),
        (["empty", "--out", "new"], ["'empty' holds no .mcap file"]),
        (["text.mcap", "--out", "new"], ["'text.mcap' cannot be read"]),
        (["empty", "--out", "empty"], ["'empty' exists already"]),
        (["empty", "--out", "text.mcap/new"], ["'text.mcap/new' cannot be made"]),
        (["empty", "--settle", "-1"], ["--settle", "-1"]),
        ([], ["BAG..."]),
    ],
)
def test_bad_input_is_refused(start_cli, tmp_path, arguments, words):
    """Bags that are none, folders that are there or cannot be, options out of range."""
    (tmp_path / "empty").mkdir()
    (tmp_path / "text.mcap").write_text("no bag at all, but some text")
    before = sorted(tmp_path.iterdir())
    analyze = start_cli("analyze", *arguments)
    assert analyze.wait() != 0
    output = " ".join(analyze.output.split())
    assert all(word in output for word in words) and "Traceback" not in output, output
    assert not (tmp_path / "new").exists() and set(before) <= set(tmp_path.iterdir())
