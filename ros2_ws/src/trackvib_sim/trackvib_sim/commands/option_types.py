"""What the verbs' command lines share: types of options, exit codes."""

from math import isfinite

import click
from mr_mount_controller.laws import find_law
from mr_mount_controller.node_base.parameters import ParameterError

from ..bags.limits import LARGEST_CHUNKS, largest_chunk
from ..data import DEFAULT_VEHICLE

INTERRUPTED = 130  # exit code of what Ctrl-C has ended, as shells give it


class FiniteRange(click.FloatRange):
    """A range of floats, to which "nan" does not belong (to click's own it does)."""

    def convert(self, value, param, ctx):
        number = super().convert(value, param, ctx)
        if not isfinite(number):
            self.fail(f"{value} is not in the range {self._describe_range()}.", param, ctx)
        return number


class Several(click.ParamType):
    """Values of another type with commas between them: a sorted tuple, each value once."""

    def __init__(self, item):
        self.item = item
        self.name = f"{item.name},..."

    def convert(self, value, param, ctx):
        parts = value.split(",") if isinstance(value, str) else value
        return tuple(sorted({self.item.convert(part, param, ctx) for part in parts}))


def largest_chunk_option(command):
    """Give a command the option that says how much memory a record of a bag may take."""
    low, high = LARGEST_CHUNKS
    return click.option(
        "--largest-chunk",
        type=click.IntRange(low, high),
        default=largest_chunk.get(),
        show_default=True,
        metavar="MIB",
        expose_value=False,
        callback=lambda _context, _parameter, value: largest_chunk.set(value),
        help="Memory in MiB that a chunk of a bag may take when it is unfolded, and any other record; a bag that needs "
        "more is refused.",
    )(command)


vehicle_option = click.option(
    "--vehicle",
    default=None,
    metavar="NAME|FILE",
    help=f"Vehicle that comes with the package, or a vehicle file.  [default: {DEFAULT_VEHICLE}]",
)


def known_law(_context, _parameter, value):
    """Callback of an option that names a control law: refuse one that cannot be loaded."""
    if value is not None:
        try:
            find_law(value)
        except ParameterError as error:
            raise click.BadParameter(str(error)) from None
    return value
