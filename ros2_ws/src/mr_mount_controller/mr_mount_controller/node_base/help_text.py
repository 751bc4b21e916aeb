"""What an executable says of itself when it is asked for help: parameters, topics, services. Nothing is started."""

import sys
from inspect import getdoc
from textwrap import fill

from .topic_table import TOPICS

_WIDTH = 100
_WORDS = ("-h", "--help")
_USAGE = """usage: {name} [--help] [--ros-args [-p NAME:=VALUE] [-r FROM:=TO] [--params-file FILE] [...]]"""


def wants_help(arguments):
    """Return whether a program's arguments, its name first, ask for help."""
    return any(word in _WORDS for word in arguments[1:])


def help_text(program, nodes):
    """Return the help of a program.

    Parameters
    ----------
    program : str
        Its name.
    nodes : list of type
        Classes of its nodes, as `loop_node.LoopNode`; parameters of several are given by the node's name.
    """
    about = (getdoc(sys.modules[node.__module__]) for node in nodes)
    parts = [_USAGE.format(name=program), "\n".join(about)]
    for node in nodes:
        prefix = f"{node.NAME}:" if len(nodes) > 1 else ""
        for title, parameters in node.parameters_by_title().items():
            parts.append("\n".join([f"{title}:", *(_parameter(prefix, each) for each in parameters)]))
        published = [each for each in TOPICS if each.publisher == node.NAME]
        heard = [each for each in TOPICS if node.NAME in each.readers]
        for title, topics in (("publishes", published), ("subscribes to", heard)):
            if topics:
                lines = (_topic(each) for each in topics)
                parts.append("\n".join([f"{node.NAME} {title}:", *lines]))
        if node.SERVICES:
            lines = (_block(f"{node.NAME}/{name}  ({kind})", meaning) for name, kind, meaning in node.SERVICES)
            parts.append("\n".join([f"services of {node.NAME}:", *lines]))
    return "\n\n".join(parts)


def _parameter(prefix, parameter):
    default = parameter.default
    if isinstance(default, list):
        shown = f"[{', '.join(default)}]"
    else:
        shown = str(default).lower() if isinstance(default, bool) else default
    return _block(f"{prefix}{parameter.name}:={shown}", f"{parameter.description} Accepted: {parameter.accepted}.")


def _topic(topic):
    rate = topic.rate.replace("`", "")
    return _block(f"{topic.name}  ({topic.type}, {rate})", topic.meaning.replace("`", ""))


def _block(head, text):
    indent = " " * 6
    return f"  {head}\n{fill(text, _WIDTH, initial_indent=indent, subsequent_indent=indent)}"
