"""Which files a bag is made of."""

from pathlib import Path

from mr_mount_controller.node_base.plain_text import readable

from .errors import BagError
from .opening import how_to_convert

_FOLDED = (".zstd", ".zst")  # behind the name of a file that is compressed as a whole
_SUFFIXES = (".mcap", *(f".mcap{folded}" for folded in _FOLDED))


def bag_files(path):
    """Return the MCAP files of a bag, a folder or a single such file, in the order in which they were written.

    They are found by their names rather than by `metadata.yaml`, which a bag that was cut short does not have.

    Raises
    ------
    BagError
        There are none, or it cannot be found out.
    """
    try:
        return _files(Path(path))
    except OSError as error:  # a name that is too long, a folder that is another user's
        raise BagError(f"bag {str(path)!r} cannot be read: {error.strerror}") from None


def _files(path):
    if path.is_file():
        return [path]
    found = {each.name: each for suffix in _SUFFIXES for each in path.glob(f"*{suffix}") if each.is_file()}
    # a player that unfolded a file left it beside
    files = [each for name, each in found.items() if not any(f"{name}{folded}" in found for folded in _FOLDED)]
    files.sort(key=lambda each: (len(each.name), each.name))
    if not files:
        inside = path / "bag"
        hint = f"; did you mean {str(inside)!r}?" if inside.is_dir() else ""  # of a run's folder
        if any(each.suffix in (".db3", ".bag") for each in path.glob("*.*")):
            hint = f"; {how_to_convert(path)}"
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'is not there'}{hint}")
    return files


def called(path):
    """Return what to call a bag in a title: its name, with that of the run's folder before `bag`."""
    parts = Path(path).resolve().parts
    return readable("/".join(parts[-2:]) if parts[-1] == "bag" else parts[-1])


def unfolded(file):
    """Return the path of a file of a bag (a Path) as it is called without its compression as a whole."""
    return file.with_suffix("") if file.suffix in _FOLDED else file
