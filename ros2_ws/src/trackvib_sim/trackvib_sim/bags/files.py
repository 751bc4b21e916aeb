"""Which files a bag is made of."""

from pathlib import Path

from mr_mount_controller.node_base.plain_text import readable

from .errors import BagError


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
    files = sorted(filter(Path.is_file, path.glob("*.mcap")), key=lambda each: (len(each.name), each.name))
    if not files:
        inside = path / "bag"
        hint = f"; did you mean {str(inside)!r}?" if inside.is_dir() else ""  # of a run's folder
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'is not there'}{hint}")
    return files


def called(path):
    """Return what to call a bag in a title: its name, with that of the run's folder before `bag`."""
    parts = Path(path).resolve().parts
    return readable("/".join(parts[-2:]) if parts[-1] == "bag" else parts[-1])
