"""What compiled kernels depend on, and the folder of them that this user can use.

numba wants to write where it reads, even if all is compiled already. A checkout that somebody else has set up, or one
on a read-only disk, gets its kernels copied, once, to a folder of this user's own.
"""

import os
import re
import shutil
import tempfile
from pathlib import Path

from environment import steps
from environment.own_folder import own_folder

_WITH_KERNELS = re.compile(r"^from \S*compiled import", re.MULTILINE)


def sources(package: Path) -> list:
    """Every module in the rooms of `package` that have kernels in them.

    numba looks only at the file of a compiled function, not at those of the functions, constants and records that it
    was made with; these are in the same rooms.
    """
    modules = sorted(package.rglob("*.py"))
    rooms = {path.relative_to(package).parts[0] for path in modules if _WITH_KERNELS.search(path.read_text("utf-8"))}
    return [path for path in modules if path.relative_to(package).parts[0] in rooms]


def usable(kernels: Path, environ) -> Path:
    """`kernels`, if this user may write to where it lies; else this user's own copy of it.

    Where no copy can be made, it says so and gives `kernels` all the same: most of what a job does needs none.
    """
    if os.access(kernels.parent, os.W_OK):
        return kernels
    try:
        return _copy(kernels, own_folder(environ))
    except OSError as error:
        steps.say(f"no space for a copy of the compiled simulation ({error}); set TMPDIR to a folder of your own")
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
        draft.rename(copy)
    except OSError:
        if not copy.is_dir():  # another job may have been quicker
            raise
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return copy
