"""The command line's look at a run: `trackvib view BAG`."""

import click

from .endings import fail
from .option_types import FiniteRange, WholeRange, largest_chunk_option


@click.command()
@largest_chunk_option
@click.argument("bag", type=click.Path())
@click.option(
    "--save",
    type=click.Path(dir_okay=False),
    default=None,
    help="Only write a Rerun recording (.rrd).  [default: none]",
)
@click.option(
    "--gif",
    type=click.Path(dir_okay=False),
    default=None,
    help="Only write an animated picture (.gif).  [default: none]",
)
@click.option(
    "--rate",
    type=FiniteRange(1.0, 1000.0, "Hz"),
    default=None,
    help="Frames per second of simulated time.  [default: 50, in a picture 12.5]",
)
@click.option("--start", type=FiniteRange(0.0, 1e6, "s"), default=0.0, show_default=True, help="Start time in s.")
@click.option("--end", type=FiniteRange(0.0, 1e6, "s"), default=None, help="End time in s.  [default: end of the bag]")
@click.option("--port", type=WholeRange(0, 65535), default=0, help="Port to serve on.  [default: a free one]")
def view(bag, save, gif, rate, start, end, port):
    """Show a recorded run in a browser on this machine: the vehicle moving on its road, with curves beside it.

    The page comes from this machine (127.0.0.1) and sends nothing anywhere; no network is needed. Ctrl-C ends it.
    """
    if save is not None and gif is not None:
        raise click.UsageError("--save and --gif cannot be combined")
    from mr_mount_controller.laws import LawError  # imported late: --help need not wait for it

    from ..bags.errors import BagError
    from ..console import Terminal
    from .result_folder import CommandError
    from .view import run_view

    try:
        run_view(bag, (rate, start, end), save, gif, port, Terminal())
    except (BagError, LawError, CommandError, ImportError, ValueError, OSError) as error:
        fail(error)
