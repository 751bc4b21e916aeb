"""Options that say which vehicle is driven, on which road and how: for every verb that drives one."""

import click

from ..nodes.loop_arguments import ARGUMENTS, SLOWEST_PHYSICS, default_of
from ..vehicle.drive.limits import FASTEST
from .option_types import FiniteRange, WholeRange, ZeroOr

_SETTINGS = {
    "vehicle": {"metavar": "NAME|FILE"},
    "road": {"metavar": "CLASS|FILE"},
    "speed": {"type": FiniteRange(-FASTEST, FASTEST, "m/s")},
    "drive": {"type": click.Path(exists=True, dir_okay=False)},
    "gears": {"is_flag": True},
    "seed": {"type": WholeRange(0, 10**9)},
    "physics_rate": {"type": ZeroOr(SLOWEST_PHYSICS, 200_000, "Hz")},
}


def loop_option(name, option=click.option, **settings):
    """Return the option of an argument of the loop; None where it is not given."""
    argument = ARGUMENTS[name]
    default = {} if settings.get("is_flag") else {"show_default": argument.default or "none"}
    return option(f"--{name.replace('_', '-')}", default=None, help=argument.description, **default, **settings)


def driving_options(command):
    """Give a command `--vehicle`, `--road`, `--speed`, `--drive`, `--gears`, `--seed` and `--physics-rate`."""
    for name in reversed(_SETTINGS):
        command = loop_option(name, **_SETTINGS[name])(command)
    return command


def with_defaults(given):
    """Return values of such options by name, with the arguments' defaults where none is given."""
    return {name: default_of(name) if value is None else value for name, value in given.items()}
