"""`trackvib road`: options."""

import click

from .endings import fail
from .option_types import FiniteRange


@click.command()
@click.argument("road")
@click.option("--seed", type=click.IntRange(0, 10**9), default=1, show_default=True, help="Seed of a class.")
@click.option(
    "--length", type=FiniteRange(10.0, 1e5), default=500.0, show_default=True, help="Length in m that is looked at."
)
@click.option(
    "--begin",
    type=FiniteRange(-1e6, 1e6),
    default=None,
    help="Where it begins, in m.  [default: where the road does]",
)
@click.option(
    "--tread", type=FiniteRange(0.1, 10.0), default=2.8, show_default=True, help="Distance between the tracks in m."
)
@click.option(
    "--csv", type=click.Path(dir_okay=False), default=None, help="Write the heights that are looked at to this file."
)
@click.option(
    "--crg", type=click.Path(dir_okay=False), default=None, help="Write them as an OpenCRG file of two sections."
)
@click.option(
    "--out", type=click.Path(dir_okay=False), default="road.png", show_default=True, help="Picture of profile and PSD."
)
def road(road, **choices):
    """Tell what a road is like: class, waviness, roughness index, level; draw it with its spectrum.

    ROAD is a class by ISO 8608, A to H, or a file: a profile (CSV), OpenCRG, a road file (YAML), or a bag.
    """
    from .result_folder import CommandError
    from .road import run_road  # imported late: --help need not wait for it

    try:
        run_road(road, **choices)
    except (CommandError, ValueError, OSError) as error:
        fail(error)
