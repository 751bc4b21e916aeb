"""The command line's run of the closed loop: `trackvib run`."""

import click

from ..vehicle.drive.limits import FASTEST
from .endings import fail
from .option_types import FiniteRange, law_option, vehicle_option


@click.command()
@vehicle_option
@click.option(
    "--road",
    default="E",
    show_default=True,
    metavar="CLASS|FILE",
    help="Class by ISO 8608, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag.",
)
@click.option(
    "--speed",
    type=FiniteRange(-FASTEST, FASTEST),
    default=10.0,
    show_default=True,
    help="Speed in m/s; below 0 backwards.",
)
@click.option(
    "--drive",
    type=click.Path(exists=True, dir_okay=False),
    default=None,
    help="Drive file: speed, path and engine speed over time or distance, in place of --speed.",
)
@click.option("--gears", is_flag=True, help="Engine speed follows the vehicle's, through the vehicle file's gears.")
@click.option("--duration", type=FiniteRange(0.1, 3600.0), default=10.0, show_default=True, help="Simulated time in s.")
@law_option("--law", default="passive", show_default=True, help="Control law")
@click.option("--seed", type=click.IntRange(0, 10**9), default=1, show_default=True, help="Seed of the road.")
@click.option(
    "--physics-rate",
    type=click.IntRange(1000, 200_000),
    default=10_000,
    show_default=True,
    help="Rate of the physics steps in Hz; `trackvib vehicle` tells the one that a vehicle needs.",
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
