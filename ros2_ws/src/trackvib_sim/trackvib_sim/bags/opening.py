"""Opens the files of a bag: MCAP, as it stands or compressed as a whole; of other formats the way to it is said."""

from contextlib import contextmanager
from tempfile import TemporaryFile

from .errors import BagError
from .limits import largest_record, too_large
from .unfolding import ZSTD_MAGIC, unfolded_parts, zstd_claim

_GREATEST_RATIO = 250  # of a file's bytes to those that it has compressed; what is recorded does not come near
_HEAD = 64  # bytes, of which the first ones tell what a file is
_OTHERS = {b"#ROSBAG V": "a bag of ROS 1", b"SQLite format 3": "a bag in sqlite3"}


def most_unfolded(size):
    """Return how many bytes a compressed file of `size` bytes may hold, all together."""
    return max(largest_record(), _GREATEST_RATIO * size)


def how_to_convert(path):
    """Return in words how a bag in another format becomes one that is read."""
    return (
        f"convert it first: ./trackvib exec -- rosbags-convert --src {path} --dst NEW_FOLDER --dst-storage mcap "
        "--dst-typestore ros2_jazzy"
    )


@contextmanager
def opened(file):
    """Open a file of a bag (a Path) for the reading of MCAP's bytes; compressed ones are unfolded to a temporary file.

    Raises
    ------
    BagError
        It is a bag in another format.
    TooLarge
        It claims, or holds, far more than its compressed bytes.
    OSError, zstandard.ZstdError
        It cannot be read, or unfolded.
    """
    with file.open("rb") as stream:
        head = stream.read(_HEAD)
        for magic, kind in _OTHERS.items():
            if head.startswith(magic):
                raise BagError(f"{str(file)!r} is {kind}; {how_to_convert(file)}")
        stream.seek(0)
        if not head.startswith(ZSTD_MAGIC):
            yield stream
            return
        with TemporaryFile() as whole:
            _unfold(stream, whole, file, head)
            yield whole


def _unfold(stream, whole, file, head):
    """Write what a compressed file holds, as far as it goes, within bounds."""
    most = most_unfolded(file.stat().st_size)
    size = zstd_claim(head) or 0
    if size > most:
        raise too_large(f"{file.name!r}, decompressed,", size)
    for part in unfolded_parts(stream):
        size = whole.tell() + len(part)
        if size > most:
            raise too_large(f"{file.name!r}, decompressed,", size)
        whole.write(part)
    whole.seek(0)
