"""Options that say which vehicle is driven, on which road and how: for every verb that drives one."""

import click

from ..vehicle.drive.limits import FASTEST
from .option_types import FiniteRange, vehicle_option

_OPTIONS = (
    vehicle_option,
    click.option(
        "--road",
        default="E",
        show_default=True,
        metavar="CLASS|FILE",
        help="Class by ISO 8608, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag.",
    ),
    click.option(
        "--speed",
        type=FiniteRange(-FASTEST, FASTEST),
        default=10.0,
        show_default=True,
        help="Speed in m/s; below 0 backwards.",
    ),
    click.option(
        "--drive",
        type=click.Path(exists=True, dir_okay=False),
        default=None,
        help="Drive file: speed, path and engine speed over time or distance, in place of --speed.",
    ),
    click.option("--gears", is_flag=True, help="Engine speed follows the vehicle's, through the vehicle file's gears."),
    click.option("--seed", type=click.IntRange(0, 10**9), default=1, show_default=True, help="Seed of the road."),
    click.option(
        "--physics-rate",
        type=click.IntRange(1000, 200_000),
        default=10_000,
        show_default=True,
        help="Rate of the physics steps in Hz; `trackvib vehicle` tells the one that a vehicle needs.",
    ),
)


def driving_options(command):
    """Give a command `--vehicle`, `--road`, `--seed`, `--speed`, `--drive`, `--gears` and `--physics-rate`."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
