"""Lines of arguments of every verb, with odd values, and in each at least one thing that no verb accepts."""

import os
import sys
import tempfile
from pathlib import Path

import click
from trackvib_sim.cli import main

from .odd_values import CONTROL, LAWS, NUMBERS, PLACES, TEXTS
from .trial import Wrong, captured, flaw

REFUSALS = ()  # all end in an exit code
BROKEN = {
    "broken_law": "1 / 0",
    "leaving_law": "raise SystemExit",
    "no_python_law": "law (",
    "endless_law": "def f(): f()\nf()",
    "silent_law": "raise KeyError",
    "odd_law": f"raise RuntimeError({CONTROL!r})",
}
NONSENSE = ("--nonsense", "--nonsense=1", "-Z", f"--{CONTROL}", "--" + "x" * 5000, "--\udcff=x")
NOWHERE = ("/dev/null/x", "/proc/nowhere/x", f"/proc/{CONTROL}/x", "x" * 300 + "/x")
SCHEDULERS = ("", "x", "tcp://", "tcp://127.0.0.1:1", "tcp://127.0.0.1:x", "tls://127.0.0.1:1", "http://127.0.0.1:1",
              "tcp://127.0.0.1:99999999", "ucx://x", "inproc://x", CONTROL, "tcp://[::1")  # fmt: skip


def trials(chance, count):
    """Yield so many lines of arguments."""
    leaves = list(_leaves(main, ()))
    before = os.getcwd()
    with tempfile.TemporaryDirectory() as folder:
        for name, text in BROKEN.items():
            (Path(folder) / f"{name}.py").write_text(text)
        sys.path.insert(0, folder)
        os.chdir(folder)
        try:
            for _ in range(count):
                words = _line(*chance.choice(leaves), chance)
                yield " ".join(ascii(word)[:60] for word in words), lambda words=words: _attempt(words)
        finally:
            os.chdir(before)
            sys.path.remove(folder)


def _leaves(command, path):
    """Yield the words that lead to every command that is not a group, and the command."""
    if isinstance(command, click.Group):
        context = click.Context(command)
        for name in command.list_commands(context):
            yield from _leaves(command.get_command(context, name), (*path, name))
    else:
        yield path, command


def _line(path, command, chance):
    """Return arguments: the verb, some options, and something wrong, whose option does not come again."""
    wrong, spoilt = _wrong(path, command, chance)
    odd = [option for option in _options(command) if option is not spoilt and chance.random() < 0.4]
    pieces = [_piece(option, _value(option, chance), chance) for option in odd]
    if _takes_arguments(command):  # no bag is there, so this alone is wrong
        pieces += [[chance.choice(PLACES)] for _ in range(chance.choice((0, 1, 1, 1, 2)))]
    pieces.append(wrong)
    chance.shuffle(pieces)
    words = [word for piece in pieces for word in piece]
    if chance.random() < 0.05:
        path = (*path[:-1], chance.choice((*TEXTS, "runn", path[-1].upper())))
    before = [chance.choice(NONSENSE)] if chance.random() < 0.03 else []
    return [*before, *path, *words]


def _takes_arguments(command):
    return any(isinstance(each, click.Argument) for each in command.params)


def _options(command):
    return [each for each in command.params if isinstance(each, click.Option)]


def _piece(option, value, chance):
    name = chance.choice(option.opts)
    if option.is_flag:
        return [name]
    return [f"{name}={value}"] if chance.random() < 0.5 else [name, value]


def _wrong(path, command, chance):
    """Return words that make a line wrong, and the option that they spoil, or None."""
    options = _options(command)
    if chance.random() < 0.3 or not options:
        return [chance.choice(NONSENSE)], None
    if chance.random() < 0.1 and not _takes_arguments(command):
        text = chance.choice([text for text in TEXTS if text != "--"])  # which alone says nothing
        return chance.choice(([text], ["--", "--nonsense"])), None
    option = chance.choice(options)
    if option.is_flag:
        return [f"{option.opts[0]}={chance.choice(TEXTS)}"], option
    return _piece(option, chance.choice(_never(path, option)), chance), option


def _never(path, option):
    """Return values of an option that are never accepted."""
    if isinstance(option.type, (click.IntRange, click.FloatRange)):
        too_short = ("0.1",) * 8 if option.name == "duration" else ()
        return "nan", "inf", "-1e9", "1e400", "x", "", CONTROL, "9" * 5000, *too_short
    if option.name in ("law", "laws", "controller"):
        return *TEXTS, *LAWS, *(f"{each}:Law" for each in BROKEN)
    if option.name == "out" and path != ("run",):
        return NOWHERE
    if option.name in ("vehicle", "plan"):
        return tuple(place for place in PLACES if place)  # an empty one stands for the file of the package
    if option.name == "scheduler":
        return SCHEDULERS
    if isinstance(option.type, click.Path):
        return "/", "/dev/null"  # of a run, before which folders are made
    return *TEXTS, "A,,B", ",", "nan,5", "5;10"


def _value(option, chance):
    """Return an odd value of an option, which may be accepted."""
    kind = option.type
    if isinstance(kind, (click.IntRange, click.FloatRange)):
        return chance.choice((*NUMBERS, str(kind.min), str(kind.max), str(option.default)))
    if isinstance(kind, click.Choice):
        return chance.choice((*kind.choices, *TEXTS))
    if option.name in ("law", "laws", "controller"):
        return chance.choice((*LAWS, *TEXTS, "skyhook", "external", "passive"))
    if isinstance(kind, click.Path):
        return chance.choice((*PLACES, *NOWHERE))
    return chance.choice((*TEXTS, *NUMBERS, str(option.default)))


def _attempt(words):
    code = None
    with captured() as said:
        try:
            main.main(words, prog_name="trackvib")
        except SystemExit as ending:
            code = ending.code
    if not isinstance(code, int) or code in (0, 130):
        raise Wrong(f"exit code {code}: {said.text[:200]!r}")
    if wrong := flaw(said.text):
        raise Wrong(wrong)
    return f"exit code {code}"
