"""A bar for what takes a while, where somebody looks."""

from rich.progress import track


def followed(items, description, console, total=None):
    """Iterate over `items`, of which there are `total`, with a bar that goes when they are done; only in a terminal."""
    return track(items, description, total, console=console, transient=True, disable=not console.is_terminal)
