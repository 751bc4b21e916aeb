"""The options that divide a drive into parts, by distance and by speed; shared by all verbs that measure."""

import click

from ..analysis.numbers import INTERVAL, SPEED_BAND
from .option_types import FiniteRange

interval_option = click.option(
    "--interval",
    type=FiniteRange(1.0, 1e6, "m"),
    default=INTERVAL,
    metavar="M",
    show_default=True,
    help="Length in m of the distance intervals for which numbers are given.",
)
speed_band_option = click.option(
    "--speed-band",
    type=FiniteRange(0.1, 1e3, "m/s"),
    default=SPEED_BAND,
    metavar="V",
    show_default=True,
    help="Width in m/s of the speed bands for which numbers are given.",
)
