"""The folder for what a command leaves, and the error in which a command ends."""

import os
import shutil
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory


class CommandError(RuntimeError):
    """What a command cannot do; the message says why, in one line or with a node's last words."""


class Refused(CommandError):
    """What a command cannot begin with the values that it was given."""


def _make_folder(path):
    folder = Path(path)
    try:
        folder.mkdir(parents=True)
    except FileExistsError:
        raise CommandError(
            f"{str(folder)!r} already exists; nothing is overwritten, choose another --out or remove it"
        ) from None
    except OSError as error:
        raise CommandError(f"{str(folder)!r} cannot be created: {error.strerror}") from None
    return folder


@contextmanager
def writing_to(folder):
    """Turn an `OSError` of the block, a full disk for instance, into a `CommandError` that names the folder."""
    try:
        yield
    except OSError as error:
        raise CommandError(f"{str(folder)!r} cannot be written: {error.strerror or error}") from None


@contextmanager
def whole_or_none(*files):
    """Give paths to write to, one for each of some files in one folder, which take their names when all are whole.

    Raises
    ------
    CommandError
        They cannot be written; what was there before is as it was.
    """
    folder = files[0].parent
    # a device is not replaced
    taken = [file for file in files if file.is_file() or not file.exists()]
    with writing_to(folder), ExitStack() as drafts:
        # under a name that nobody guesses, for somebody else may have put links there
        place = Path(drafts.enter_context(TemporaryDirectory(prefix=".new_", dir=folder))) if taken else folder
        yield [place / file.name if file in taken else file for file in files]
        for file in taken:
            (place / file.name).replace(file)


@contextmanager
def all_or_nothing(path, kept=lambda _folder, _error: False):
    """Make a new folder, which is taken away again, with the parents made for it, if the block ends in an exception.

    `kept(folder, error)` may decide that what there is by then is worth keeping.

    Raises
    ------
    CommandError
        There is one, it cannot be made, or it cannot be written to.
    """
    new = [folder for folder in (Path(path), *Path(path).parents) if not os.path.exists(folder)]
    folder = _make_folder(path)
    try:
        with writing_to(folder):
            yield folder
    except BaseException as error:
        if kept(folder, error):
            raise
        if isinstance(error, KeyboardInterrupt):
            error.args = (f"nothing is kept in {folder}",)
        shutil.rmtree(folder, ignore_errors=True)
        for parent in new[1:]:
            with suppress(OSError):  # something else lies there by now
                parent.rmdir()
        raise


def remove_if_empty(path):
    """Remove a folder, with those in it, if there is no file; returns whether it is gone."""
    with suppress(OSError):
        for folder, _, files in os.walk(path, topdown=False):
            if files:
                return False
            os.rmdir(folder)
    return not os.path.exists(path)
