"""Files that appear only when they are whole, wherever somebody else may put links (property tests)."""

import pytest
from trackvib_sim import new_files
from trackvib_sim.new_files import new_file

pytestmark = pytest.mark.property


def test_a_file_appears_only_when_it_is_whole(tmp_path):
    """While it is written, and after an error, there is what was there before and nothing else."""
    path = tmp_path / "table.csv"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError), new_file(path) as file:
        file.write(b"half")
        file.flush()
        assert path.read_text() == "old"
        1 / 0  # noqa: B018
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]
    with new_file(path) as file:
        file.write(b"new")
    assert [file.read_text() for file in tmp_path.iterdir()] == ["new"]


def test_no_link_is_followed(tmp_path, monkeypatch):
    """A link in the file's place is replaced; one under the name of the draft, if it could be guessed, is an error."""
    mine, folder = tmp_path / "mine", tmp_path / "shared"
    mine.write_text("mine")
    folder.mkdir()
    (folder / "table.csv").symlink_to(mine)
    with new_file(folder / "table.csv") as file:
        file.write(b"new")
    assert not (folder / "table.csv").is_symlink() and (folder / "table.csv").read_text() == "new"
    monkeypatch.setattr(new_files, "token_hex", lambda length: "guessed")
    (folder / "table.csv.guessed.part").symlink_to(mine)
    with pytest.raises(FileExistsError), new_file(folder / "table.csv") as file:
        file.write(b"through the link")
    assert mine.read_text() == "mine" and (folder / "table.csv").read_text() == "new"
