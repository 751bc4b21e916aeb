"""`trackvib road`: options."""

import click

from .endings import fail
from .option_types import FiniteRange, WholeRange


@click.command()
@click.argument("road")
@click.option("--seed", type=WholeRange(0, 10**9), default=1, show_default=True, help="Seed of a class.")
@click.option(
    "--length", type=FiniteRange(10.0, 1e5, "m"), default=500.0, show_default=True, help="Length in m to evaluate."
)
@click.option(
    "--begin",
    type=FiniteRange(-1e6, 1e6, "m"),
    default=None,
    help="Start of the evaluated part in m.  [default: start of the road]",
)
@click.option(
    "--tread",
    type=FiniteRange(0.1, 10.0, "m"),
    default=2.8,
    show_default=True,
    help="Distance between the tracks.",
)
@click.option(
    "--csv",
    type=click.Path(dir_okay=False),
    default=None,
    help="Write the evaluated heights to this CSV file.  [default: none]",
)
@click.option(
    "--crg",
    type=click.Path(dir_okay=False),
    default=None,
    help="Write the evaluated heights to this OpenCRG file with two long sections.  [default: none]",
)
@click.option(
    "--out",
    type=click.Path(dir_okay=False),
    default="road.png",
    show_default=True,
    help="Picture of the profile and its PSD.",
)
def road(road, **choices):
    """Describe a road: class, waviness, roughness index, level; draw it with its spectrum.

    ROAD is an ISO 8608 class, A to H, or a file: profile (CSV), OpenCRG, road file (YAML), or a bag.
    """
    from .result_folder import CommandError
    from .road import run_road  # imported late: --help need not wait for it

    try:
        run_road(road, **choices)
    except (CommandError, ValueError, OSError) as error:
        fail(error)
