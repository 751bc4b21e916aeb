"""Which files a bag is made of."""

from pathlib import Path
from typing import NamedTuple

from mr_mount_controller.node_base.plain_text import readable

from ..yaml_text import YamlTextError, load, read_text
from .errors import BagError
from .mcap_walk import has_records
from .opening import how_to_convert
from .unfolding import ZSTD_MAGIC

_FOLDED = (".zstd", ".zst")  # behind the name of a file that is compressed as a whole
_SUFFIXES = (".mcap", *(f".mcap{folded}" for folded in _FOLDED))

METADATA = "metadata.yaml"


class BagFiles(NamedTuple):
    """The files of a bag, and what its folder has else."""

    files: list  # of Path, in the order of `metadata.yaml`, or of their names
    beside: list  # names of files that `metadata.yaml` does not list: none of the bag
    absent: list  # names that it lists and that are not there
    unreadable: list  # of Path: splits that are empty or no MCAP

    @property
    def notes(self):
        """What is odd about them, in sentences."""
        unreadable = [each.name for each in self.unreadable]
        beside, absent, unreadable = (
            ", ".join(readable(name) for name in names) for names in (self.beside, self.absent, unreadable)
        )
        return (
            *([f"not listed in {METADATA}, left out: {beside}"] if beside else []),
            *([f"listed in {METADATA}, missing: {absent}"] if absent else []),
            *([f"empty or not MCAP, left out: {unreadable} (`trackvib bag repair` renames it)"] if unreadable else []),
        )


def bag_files(path):
    """Return the MCAP files of a bag; see `find_files`."""
    return find_files(path).files


def find_files(path):
    """Return the `BagFiles` of a bag, a folder or a single MCAP file.

    Where `metadata.yaml` lists files that are there, these are the bag, in its order. A bag that was cut short has no
    such list: its files are found by their names. Hidden files, as other systems leave them beside, are never meant.

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
        return BagFiles([path], [], [], [])
    found = (each for suffix in _SUFFIXES for each in path.glob(f"*{suffix}") if each.is_file())
    there = {each.name: each for each in found if not each.name.startswith(".")}
    # a player that unfolded a file left it beside
    files = [each for name, each in there.items() if not any(f"{name}{folded}" in there for folded in _FOLDED)]
    files.sort(key=lambda each: (len(each.name), each.name))
    if not files:
        inside = path / "bag"
        hint = f"; did you mean {str(inside)!r}?" if inside.is_dir() else ""  # of a run's folder
        if any(each.suffix in (".db3", ".bag") for each in path.glob("*.*")):
            hint = f"; {how_to_convert(path)}"
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'does not exist'}{hint}")
    listed = _listed(path)
    found, beside = [there[name] for name in listed if name in there], sorted(there.keys() - listed)
    if not found:  # of a bag whose files were renamed the list tells nothing
        found, beside = files, []
    sound = [each for each in found if len(found) == 1 or _is_mcap(each)] or found  # of all alike the first is named
    absent = [name for name in listed if name not in there]
    return BagFiles(sound, beside, absent, [each for each in found if each not in sound])


def _is_mcap(file):
    with file.open("rb") as stream:
        return stream.read(len(ZSTD_MAGIC)) == ZSTD_MAGIC or has_records(stream)


def _listed(path):
    """Return the names of files in the folder that its metadata list; none where nothing readable does."""
    try:
        told = load(read_text(path / METADATA), METADATA)["rosbag2_bagfile_information"]["relative_file_paths"]
        # early versions put the folder's name before them; a list may not lead elsewhere
        return list(dict.fromkeys(Path(each).name for each in told))
    except (YamlTextError, KeyError, TypeError, IndexError, ValueError):
        return []


def called(path):
    """Return what to call a bag in a title: its name, with that of the run's folder before `bag`."""
    parts = Path(path).resolve().parts
    return readable("/".join(parts[-2:]) if parts[-1] == "bag" else parts[-1])


def unfolded(file):
    """Return the path of a file of a bag (a Path) as it is called without its compression as a whole."""
    return file.with_suffix("") if file.suffix in _FOLDED else file
