"""`trackvib run --view`: the run in a browser while it goes on."""

import threading
from contextlib import contextmanager
from itertools import chain

from ..console import Terminal
from .result_folder import CommandError
from .run import run_loop
from .view import Served


def run_with_view(choosing, out, lookout):
    """Do a run as `run.run_loop` does, and show it; its view stays until Ctrl-C. Raises as that does."""
    run_loop(choosing, out, lookout, lambda choices, vehicle: _live_view(choices, vehicle, Terminal()))


@contextmanager
def _live_view(choices, vehicle, console):
    """Serve the view of a run of a vehicle (`parameters.Vehicle`) that is done within the block, until Ctrl-C."""
    try:
        from ..view.live import live_pieces
    except ImportError as error:
        raise CommandError(str(error)) from None
    over, title = threading.Event(), choices.title
    pieces = live_pieces(vehicle, title, choices.namespace, over.is_set)
    with Served(0, title, console) as served:
        first = next(pieces)  # it listens before the nodes start, so the run is shown from its first sample on
        thread = threading.Thread(target=served.show, args=(chain([first], pieces),), daemon=True)
        thread.start()
        try:
            yield
            over.set()
            served.wait()
        finally:
            over.set()
            thread.join()
