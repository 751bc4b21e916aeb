"""What reaches the terminal: signs as they stand, never markup, never a control character from outside."""

from io import StringIO

import pytest
from mr_mount_controller.node_base.plain_text import readable, shortened
from rich.table import Table
from trackvib_sim.cli import main
from trackvib_sim.commands.endings import fail
from trackvib_sim.console import Terminal, followed

pytestmark = pytest.mark.property

HOSTILE = "[red]x[/] [/ \x1b]0;t\x07\x1b[2J \x9b1m \u202eback \r\n :smile:"
SHOWN = "[red]x[/] [/ \\x1b]0;t\\x07\\x1b[2J \\x9b1m \\u202eback \\r\\n :smile:"


def test_console_shows_strings_as_they_stand():
    """Printed, in a title, a heading and a cell of a table, and beside a bar."""
    file = StringIO()
    console = Terminal(file=file, width=400)
    table = Table(HOSTILE, title=HOSTILE)
    table.add_row(HOSTILE)
    console.print(HOSTILE, HOSTILE)
    console.print(table)
    assert file.getvalue().count(SHOWN) == 5
    assert file.getvalue().replace("\n", "").isprintable()


def test_bars_show_strings_as_they_stand():
    """Also in a terminal, where rich's own sequences are the only ones."""
    file = StringIO()
    assert list(followed(range(2), HOSTILE, Terminal(file=file, width=400, force_terminal=True))) == [0, 1]
    assert SHOWN in file.getvalue() and "\x1b]0" not in file.getvalue()


def test_errors_are_lines_of_signs(capsys):
    """As many as the error has, none of them endless; and the exit code is what is asked for."""
    with pytest.raises(SystemExit) as ended:
        fail(f"first \x1b[31m{MANY}\nsecond", 2, "cannot")
    assert ended.value.code == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first.startswith("cannot: first \\x1b[31m") and len(first) < 3000 and second == "second"


@pytest.mark.parametrize("word", [f"--{HOSTILE}", "--" + "x" * 10**5, HOSTILE, "x" * 10**5])
def test_arguments_are_quoted_as_signs(capsys, word):
    """What is no option and no verb, in a line that is not endless."""
    with pytest.raises(SystemExit) as ended:
        main.main([word], prog_name="trackvib")
    assert ended.value.code == 2
    lines = capsys.readouterr().err.splitlines()
    assert lines[-1].startswith("Error: No such") and all(line.isprintable() and len(line) < 3000 for line in lines)


MANY = "x" * 10**6


@pytest.mark.parametrize("text", ["plain", "Größe m/s²", "日本", "", "a b"])
def test_signs_stay(text):
    """Of any language."""
    assert readable(text) == text == shortened(text)
