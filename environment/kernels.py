"""The folder of compiled kernels that this user can use.

numba wants to write where it reads, even if all is compiled already. A checkout that somebody else has set up, or one
on a read-only disk, gets its kernels copied, once, to a folder of this user's own.
"""

import contextlib
import os
import shutil
import stat
import tempfile
from pathlib import Path

from environment import steps

_NAME = "trackvib-kernels"


def usable(kernels: Path, environ) -> Path:
    """`kernels`, if this user may write to where it lies; else this user's own copy of it.

    Where no copy can be made, it says so and gives `kernels` all the same: most of what a job does needs none.
    """
    if os.access(kernels.parent, os.W_OK):
        return kernels
    try:
        return _copy(kernels, _own_folder(environ))
    except OSError as error:
        steps.say(f"no place for a copy of the compiled simulation ({error}); set TMPDIR to a folder of your own")
        return kernels


def _copy(kernels: Path, folder: Path) -> Path:
    """Copy of `kernels` in `folder`; under its name only when it is complete."""
    copy = folder / kernels.name
    if copy.is_dir():
        return copy
    draft = Path(tempfile.mkdtemp(prefix=kernels.name, dir=folder))
    try:
        for file in kernels.rglob("*.nb[ic]"):
            target = draft / file.relative_to(kernels)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target)  # not the mode: the original may be read-only
        with contextlib.suppress(FileExistsError):  # two jobs at once
            draft.rename(copy)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return copy


def _own_folder(environ) -> Path:
    """A folder that only this user can write to: kernels are code, so nobody else may have put them there."""
    cache = environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    folder = Path(cache, _NAME)
    with contextlib.suppress(OSError):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if _is_own(folder):
        return folder
    for candidate in sorted(Path(tempfile.gettempdir()).glob(f"{_NAME}-*")):
        if _is_own(candidate):
            return candidate
    return Path(tempfile.mkdtemp(prefix=f"{_NAME}-"))


def _is_own(folder: Path) -> bool:
    """Whether it is a real folder, of this user, writable, and closed to everybody else's writing."""
    try:
        found = folder.lstat()
    except OSError:
        return False
    closed = not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return stat.S_ISDIR(found.st_mode) and found.st_uid == os.geteuid() and closed and os.access(folder, os.W_OK)
