"""What `ros2 ...` does: reads the arguments, hands them to the module that does the verb, ends in order."""

import importlib
import signal

from environment.ros2_stand_in.arguments import parser
from environment.ros2_stand_in.terminal import Failure, complain

INTERRUPTED = 130  # exit code of a shell's command that Ctrl-C has ended


def main(words: list) -> int:
    """Do a command; returns the exit code."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # so that `ros2 topic echo ... | head` ends without a word
    commands = parser()
    chosen = commands.parse_args(words)
    if not hasattr(chosen, "module"):
        getattr(chosen, "shown", commands).print_help()
        return 0
    try:
        module = importlib.import_module(f"environment.ros2_stand_in.{chosen.module}")
        return getattr(module, chosen.function)(chosen) or 0
    except Failure as failure:
        return complain(failure, 1)
    except ModuleNotFoundError as error:
        return complain(f"{error}; start it as: ./trackvib exec -- ros2 ...", 1)
    except KeyboardInterrupt:
        return INTERRUPTED
