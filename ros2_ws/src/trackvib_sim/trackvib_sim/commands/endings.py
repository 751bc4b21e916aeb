"""How a verb ends when it cannot go on: one line on stderr, in which nothing but signs is left, and an exit code."""

import sys

from mr_mount_controller.node_base.plain_text import plain_line

INTERRUPTED = 130  # exit code of what Ctrl-C has ended, as shells give it


def fail(error, code=1, word="error"):
    """Print an error, a line for each of its lines, and end the process with an exit code."""
    say(f"{word}: {error}")
    sys.exit(code)


def say(text):
    """Print a text on stderr, a line for each of its lines."""
    for line in text.split("\n"):
        print(plain_line(line), file=sys.stderr)
