"""Standard output that may break off, as `| head` and a full disk do, without what a verb computes being lost."""

import io
import sys
from contextlib import contextmanager

import click


class OutputLost(OSError):
    """What was printed did not all arrive; the message says why."""


class OutputUnread(OSError):
    """Whoever read what was printed has gone, as `| head` does; there is nobody to tell it to."""


class _Output(io.RawIOBase):
    """Hands bytes on until that fails for the first time, and drops them from then on."""

    def __init__(self, target):
        self._target = target
        self.failure = None

    def writable(self):
        return True

    def isatty(self):
        return self._target.isatty()

    def fileno(self):
        return self._target.fileno()

    def write(self, data):
        if self.failure is None:
            try:
                return self._target.write(data)
            except OSError as error:
                self.failure = error
        return len(data)


@contextmanager
def lasting_output():
    """Let `sys.stdout` take everything during the block; raise an error after it if that did not all arrive.

    It is `OutputUnread` where the reader has gone, else `OutputLost`.

    A terminal without the signs for square and box still gets the numbers.
    """
    before = sys.stdout
    before.flush()
    output = _Output(getattr(before.buffer, "raw", before.buffer))
    sys.stdout = io.TextIOWrapper(
        io.BufferedWriter(output), encoding=before.encoding, errors="replace", line_buffering=True
    )
    ended = None
    try:
        yield
    except (SystemExit, click.exceptions.Exit) as end:  # --help, for one, ends like this
        ended = end
    finally:
        sys.stdout.flush()
        sys.stdout = before
    if ended is not None and (getattr(ended, "code", 0) or getattr(ended, "exit_code", 0) or output.failure is None):
        raise ended
    if isinstance(output.failure, BrokenPipeError):
        raise OutputUnread
    if output.failure is not None:
        raise OutputLost(f"standard output cannot be written: {output.failure.strerror}; all files are written")
