"""`trackvib fmu`: options."""

import click

from .driving_options import driving_options, with_defaults
from .endings import fail


@click.command()
@driving_options
@click.option(
    "--out",
    type=click.Path(dir_okay=False),
    default="trackvib.fmu",
    show_default=True,
    help="File to write, ending in .fmu.",
)
def fmu(out, **given):
    """Write a vehicle on its road as an FMU (FMI 2.0, co-simulation) for other simulators.

    Inputs are the coil currents; outputs are sensor and mount signals. It runs with this Python on this machine only.
    """
    from .fmu import run_fmu  # imported late: --help need not wait for it
    from .result_folder import CommandError

    try:
        run_fmu(out, **with_defaults(given))
    except (CommandError, ValueError, OSError) as error:
        fail(error)
