"""What a process forked from the tests' server does: it becomes a node by the entry point of its executable."""

import ctypes
import os
import sys
from importlib.metadata import entry_points

from trackvib_sim.nodes.processes import end_with_parent


def become(name, arguments, log, env, folder):
    """Run a node as its executable does, to the end of the process: never returns.

    Parameters
    ----------
    name : str
        Of the executable.
    arguments : list of str
    log : path
        Takes what it prints.
    env : dict
    folder : path
        Where it runs.
    """
    os.setsid()
    end_with_parent()
    for path, flags, numbers in ((os.devnull, os.O_RDONLY, (0,)), (log, os.O_WRONLY, (1, 2))):
        file = os.open(path, flags)
        for number in numbers:
            os.dup2(file, number)
        os.close(file)
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(write_through=True)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(folder)
    sys.path[:0] = [path for path in env.get("PYTHONPATH", "").split(os.pathsep) if path and path not in sys.path]
    sys.argv = [name, *arguments]
    (entry,) = {(each.module, each.attr): each for each in entry_points(group="console_scripts", name=name)}.values()
    try:
        code = entry.load()()
    except SystemExit as end:
        code = end.code
    # as Python itself ends: multiprocessing would leave out what libraries do at the end
    ctypes.pythonapi.Py_Exit(code or 0)
