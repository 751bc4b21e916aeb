"""The verbs of the stand-in and what each takes, as ros2cli's."""

import argparse
import sys

from environment.ros2_stand_in.terminal import complain

HZ_WINDOW = 10_000
TRUNCATED = 128


class _Parser(argparse.ArgumentParser):
    """Shows its usage with an error, without a word of the terminal's own language in it."""

    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(complain(message, 2))


def parser():
    """Return the parser; what it returns has `module` and `function` of the verb, or `shown`, whose help is wanted."""
    top = _Parser(prog="ros2", description="trackvib's stand-in for ROS 2's own command, which the wheels leave out.")
    commands = top.add_subparsers(title="commands", metavar="COMMAND")
    _run(commands)
    _launch(commands)
    for name, what, add in (
        ("topic", "list, look at and measure topics", _topic),
        ("node", "list and describe nodes", _node),
        ("param", "read and set parameters of nodes", _param),
        ("service", "list and call services", _service),
    ):
        command = commands.add_parser(name, help=what, description=what)
        command.set_defaults(shown=command)
        add(command.add_subparsers(title="verbs", metavar="VERB"))
    return top


def _verb(verbs, name, place, what):
    verb = verbs.add_parser(name, help=what, description=what)
    module, function = place.split(":")
    verb.set_defaults(module=module, function=function)
    return verb


def _run(commands):
    run = _verb(commands, "run", "programs:run", "run an executable of a package")
    run.add_argument("--prefix", help="command in front of the executable, such as 'gdb -ex run --args'")
    run.add_argument("package_name")
    run.add_argument("executable_name")
    run.add_argument("argv", nargs=argparse.REMAINDER, help="arguments of the executable")


def _launch(commands):
    launch = _verb(commands, "launch", "launching:launch", "run a launch file")
    launch.add_argument("-s", "--show-args", action="store_true", help="show the arguments of the launch file")
    launch.add_argument("package_name", help="package, or path of a launch file")
    launch.add_argument("words", nargs="*", metavar="...", help="launch file of the package, arguments as NAME:=VALUE")


def _looking(verb):
    verb.add_argument(
        "--spin-time",
        type=_seconds,
        default=1.0,
        help="seconds without a change after which the graph counts as complete",
    )
    verb.add_argument("--no-daemon", action="store_true", help="there is none; accepted as ros2cli's")


def _topic(verbs):
    every = _verb(verbs, "list", "topics:list_topics", "list topics")
    every.add_argument("-t", "--show-types", action="store_true", help="show the type of each")
    every.add_argument("-c", "--count-topics", action="store_true", help="only the number of them")
    every.add_argument("-v", "--verbose", action="store_true", help="by publishers and subscribers, with counts")
    every.add_argument("--include-hidden-topics", action="store_true")
    _looking(every)
    info = _verb(verbs, "info", "topics:info", "type and ends of a topic")
    info.add_argument("topic_name")
    info.add_argument("-v", "--verbose", action="store_true", help="each end with its node and quality of service")
    _looking(info)
    _echo(_verb(verbs, "echo", "echo:echo", "print messages of a topic"))
    hz = _verb(verbs, "hz", "rates:hz", "print at what rate messages arrive")
    hz.add_argument("topic_name")
    hz.add_argument(
        "-w", "--window", type=_count, default=HZ_WINDOW, metavar="N", help="window of messages to average over"
    )
    hz.add_argument("--wall-time", action="store_true", help="always so here; accepted as ros2cli's")
    _looking(hz)


def _echo(echo):
    echo.add_argument("topic_name")
    echo.add_argument("message_type", nargs="?", help="found by the topic if not given")
    echo.add_argument("--once", action="store_true", help="end after the first message")
    echo.add_argument("--field", metavar="PATH", help="a part of the message, as twist.linear.x or values[0]")
    echo.add_argument("--csv", action="store_true", help="one line per message")
    echo.add_argument("-f", "--full-length", action="store_true", help="all of long arrays and texts")
    echo.add_argument("-l", "--truncate-length", type=_count, default=TRUNCATED, metavar="N", help="what is long")
    echo.add_argument("--flow-style", action="store_true", help="collections in one line each")
    echo.add_argument("--no-arr", action="store_true", help="only type and length of arrays")
    echo.add_argument("--no-str", action="store_true", help="only length of texts")
    echo.add_argument("--timeout", type=_seconds, metavar="N", help="end after so many seconds")
    echo.add_argument("--qos-depth", type=_count, metavar="N")
    echo.add_argument("--qos-reliability", choices=("reliable", "best_effort"))
    echo.add_argument("--qos-durability", choices=("volatile", "transient_local"))
    _looking(echo)


def _node(verbs):
    every = _verb(verbs, "list", "nodes:list_nodes", "list nodes")
    every.add_argument("-a", "--all", action="store_true", help="hidden ones, too")
    every.add_argument("-c", "--count-nodes", action="store_true", help="only the number of them")
    _looking(every)
    info = _verb(verbs, "info", "nodes:info", "topics, services and actions of a node")
    info.add_argument("node_name")
    info.add_argument("--include-hidden", action="store_true")
    _looking(info)


def _param(verbs):
    every = _verb(verbs, "list", "parameters:list_parameters", "list parameters")
    every.add_argument("node_name", nargs="?")
    every.add_argument("--include-hidden-nodes", action="store_true")
    every.add_argument("--param-prefixes", nargs="+", default=[], metavar="PREFIX")
    every.add_argument("--param-type", action="store_true", help="show the type of each")
    _looking(every)
    for name, function, what in (
        ("get", "get", "value of a parameter"),
        ("set", "set_one", "change a parameter"),
        ("describe", "describe", "type, range and meaning of parameters"),
        ("dump", "dump", "all parameters of a node, as a file for --params-file"),
    ):
        verb = _verb(verbs, name, f"parameters:{function}", what)
        verb.add_argument("node_name")
        if name in ("get", "set"):
            verb.add_argument("parameter_name")
        if name == "set":
            verb.add_argument("value", help="in YAML")
        if name == "get":
            verb.add_argument("--hide-type", action="store_true")
        if name == "describe":
            verb.add_argument("parameter_names", nargs="+")
        verb.add_argument("--include-hidden-nodes", action="store_true", help="always so here; accepted as ros2cli's")
        verb.add_argument("--timeout", type=_seconds, default=5.0, metavar="N", help="s to wait for the node")
        _looking(verb)


def _service(verbs):
    every = _verb(verbs, "list", "services:list_services", "list services")
    every.add_argument("-t", "--show-types", action="store_true", help="show the type of each")
    every.add_argument("-c", "--count-services", action="store_true", help="only the number of them")
    every.add_argument("--include-hidden-services", action="store_true")
    _looking(every)
    call = _verb(verbs, "call", "services:call", "call a service")
    call.add_argument("service_name")
    call.add_argument("service_type", help="as std_srvs/srv/Trigger")
    call.add_argument("values", nargs="?", default="{}", help="the request's fields in YAML")
    call.add_argument("-r", "--rate", type=_rate, metavar="N", help="again and again, at this rate in Hz")


def _count(text):
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"{text!r}, accepted: a whole number from 1 on")
    return int(text)


def _seconds(text):
    return _number(text, 0.0)


def _rate(text):
    return _number(text, 1e-6)


def _number(text, low):
    try:
        number = float(text)
    except ValueError:
        number = -1.0
    if not low <= number <= 1e6:
        raise argparse.ArgumentTypeError(f"{text!r}, accepted: a number from {low:g} to 1000000")
    return number
