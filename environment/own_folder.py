"""A folder of the user's own, for what he cannot keep in a checkout that belongs to somebody else."""

import contextlib
import os
import stat
import tempfile
from pathlib import Path


def own_folder(environ) -> Path:
    """The user's cache folder or, without one, a folder for temporary files that later calls find again.

    Code is kept in it, so nobody else may be able to write there. Raises OSError if there is no place for it.
    """
    cache = environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    folder = Path(cache, "trackvib")
    with contextlib.suppress(OSError):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    for candidate in (folder, *sorted(Path(tempfile.gettempdir()).glob("trackvib-own-*"))):
        if _is_own(candidate):
            return candidate
    return Path(tempfile.mkdtemp(prefix="trackvib-own-"))


def _is_own(folder: Path) -> bool:
    """Whether it is a real folder, of this user, writable, and closed to everybody else's writing."""
    try:
        found = folder.lstat()
    except OSError:
        return False
    closed = not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and closed and os.access(folder, os.W_OK)
