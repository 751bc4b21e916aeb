"""The options that divide a drive into parts, by its way and by its speed; shared by all verbs that measure."""

import click

from ..analysis.numbers import INTERVAL, SPEED_BAND
from .option_types import FiniteRange

interval_option = click.option(
    "--interval",
    type=FiniteRange(1.0, 1e6),
    default=INTERVAL,
    metavar="M",
    show_default=True,
    help="Length of the intervals of way by which numbers are given, in m.",
)
speed_band_option = click.option(
    "--speed-band",
    type=FiniteRange(0.1, 1e3),
    default=SPEED_BAND,
    metavar="V",
    show_default=True,
    help="Width of the bands of speed by which numbers are given, in m/s.",
)
