"""A process with nodes in it: ROS 2 started by its own arguments, a clean end on SIGINT and SIGTERM, an exit code."""

import gc
import signal
import sys
import traceback
from pathlib import Path

import rclpy
from rclpy._rclpy_pybind11 import RCLError, UnknownROSArgsError
from rclpy.experimental import EventsExecutor
from rclpy.logging import LoggingSeverity, get_logger, set_logger_level
from rclpy.signals import SignalHandlerOptions

from .endings import ERROR, REFUSED, TRACEBACK
from .help_text import help_text, wants_help
from .loop_node import NodeError
from .parameter_files import without_effect
from .parameters import ParameterError
from .plain_text import plain_line
from .scheduling import wake_on_time
from .shared_memory import remove_unfinished_segments

_ACCEPTED = (
    "accepted: --ros-args and then -p NAME:=VALUE, -r FROM:=TO, --params-file FILE, --log-level LEVEL "
    "and the others of ROS 2"
)


def start_ros(args=()):
    """Start ROS 2 without signal handlers of its own, and without what killed processes left in its way.

    Raises
    ------
    ParameterError
        The arguments, the program's name first, are not those of ROS 2.
    """
    if foreign := _outside(args[1:]):
        raise ParameterError(f"arguments {foreign} are not known; {_ACCEPTED}")
    remove_unfinished_segments()
    set_logger_level("rcl", LoggingSeverity.FATAL)  # it says for itself, in more words, what the error says
    try:
        rclpy.init(args=list(args), signal_handler_options=SignalHandlerOptions.NO)
    except UnknownROSArgsError as error:
        raise ParameterError(f"arguments of ROS 2 {error} are not known; {_ACCEPTED}") from None
    except RCLError as error:
        if "Couldn't parse" not in str(error):
            raise
        # what follows is a place in its parser's source
        reason = str(error).removeprefix("failed to initialize rcl: ").split(". Error:")[0].split(", at /")[0]
        raise ParameterError(f"arguments of ROS 2: {reason.rstrip('.')}; {_ACCEPTED}") from None
    except UnicodeEncodeError as error:
        raise ParameterError(f"argument {error.object!r} is not UTF-8 text; {_ACCEPTED}") from None
    finally:
        set_logger_level("rcl", LoggingSeverity.UNSET)


def _outside(words):
    """Return the words that are not between --ros-args and --; of these ROS takes `a:=b` for a remapping."""
    outside, of_ros = [], False
    for word in words:
        if word == ("--" if of_ros else "--ros-args"):
            of_ros = not of_ros
        elif not of_ros:
            outside.append(word)
    return outside


def run_node(make_node, args=None, companions=()):
    """Make a node, run it until it ends or a signal asks it to, and return the process's exit code.

    Further nodes, made by `companions`, share its process and executor: they answer callbacks while it waits. The
    signals only set a flag, once; rclpy's own handlers end a node in the middle of whatever it does.
    """
    arguments = sys.argv if args is None else args
    if wants_help(arguments):
        print(help_text(Path(arguments[0]).name, [make_node, *companions]))
        return 0
    stop = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.append(True))
    nodes = []
    try:
        start_ros(arguments)
        executor = EventsExecutor()

        def spin(timeout):
            executor.spin_once(timeout_sec=timeout)
            for node in nodes:
                node.raise_failure()

        for make in (*companions, make_node):
            nodes.append(make())
            nodes[-1].refuse_unknown_parameters(arguments)
            nodes[-1].prepare(spin, lambda: bool(stop))
            executor.add_node(nodes[-1])
        for words in without_effect(arguments, [node.get_fully_qualified_name() for node in nodes]):
            nodes[-1].get_logger().warning(plain_line(words))
        gc.freeze()  # what the start has made stays; looking through it again would hold up a period
        wake_on_time()
        try:
            nodes[-1].run()
        finally:
            for node in reversed(nodes):
                node.close()
                if node.refused:
                    node.get_logger().warning(f"{node.refused} messages were refused")
            executor.shutdown()
    except (ParameterError, NodeError, RCLError) as error:
        if error.__cause__ is not None:  # of a user's own code
            for line in "".join(traceback.format_exception(error.__cause__)).splitlines():
                get_logger(TRACEBACK).debug(plain_line(line))
        print(f"{ERROR}{plain_line(str(error))}", file=sys.stderr)
        return REFUSED if isinstance(error, ParameterError) else 1
    finally:
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0
