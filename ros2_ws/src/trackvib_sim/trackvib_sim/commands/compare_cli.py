"""The command line's `trackvib compare`."""

import click

from ..analysis.settling import SHORTEST_SETTLING
from .endings import fail
from .option_types import FiniteRange, Known, largest_chunk_option
from .part_options import interval_option, speed_band_option
from .sensor_options import sensor_options

_ALIGNMENTS = ("auto", "speed", "distance", "none")


@click.command()
@largest_chunk_option
@sensor_options
@click.argument("measured", type=click.Path())
@click.argument("simulated", type=click.Path())
@click.option(
    "--align",
    type=Known(_ALIGNMENTS),
    default="auto",
    show_default=True,
    help="Compare what was driven at the same speed, or at the same distance along the way; auto: by speed where "
    "both contain it (odometry or satellite fixes), else statistics of all time that counts.",
)
@interval_option
@speed_band_option
@click.option(
    "--settle",
    type=FiniteRange(SHORTEST_SETTLING, 1e6, "s"),
    default=None,
    metavar="S",
    help=f"Time from the start of both recordings that does not count, in s, {SHORTEST_SETTLING:g} or more.  [default: "
    f"until the recorded run has settled, by its parameters; a recording without them as long as the other one; "
    f"{SHORTEST_SETTLING:g} if neither has them]",
)
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to create for the results.  [default: comparisons/<time>]",
)
def compare(measured, simulated, align, speed_band, interval, settle, out, time, unit, sources):
    """Compare a MEASURED recording with a SIMULATED one.

    Ratios of RMS, weighted and third-octave levels, of transmissibility and of lines of known cause, with their
    confidence intervals: a table, comparison.csv and .json, and an HTML report. The options for sensors, clock and unit
    apply to the measured recording, a bag or a CSV file.
    """
    from ..bags.errors import BagError  # imported late: --help need not wait for it
    from .compare import run_compare
    from .result_folder import CommandError

    try:
        run_compare(measured, simulated, align, speed_band, interval, settle, out, time, unit, sources)
    except (BagError, CommandError) as error:
        fail(error)
