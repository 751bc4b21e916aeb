"""What a process forked from the tests' server does: it becomes a node or the command line."""

import importlib
import os
import sys
from importlib.metadata import entry_points

from trackvib_sim.nodes.forked_node import begin_program, run_program


def become(name, arguments, log, env, folder):
    """Run a program to the end of the process: never returns.

    Parameters
    ----------
    name : str
        Of an executable, or "trackvib" for the command line.
    arguments : list of str
    log : path
        Takes what it prints.
    env : dict
    folder : path
        Where it runs.
    """

    begin_program(name)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(folder)
    sys.path[:0] = [path for path in env.get("PYTHONPATH", "").split(os.pathsep) if path and path not in sys.path]
    run_program(_main(name), [name, *arguments], log)


def _main(name):
    if name == "trackvib":
        return importlib.import_module("trackvib_sim.cli").main
    (entry,) = {(each.module, each.attr): each for each in entry_points(group="console_scripts", name=name)}.values()
    return entry.load()
