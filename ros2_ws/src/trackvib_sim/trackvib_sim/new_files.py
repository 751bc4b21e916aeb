"""Files that are written beside and put in their place when they are whole; no link is followed on the way."""

import os
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex


@contextmanager
def new_file(path, before=lambda: None):
    """Give a binary file to write, which takes the place of `path` at the end, unless the block ends in an exception.

    Until then it has a name of its own in the same folder. `before()` is called right before it takes its place.
    """
    path = Path(path)
    part = path.with_name(f"{path.name}.{token_hex(8)}.part")
    # nothing that stands there under that name is opened, nor what it links to
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC, 0o666)
    try:
        with open(descriptor, "wb") as file:
            yield file
        before()
        part.replace(path)
    except OSError as error:
        if error.errno is not None:  # else it has words of its own
            error.filename = error.filename or str(path)  # a full disk does not say whose write it fails
        raise
    finally:
        with suppress(FileNotFoundError):
            part.unlink()


def set_aside(path):
    """Rename a file, a link or whatever it is to `path` with `.damaged` behind; returns the new path.

    Raises
    ------
    FileExistsError
        There is one already.
    """
    path = Path(path)
    aside = path.with_name(f"{path.name}.damaged")
    if os.path.lexists(aside):
        raise FileExistsError(f"{str(aside)!r} already exists; nothing is overwritten")
    return path.rename(aside)
