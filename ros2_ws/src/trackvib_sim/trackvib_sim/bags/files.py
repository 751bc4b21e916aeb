"""Which files a bag is made of."""

from pathlib import Path
from typing import NamedTuple

from mr_mount_controller.node_base.plain_text import readable

from ..yaml_text import YamlTextError, load, read_text
from .errors import BagError

METADATA = "metadata.yaml"
_SUFFIX = ".mcap"


class BagFiles(NamedTuple):
    """The files of a bag, and what its folder has else."""

    files: list  # of Path, in the order of `metadata.yaml`, or of their names
    beside: list  # names of files that `metadata.yaml` does not list: none of the bag
    absent: list  # names that it lists and that are not there

    @property
    def notes(self):
        """What is odd about them, in sentences."""
        beside, absent = (", ".join(readable(name) for name in names) for names in (self.beside, self.absent))
        return (
            *([f"not among the files that {METADATA} lists, left out: {beside}"] if beside else []),
            *([f"listed by {METADATA}, not there: {absent}"] if absent else []),
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
        return BagFiles([path], [], [])
    visible = (each for each in path.glob(f"*{_SUFFIX}") if each.is_file() and not each.name.startswith("."))
    files = sorted(visible, key=lambda each: (len(each.name), each.name))
    if not files:
        inside = path / "bag"
        hint = f"; did you mean {str(inside)!r}?" if inside.is_dir() else ""  # of a run's folder
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'is not there'}{hint}")
    there, listed = {each.name: each for each in files}, _listed(path)
    found = [there[name] for name in listed if name in there]
    if not found:  # of a bag whose files were renamed the list tells nothing
        return BagFiles(files, [], listed)
    return BagFiles(found, [name for name in there if name not in listed], [n for n in listed if n not in there])


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
