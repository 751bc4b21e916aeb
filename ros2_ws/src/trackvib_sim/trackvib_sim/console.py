"""The terminal: one kind of console for all verbs, on which text is text.

It may come from a bag, a file or a name that others chose, so nothing in it is read as markup, and control characters
are written out. Errors take the same care (`commands.endings`). Nothing is cut: in a pipe or a file a table is as wide
as it needs, in a narrow terminal its words are folded and its numbers stay whole.
"""

import os
import re

from mr_mount_controller.node_base.plain_text import readable
from rich.cells import cell_len
from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TaskProgressColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

_UNLIMITED = 100_000  # columns of what is no terminal
_SHORTEST_FOLDS = 20, 12, 9, 6, 4  # letters of a word that are kept together, fewer where there is no room
_NUMBER = re.compile(r"[+\-−±*]*[0-9]")  # what begins like this is a number


class Terminal(Console):
    """Shows every string as it stands; options as of `rich.console.Console`."""

    def __init__(self, **options):
        super().__init__(highlight=False, markup=False, emoji=False, **options)
        if "width" not in options and "COLUMNS" not in os.environ and not self.is_terminal:
            self.width = _UNLIMITED

    def print(self, *objects, **options):
        """Print as rich does; tables are fitted to the width."""
        tables = [each for each in objects if isinstance(each, Table)]
        for table in tables:
            _fit(table, self.width)
        super().print(*objects, **({"crop": False} if tables else {}), **options)

    def render_str(self, text, **options):
        """Return what `print` and tables show for a string."""
        return super().render_str(readable(text), **{**options, "markup": False, "emoji": False})


def _fit(table, width):
    """Set the widths of a table's columns so that it is as wide as the terminal at most, or as its numbers need."""
    columns = [[_plain(each) for each in (column.header, *column.cells)] for column in table.columns]
    widths = [max(map(_longest_line, texts)) for texts in columns]
    lines = 3 * len(columns) + 1  # what lines and blanks between the columns take
    for shortest in _SHORTEST_FOLDS:
        least = [_least(texts, shortest) for texts in columns]
        _narrow(widths, least, width - lines)
    for column, wide in zip(table.columns, widths, strict=True):
        column.width, column.overflow = wide, "fold"
    table.width = sum(widths) + lines


def _narrow(widths, least, room):
    """Take from the widest columns, none below its least width, until all fit the room or nothing is left to take."""
    while sum(widths) > room:
        spare = [k for k, (wide, low) in enumerate(zip(widths, least, strict=True)) if wide > low]
        if not spare:
            return
        widths[max(spare, key=widths.__getitem__)] -= 1


def _least(texts, shortest):
    """The least width of a column of these texts: of its numbers, and of its words, of which long ones are folded."""
    words = [word for text in texts for word in text.split()]
    return max([1, *(cell_len(word) if _NUMBER.match(word) else min(cell_len(word), shortest) for word in words)])


def _longest_line(text):
    return max(map(cell_len, text.split("\n")))


def _plain(cell):
    return cell.plain if isinstance(cell, Text) else readable(str(cell))


class Description(ProgressColumn):
    """What a task of a progress bar is called."""

    def render(self, task):
        """Return it as it stands."""
        return Text(readable(task.description))


def progress_on(console, count=None, **options):
    """Return a display of how far tasks have come: in the column `count`, or as a share.

    Options as of `rich.progress.Progress`.
    """
    columns = (Description(), BarColumn(), count or TaskProgressColumn(), TimeRemainingColumn())
    return Progress(*columns, console=console, **options)


def followed(items, description, console, total=None):
    """Iterate over `items`, of which there are `total`, with a bar that goes when they are done; only in a terminal."""
    with progress_on(console, transient=True, disable=not console.is_terminal) as progress:
        yield from progress.track(items, total, description=description)
