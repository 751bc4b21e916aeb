"""The help of every numeric option tells the range and unit that are accepted, and a value beyond it is refused so."""

import re

import click
import pytest
from trackvib_sim.cli import main
from trackvib_sim.commands.option_types import Several

pytestmark = pytest.mark.property

NUMBER = r"-?\d+(?:\.\d+)?"
COUNTS = {"--seed", "--seeds", "--phases", "--generations", "--port", "--core", "--realtime-priority"}  # without a unit


def leaves(command, words=()):
    """Yield each command that has options of its own, with the words that lead to it."""
    yield words, command
    if isinstance(command, click.Group):
        for name in command.list_commands(click.Context(command)):
            yield from leaves(command.get_command(click.Context(command), name), (*words, name))


def numeric_options():
    """Yield words, option and the type of each of its numbers."""
    for words, command in leaves(main):
        for option in command.params:
            kind = option.type.item if isinstance(option.type, Several) else option.type
            if isinstance(kind, (click.IntRange, click.FloatRange)) or kind in (click.INT, click.FLOAT):
                yield pytest.param(words, option, kind, id=" ".join((*words, option.opts[0])))


@pytest.mark.parametrize("words, option, kind", list(numeric_options()))
def test_help_tells_what_is_accepted(words, option, kind):
    """Both bounds of the type, as plain numbers, and the unit."""
    assert kind.min is not None and kind.max is not None, "a number without bounds"
    name, text = option.get_help_record(click.Context(click.Command("verb")))
    told = [float(each) for each in re.findall(NUMBER, text)]
    assert kind.min in told and kind.max in told and "e+" not in text and "<=" not in text
    assert kind.unit or option.opts[0] in COUNTS
    for end, beyond in ((kind.min, kind.min - 1), (kind.max, kind.max + 1)):
        if not getattr(kind, "min_open", False):
            assert kind.convert(str(end), option, None) == end
        if beyond:  # 0 may stand for something else
            with pytest.raises(click.BadParameter, match=re.escape(kind._describe_range())):
                kind.convert(str(beyond), option, None)
