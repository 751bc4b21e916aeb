"""The command line's `trackvib analyze`."""

import click

from ..analysis.settling import SHORTEST_SETTLING
from .endings import fail
from .option_types import FiniteRange, largest_chunk_option
from .part_options import interval_option, speed_band_option
from .sensor_options import sensor_options


@click.command()
@largest_chunk_option
@sensor_options
@click.argument("bags", nargs=-1, required=True, metavar="BAG...", type=click.Path())
@click.option(
    "--settle",
    type=FiniteRange(SHORTEST_SETTLING, 1e6, "s"),
    default=None,
    metavar="S",
    help="Time from the start of each bag that does not count, in s; "
    "filters settle, too.  [default: until the recorded run has settled, by its parameters]",
)
@interval_option
@speed_band_option
@click.option(
    "--out",
    type=click.Path(file_okay=False),
    default=None,
    help="Folder to create for the results.  [default: analyses/<time>]",
)
def analyze(bags, settle, interval, speed_band, out, time, unit, sources):
    """Analyze bags or CSV files of samples: an HTML report, and the numbers as files.

    RMS, ISO 2631-1 and absorbed power, also by distance and by speed; spectra, engine orders, mounts and currents.
    The report compares several recordings; JSON, CSV and Parquet files are for programs.
    """
    from ..bags.errors import BagError  # imported late: --help need not wait for it
    from .analyze import run_analyze
    from .result_folder import CommandError

    try:
        run_analyze(bags, settle, interval, speed_band, out, time, unit, sources)
    except (BagError, CommandError) as error:
        fail(error)
