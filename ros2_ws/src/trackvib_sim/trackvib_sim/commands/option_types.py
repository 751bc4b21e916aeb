"""What the verbs' command lines share: types of options, and options."""

from math import isfinite

import click
from click.core import ParameterSource
from mr_mount_controller.node_base.plain_text import number, span
from mr_mount_controller.node_base.suggestion import suggestion

from ..bags.limits import LARGEST_CHUNKS, largest_chunk
from ..data import DEFAULT_VEHICLE


class _InWords:
    """A range with both bounds that help and errors tell in words, with its unit."""

    def __init__(self, low, high, unit="", **ends):
        super().__init__(low, high, **ends)
        self.unit = unit

    def _describe_range(self):
        if self.min_open:
            return f"above {number(self.min)}, up to {number(self.max)} {self.unit}".rstrip()
        return span(self.min, self.max, self.unit)


class FiniteRange(_InWords, click.FloatRange):
    """A range of floats, to which "nan" does not belong (to click's own it does)."""

    def convert(self, value, param, ctx):
        given = super().convert(value, param, ctx)
        if not isfinite(given):
            self.fail(f"{value} is not in the range {self._describe_range()}.", param, ctx)
        return given


class WholeRange(_InWords, click.IntRange):
    """A range of whole numbers."""


class ZeroOr(WholeRange):
    """A range of whole numbers, or 0, which stands for something else."""

    def convert(self, value, param, ctx):
        return 0 if value in (0, "0") else super().convert(value, param, ctx)

    def _describe_range(self):
        return f"0, or {super()._describe_range()}"


class Known(click.Choice):
    """Names that are known; an error says which one may have been meant."""

    def get_invalid_choice_message(self, value, ctx):
        return super().get_invalid_choice_message(value, ctx).rstrip(".") + suggestion(str(value), self.choices)


class Several(click.ParamType):
    """Values of another type with commas between them: a sorted tuple, each value once."""

    def __init__(self, item):
        self.item = item
        self.name = f"{item.name},..."

    @property
    def each(self):
        """What each number may be, in words; of a range."""
        return f"each {self.item._describe_range()}"

    def convert(self, value, param, ctx):
        parts = value.split(",") if isinstance(value, str) else value
        return tuple(sorted({self.item.convert(part, param, ctx) for part in parts}))


def largest_chunk_option(command):
    """Give a command the option that says how much memory a record of a bag may take."""
    low, high = LARGEST_CHUNKS
    return click.option(
        "--largest-chunk",
        type=WholeRange(low, high, "MiB"),
        default=largest_chunk.get(),
        show_default=True,
        metavar="MIB",
        expose_value=False,
        callback=lambda _context, _parameter, value: largest_chunk.set(value),
        help="Largest size in MiB of a decompressed chunk, or of any other record, of a bag; a bag with a larger one "
        "is refused.",
    )(command)


vehicle_option = click.option(
    "--vehicle",
    default=None,
    metavar="NAME|FILE",
    help=f"Name of an included vehicle, or a vehicle file.  [default: {DEFAULT_VEHICLE}]",
)


def known_law(_context, _parameter, value):
    """Callback of an option that names a control law: refuse one that cannot be loaded."""
    from mr_mount_controller.laws import ParameterError, find_law  # imported late: --help need not wait for it

    if value is not None:
        try:
            find_law(value)
        except ParameterError as error:
            raise click.BadParameter(str(error)) from None
    return value


class _LawOption(click.Option):
    """An option whose help names the laws that installed packages offer, when it is asked for."""

    def get_help_record(self, ctx):
        from mr_mount_controller.laws import known_laws  # imported late, as above

        plain, self.help = self.help, f"{self.help}: {', '.join(known_laws())}, or package.module:Class."
        try:
            return super().get_help_record(ctx)
        finally:
            self.help = plain


def law_option(name, **settings):
    """The option `name` for a control law, with further settings of `click.option`."""
    return click.option(name, cls=_LawOption, callback=known_law, **settings)


def on_command_line(context, names):
    """Return those of a verb's options, called by `names`, that were given on the command line."""
    return [name for name in names if context.get_parameter_source(name) is ParameterSource.COMMANDLINE]
