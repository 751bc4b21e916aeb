"""How a verb ends when it cannot go on: one line on stderr, in which nothing but signs is left, and an exit code."""

import signal
import sys
from contextlib import suppress

from mr_mount_controller.node_base.plain_text import plain_line

# exit codes of what Ctrl-C has ended, and of what nobody reads any more, as shells give them
INTERRUPTED, UNREAD = 128 + signal.SIGINT, 128 + signal.SIGPIPE


def fail(error, code=1, word="error"):
    """Print an error, a line for each of its lines and notes, and end the process with an exit code."""
    say("\n".join([f"{word}: {error}", *getattr(error, "__notes__", ())]))
    sys.exit(code)


def say(text):
    """Print a text on stderr, a line for each of its lines."""
    with suppress(BrokenPipeError):  # nobody reads it, and there is no other place for it
        for line in text.split("\n"):
            print(plain_line(line), file=sys.stderr, flush=True)
