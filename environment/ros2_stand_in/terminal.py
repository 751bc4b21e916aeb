"""The one way to the terminal: text from outside is printed as text."""

import sys

from mr_mount_controller.node_base.plain_text import readable


class Failure(Exception):
    """What ends a command with one line and exit code 1."""


def line(text="", to=None) -> None:
    """Print one line; what would move the cursor, a line's end among it, becomes its escape sequence."""
    print(readable(str(text)), file=to or sys.stdout, flush=True)


def lines(text) -> None:
    """Print a text of lines and tabs of our own."""
    print("\n".join("\t".join(map(readable, each.split("\t"))) for each in str(text).split("\n")), flush=True)


def complain(message, code: int) -> int:
    """Print an error or warning; returns the exit code."""
    line(f"ros2 (trackvib's stand-in): {message}", sys.stderr)
    return code
