"""The command line's run of the closed loop: `trackvib run`."""

import click

from .driving_options import driving_options
from .endings import fail
from .option_types import FiniteRange, law_option


@click.command()
@driving_options
@click.option("--duration", type=FiniteRange(0.1, 3600.0), default=10.0, show_default=True, help="Simulated time in s.")
@law_option("--law", default="passive", show_default=True, help="Control law")
@click.option(
    "--measure-rate",
    type=click.IntRange(0, 1000),
    default=0,
    show_default=True,
    metavar="HZ",
    help="Rate of what is measured in the running gear: travel, forces, tension, torque; 0 for none.",
)
@click.option(
    "--one-process", is_flag=True, help="Simulator, road and controller in one process: the same results, sooner."
)
@click.option("--view", is_flag=True, help="Show the run in a browser on this machine while it goes on.")
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to make for the run.  [default: runs/<time>_<road>_<speed>]",
)
def run(out, **choices):
    """Run the closed loop as four ROS 2 nodes; leaves a bag, a summary and a picture."""
    from .result_folder import CommandError
    from .run import Choices, run_loop  # imported late: --help need not wait for it

    try:
        if choices["view"]:
            from .live_view import run_with_view

            run_with_view(Choices(**choices), out)
        else:
            run_loop(Choices(**choices), out)
    except CommandError as error:
        fail(error)
