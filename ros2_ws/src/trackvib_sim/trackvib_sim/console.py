"""The terminal: one kind of console for all verbs, on which text is text.

It may come from a bag, a file or a name that others chose, so nothing in it is read as markup, and control characters
are written out. Errors take the same care (`commands.endings`).
"""

from mr_mount_controller.node_base.plain_text import readable
from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TaskProgressColumn, TimeRemainingColumn
from rich.text import Text


class Terminal(Console):
    """Shows every string as it stands; options as of `rich.console.Console`."""

    def __init__(self, **options):
        super().__init__(highlight=False, markup=False, emoji=False, **options)

    def render_str(self, text, **options):
        """Return what `print` and tables show for a string."""
        return super().render_str(readable(text), **{**options, "markup": False, "emoji": False})


class Description(ProgressColumn):
    """What a task of a progress bar is called."""

    def render(self, task):
        """Return it as it stands."""
        return Text(readable(task.description))


def followed(items, description, console, total=None):
    """Iterate over `items`, of which there are `total`, with a bar that goes when they are done; only in a terminal."""
    columns = (Description(), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield from progress.track(items, total, description=description)
