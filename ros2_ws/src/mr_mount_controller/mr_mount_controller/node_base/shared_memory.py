"""What killed processes leave of Fast DDS's shared memory, and what of it stands in the way.

A process that is killed at the moment when it makes a segment leaves one that nobody will ever finish. Every later
process that needs the segment of that name waits for it without end (Fast DDS 2.14, boost::interprocess).
"""

import time
from contextlib import suppress
from pathlib import Path

_FOLDER = Path("/dev/shm")
_SEGMENTS = "fastrtps_*"
_LOCK = "_el"  # how the names of lock files end; they are empty
_READY = (2).to_bytes(4, "little")  # first word of a segment that is finished
_MAKING = 1.0  # s; making one takes some microseconds
_LOOK = 0.05  # s


def remove_unfinished_segments(folder=_FOLDER):
    """Remove segments that have stayed unfinished for a second; one that is younger is given the rest of it."""
    for path in sorted(folder.glob(_SEGMENTS)):
        with suppress(OSError):  # gone by now, or another user's
            while not path.name.endswith(_LOCK) and _unfinished(path):
                if time.time() - path.stat().st_mtime > _MAKING:
                    path.unlink()
                time.sleep(_LOOK)


def _unfinished(path):
    with path.open("rb") as file:
        return file.read(len(_READY)) != _READY
