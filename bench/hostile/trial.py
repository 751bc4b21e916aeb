"""One input: what comes of it, and whether that is right."""

import os
import re
import signal
import sys
import tempfile
import traceback
from contextlib import contextmanager
from types import SimpleNamespace

from mr_mount_controller.node_base.plain_text import LONGEST_LINE

PATIENCE = 60.0  # s
MARGIN = 100  # characters of a line of an error, beyond what it quotes
CONTROL = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


class Wrong(Exception):
    """A result that is not sound; says why."""


def outcome(attempt, refusals):
    """Return the kind of outcome of an attempt, and what is wrong with it, "" if nothing."""
    signal.signal(signal.SIGALRM, _late)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE)
    try:
        return attempt(), ""
    except Wrong as wrong:
        return "unsound", str(wrong)
    except refusals as error:
        return type(error).__name__, flaw(str(error))
    except BaseException as error:  # the table is of exactly these
        if isinstance(error, KeyboardInterrupt) and error.args != (PATIENCE,):
            raise  # the user's
        place = traceback.extract_tb(error.__traceback__)[-1]
        return type(error).__name__, f"{place.filename}:{place.lineno}: {error!s:.300}"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def flaw(text):
    """Return what is wrong with the text of an error, "" if nothing: its lines are plain and not too long."""
    if not text.strip():
        return "an error without words"
    bad = [line for line in text.split("\n") if len(line) > LONGEST_LINE + MARGIN or not line.isprintable()]
    return f"not a plain line: {bad[0][:200]!r} of {len(bad[0])} characters" if bad else ""


@contextmanager
def captured():
    """Give what standard error and output get, from C++ code as well: `text` after the block, and its `control`."""
    said = SimpleNamespace(text="", control=None)
    with tempfile.TemporaryFile() as file:
        before = [(fd, os.dup(fd)) for fd in (1, 2)]
        for fd, _ in before:
            os.dup2(file.fileno(), fd)
        try:
            yield said
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            for fd, copy in before:
                os.dup2(copy, fd)
                os.close(copy)
            file.seek(0)
            said.text = file.read().decode(errors="replace")
            said.control = CONTROL.search(said.text)


def _late(*_):
    raise KeyboardInterrupt(PATIENCE)
