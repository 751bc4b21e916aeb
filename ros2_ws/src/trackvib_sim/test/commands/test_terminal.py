"""What reaches the terminal: signs as they stand, never markup, never a control character from outside."""

from io import StringIO

import click
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


def _shown(**options):
    """Return the lines that a console shows of a table of names and numbers."""
    table = Table("scenario", "a_name_of_many_letters", title="title", title_justify="left")
    for name in ("over 1 A", "best law", "over best constant"):
        table.add_column(name, justify="right")
    for sign in "+-":
        law = "a_module_of_mine:ALawWithALongName"
        table.add_row("bump of 0.1 m x 1 m, 5 m/s", "powertrain_wk", f"{sign}12.345", law, f"{sign}123.456789")
    file = StringIO()
    Terminal(file=file, **options).print(table)
    return file.getvalue().splitlines()


def test_tables_in_a_pipe_are_whole(monkeypatch):
    """Each row is one line with all its words, however wide it is."""
    monkeypatch.delenv("COLUMNS", raising=False)
    lines = _shown()
    assert len(lines) == 7 and max(map(len, lines)) > 120
    assert sum("bump of 0.1 m x 1 m, 5 m/s" in line and "ALawWithALongName" in line for line in lines) == 2


@pytest.mark.parametrize("width", [100, 80, 60])
def test_tables_in_a_terminal_are_folded(width):
    """No line is wider than the terminal, nothing is left out, and each number is in one piece."""
    lines = _shown(width=width)
    text = "\n".join(lines)
    assert max(map(len, lines)) <= width and "\u2026" not in text
    laws = [line.split("│")[4].strip() for line in lines if "│" in line]
    assert "".join(laws) == "a_module_of_mine:ALawWithALongName" * 2
    for number in ("+12.345", "-12.345", "+123.456789", "-123.456789"):
        assert number in text


def test_numbers_are_whole_in_a_terminal_that_is_too_narrow():
    """Then lines are wider than it."""
    lines = _shown(width=20)
    assert max(map(len, lines)) > 20 and "-123.456789" in "\n".join(lines) and "\u2026" not in "\n".join(lines)


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["anlyze"], "analyze"),
        (["study", "controlers"], "controllers"),
        (["bag", "inf"], "info"),
        (["mount", "fti"], "fit"),
        (["run", "--law", "skyhok"], "skyhook"),
        (["replay", "bag", "--controller", "passiv"], "passive"),
        (["vehicle", "--vehicle", "leopard"], "leopard1"),
        (["road", "e"], "E"),
        (["study", "controllers", "--scenarios", "e11"], "e10"),
        (["mount", "--mount", "lfet"], "left"),
        (["compare", "a", "b", "--align", "sped"], "speed"),
    ],
)
def test_a_name_that_is_nearly_right(capsys, words, meant):
    """The error suggests what may have been meant."""
    with pytest.raises(SystemExit) as ended:
        main.main(words, prog_name="trackvib")
    assert ended.value.code in (1, 2)
    assert f"Did you mean '{meant}'?" in capsys.readouterr().err


def _options(command, path="trackvib"):
    context = click.Context(command, info_name=path)
    for option in command.params:
        if isinstance(option, click.Option) and not option.is_flag:
            yield path, option.opts[0], option.get_help_record(context)[1]
    if isinstance(command, click.Group):
        for name in command.list_commands(context):
            yield from _options(command.get_command(context, name), f"{path} {name}")


def test_help_tells_every_default():
    """Of each option that takes a value; but for two of `replay`, of which one or the other is needed."""
    found = list(_options(main))
    assert len(found) > 80
    silent = {(verb, option) for verb, option, words in found if "[default: " not in words}
    assert silent == {("trackvib replay", "--law"), ("trackvib replay", "--controller")}


@pytest.mark.parametrize("verb", [[], ["study"]])
def test_lists_of_verbs_are_whole(capsys, verb):
    """What each does is a whole sentence."""
    with pytest.raises(SystemExit):
        main.main([*verb, "--help"], prog_name="trackvib")
    assert "..." not in capsys.readouterr().out.replace("[ARGS]...", "")


MANY = "x" * 10**6


@pytest.mark.parametrize("text", ["plain", "Größe m/s²", "日本", "", "a b"])
def test_signs_stay(text):
    """Of any language."""
    assert readable(text) == text == shortened(text)
