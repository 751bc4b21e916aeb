"""The command line: `trackvib VERB`."""

import atexit
import gc
import signal
import sys
from contextlib import contextmanager
from importlib import import_module

import click
from mr_mount_controller.node_base.interrupts import ENDING
from mr_mount_controller.node_base.plain_text import plain_line

from .commands.endings import INTERRUPTED, UNREAD, fail, say
from .commands.lasting_output import OutputLost, OutputUnread, lasting_output
from .commands.verbs import Verbs

# Where each verb's command line lies; it is imported when the verb is asked for, so that no verb waits for another's.
_VERBS = {
    "analyze": "analyze_cli",
    "bag": "bag_cli",
    "compare": "compare_cli",
    "fmu": "fmu_cli",
    "modes": "vehicle_cli",
    "mount": "mount_cli",
    "replay": "replay_cli",
    "road": "road_cli",
    "run": "run_cli",
    "study": "study_cli",
    "vehicle": "vehicle_cli",
    "view": "view_cli",
}


class _AllVerbs(Verbs):
    """Ctrl-C at any moment ends a verb in one line, with the exit code that shells know it by.

    So does standard output that breaks off, once the verb's work is done; quietly where nobody reads it any more.
    """

    def list_commands(self, context):
        return sorted(_VERBS)

    def get_command(self, context, name):
        if name in _VERBS:
            return getattr(import_module(f".commands.{_VERBS[name]}", __package__), name)
        return None

    def resolve_command(self, context, arguments):
        if arguments[0] not in _VERBS:
            raise click.NoSuchCommand(arguments[0], possibilities=_VERBS, ctx=context)
        return super().resolve_command(context, arguments)

    def make_context(self, *arguments, **extra):
        with _plain_errors(), _ended_output():
            return super().make_context(*arguments, **extra)

    def invoke(self, context):
        try:
            with _plain_errors(), _ended_output():
                return super().invoke(context)
        except KeyboardInterrupt as interrupt:
            say("; ".join(("interrupted", *interrupt.args)))
            sys.exit(INTERRUPTED)


@contextmanager
def _ended_output():
    """Let the block do all its work; end the process after it if not all that it printed has arrived."""
    try:
        with lasting_output():
            yield
    except OutputUnread:
        sys.exit(UNREAD)
    except OutputLost as error:
        fail(error)


@contextmanager
def _plain_errors():
    """Make a plain line of what is wrong with the arguments: it quotes them, and they may name a file."""
    try:
        yield
    except click.ClickException as error:
        error.message = plain_line(error.message)
        raise


@click.group(cls=_AllVerbs, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
def main():
    """Vibration laboratory for a tracked vehicle's powertrain on magnetorheological mounts."""
    # An orderly end, as on Ctrl-C, when the terminal is closed or the process is asked to end; a job started in the
    # background of a script would otherwise ignore Ctrl-C.
    for number in ENDING:
        signal.signal(number, lambda *_: _interrupt())
    # What libraries make when they are loaded stays. To look through it for garbage time and again, and once more at
    # the end, takes a quarter of a short verb.
    gc.set_threshold(100_000)
    atexit.register(gc.freeze)


def _interrupt():
    raise KeyboardInterrupt


if __name__ == "__main__":
    main(prog_name="trackvib")
