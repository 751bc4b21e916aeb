"""The command line's bags: `trackvib bag VERB BAG`."""

import sys
from contextlib import contextmanager

import click

from .endings import INTERRUPTED, fail, say
from .option_types import largest_chunk_option
from .verbs import Verbs


@click.group(cls=Verbs)
def bag():
    """Inspect recorded bags, and repair those that were cut short."""


@contextmanager
def _ends_in_one_line():
    from ..bags.errors import BagError  # imported late: --help need not wait for it

    try:
        yield
    except BagError as error:
        fail(error)
    except KeyboardInterrupt:
        say("interrupted; the bag is as it was")
        sys.exit(INTERRUPTED)


@bag.command()
@largest_chunk_option
@click.argument("bag", type=click.Path())
def info(bag):
    """Show the contents of a bag: topics, messages, times and provenance."""
    with _ends_in_one_line():
        from .bag import run_info  # imported late, as above

        run_info(bag)


@bag.command()
@largest_chunk_option
@click.argument("bag", type=click.Path(file_okay=False))
def repair(bag):
    """Repair a bag whose recorder was killed or whose disk was full.

    Index, statistics and metadata.yaml are restored, and no whole message is lost. The original file is kept beside it,
    its name ending in .damaged. An intact bag is not changed.
    """
    with _ends_in_one_line():
        from .bag import run_repair  # imported late, as above

        run_repair(bag)
