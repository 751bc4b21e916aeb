"""The folder for what a command leaves: new, whole or not at all."""

import errno
from pathlib import Path

import pytest
from trackvib_sim.commands.result_folder import CommandError, all_or_nothing, whole_or_none

pytestmark = pytest.mark.property


def test_what_was_made_stays(tmp_path):
    """With all parents, and nobody writes there again."""
    with all_or_nothing(tmp_path / "a" / "b") as folder:
        (folder / "result").write_text("1")
    assert (tmp_path / "a" / "b" / "result").read_text() == "1"
    with pytest.raises(CommandError, match="already exists"), all_or_nothing(tmp_path / "a" / "b"):
        pass
    assert (tmp_path / "a" / "b" / "result").read_text() == "1"


@pytest.mark.parametrize("error", [KeyboardInterrupt(), ValueError("no"), OSError(errno.ENOSPC, "No space left")])
def test_nothing_half_done_is_left(tmp_path, error):
    """Nor the parents that were made for it; what else is there stays. A full disk is told with the folder's name."""
    (tmp_path / "old").mkdir()
    for place in (tmp_path / "new" / "b", tmp_path / "old" / "b"):
        wanted = CommandError if isinstance(error, OSError) else type(error)
        with pytest.raises(wanted) as raised, all_or_nothing(place) as folder:
            (folder / "part").write_text("1")
            raise error
        if isinstance(error, OSError):
            assert str(raised.value) == f"'{place}' cannot be written: No space left"
    assert [each.name for each in tmp_path.iterdir()] == ["old"] and not any((tmp_path / "old").iterdir())


@pytest.mark.parametrize("old", [False, True])
def test_files_take_their_names_together(tmp_path, old):
    """Only when all are whole; what was there before stays until then."""
    files = [tmp_path / name for name in ("a.txt", "b.txt")]
    if old:
        files[0].write_text("old")
    with pytest.raises(CommandError, match="No space left"), whole_or_none(*files) as (first, _):
        first.write_text("half")
        raise OSError(errno.ENOSPC, "No space left")
    assert [each.read_text() for each in tmp_path.iterdir()] == ["old"] * old
    with whole_or_none(*files) as parts:
        for part in parts:
            part.write_text("new")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.txt", "b.txt"]
    assert files[0].read_text() == "new"


def test_no_link_is_followed(tmp_path):
    """Neither one at the file's own name, which is replaced, nor any that somebody else may have put beside it."""
    other = tmp_path / "other"
    other.write_text("old")
    file, device = tmp_path / "a.txt", Path("/dev/null")
    for name in ("a.txt", ".a.txt"):
        (tmp_path / name).symlink_to(other)
    with whole_or_none(file) as (part,):
        part.write_text("new")
    assert file.read_text() == "new" and not file.is_symlink()
    assert other.read_text() == "old"
    with whole_or_none(device) as (part,):
        assert part == device
