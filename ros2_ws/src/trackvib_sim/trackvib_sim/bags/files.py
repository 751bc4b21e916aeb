"""Which files a bag is made of."""

from pathlib import Path

from .writing import BagError


def bag_files(path):
    """Return the MCAP files of a bag, a folder or a single such file, in the order in which they were written.

    They are found by their names rather than by `metadata.yaml`, which a bag that was cut short does not have.

    Raises
    ------
    BagError
        There are none.
    """
    path = Path(path)
    if path.is_file():
        return [path]
    files = sorted(path.glob("*.mcap"), key=lambda each: (len(each.name), each.name))
    if not files:
        raise BagError(f"bag {str(path)!r} {'holds no .mcap file' if path.is_dir() else 'is not there'}")
    return files
