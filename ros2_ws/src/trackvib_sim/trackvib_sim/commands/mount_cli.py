"""`trackvib mount`: options of the test bench."""

import click

from ..mount_bench import LAWS
from .endings import fail
from .option_types import FiniteRange, Known, Several, on_command_line, vehicle_option
from .verbs import Verbs


def _numbers(name, default, low, high, unit, words):
    kind = Several(FiniteRange(low, high, unit))
    words = words.format(each=kind.each)
    return click.option(name, type=kind, default=default, show_default=True, metavar="X,X,...", help=words)


_OUT = click.option(
    "--out",
    type=click.Path(file_okay=False),
    default="mount",
    show_default=True,
    help="Folder to create for the results.",
)


@click.group(cls=Verbs, invoke_without_command=True)
@vehicle_option
@click.option("--mount", default=None, help="Name of the mount.  [default: the vehicle's first]")
@_numbers("--amplitudes", "0.2,1,3", 1e-3, 50.0, "mm", "Amplitudes, {each}.")
@_numbers("--frequencies", "1,8.7,30", 1e-3, 500.0, "Hz", "Frequencies, {each}.")
@_numbers("--currents", None, 0.0, 20.0, "A", "Constant currents, {each}.  [default: 0,1,2,4 for a mount with a coil]")
@_OUT
@click.pass_context
def mount(context, **choices):
    """Excite a mount on a simulated test bench; writes its force-displacement loops as picture and CSV."""
    if context.invoked_subcommand is not None:
        given = on_command_line(context, choices)
        if given:
            raise click.UsageError(f"--{given[0]} cannot be combined with '{context.invoked_subcommand}'")
        return
    from .mount import run_bench  # imported late: --help need not wait for it
    from .result_folder import CommandError

    try:
        run_bench(choices.pop("vehicle"), **choices)
    except (CommandError, ValueError) as error:
        fail(error)


@mount.command()
@click.argument("file", type=click.Path(exists=True, dir_okay=False))
@click.option(
    "--law",
    type=Known(LAWS),
    default="yielding",
    show_default=True,
    help="Law to fit: without or with a yield force.",
)
@click.option(
    "--carried-mass",
    type=FiniteRange(1.0, 1e6, "kg"),
    default=1000.0,
    show_default=True,
    help="Mass in kg to which the damping ratio refers.",
)
@_OUT
def fit(file, law, carried_mass, out):
    """Fit a mount's law to measured loops.

    FILE is CSV with the columns time_s, displacement_m, force_N, current_A.
    """
    from .mount import run_fit  # imported late, as above
    from .result_folder import CommandError

    try:
        run_fit(file, law, carried_mass, out)
    except (CommandError, ValueError, OSError) as error:
        fail(error)
