"""The command line's replays: `trackvib replay BAG`."""

import sys
from datetime import datetime
from pathlib import Path

import click

from .endings import fail
from .option_types import known_law, largest_chunk_option, law_option

EXTERNAL = "external"
CANNOT_VERIFY = 2


def _law_or_external(context, parameter, value):
    return value if value == EXTERNAL else known_law(context, parameter, value)


@click.command()
@largest_chunk_option
@click.argument("bag", type=click.Path())
@click.option(
    "--verify",
    is_flag=True,
    help="Run the simulator on the recorded road and currents; its sensor samples must be bit-identical. "
    "Exit code 0: they do, 1: they do not, 2: the bag lacks information.",
)
@law_option("--law", default=None, metavar="LAW", help="Repeat the run on the recorded road with another control law")
@click.option(
    "--controller",
    default=None,
    callback=_law_or_external,
    metavar="LAW",
    help=f"Send the recorded accelerations to a controller node with this law, or with '{EXTERNAL}' to the "
    "one that you run, and compare its currents with the recorded ones.",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to create with --law or --controller.  [default: runs/<time>_replay_<law>]",
)
def replay(bag, verify, law, controller, out):
    """Replay a bag into the simulator (--verify, --law) or into a controller (--controller)."""
    if sum((verify, law is not None, controller is not None)) != 1:
        raise click.UsageError("exactly one of --verify, --law and --controller is needed")
    if verify and out is not None:
        raise click.UsageError("--verify writes no files, so it cannot be combined with --out")
    from mr_mount_controller.laws import LawError  # imported late: --help need not wait for it

    from ..bags.errors import BagError
    from ..console import Terminal
    from .result_folder import CommandError

    console = Terminal()
    name = (law or controller or "").rpartition(":")[2]
    out = out or Path("runs") / f"{datetime.now():%Y%m%dT%H%M%S}_replay_{name}"
    try:
        if verify:
            from .replay_verify import run_replay_verify

            if different := run_replay_verify(bag, console):
                sys.exit(different)
        elif law is not None:
            from .replay_law import run_replay_law

            run_replay_law(bag, law, out, console)
        else:
            from ..nodes.processes import LoopProcesses
            from .own_domain import Lookout

            lookout = Lookout()  # it looks while the rest is loaded
            from .replay_controller import run_replay_controller

            with LoopProcesses([] if controller == EXTERNAL else ["controller"]) as stock:
                law = None if controller == EXTERNAL else controller
                run_replay_controller(bag, law, stock, out, lookout, console)
    except (BagError, LawError, CommandError, ValueError, OSError) as error:
        fail(error, *((CANNOT_VERIFY, "cannot be verified") if verify else ()))
