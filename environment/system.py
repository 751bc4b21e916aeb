"""What the machine itself has to provide: a C++ compiler, Python's headers and venv. Missing ones come from apt."""

import contextlib
import os
import shlex
import shutil
import subprocess
import sys
from typing import NamedTuple

from environment import SetupError
from environment.steps import Task

# Asks an interpreter for its version, for the folder of its headers, and whether it can make virtual environments.
_QUESTION = """
import importlib.util, os, platform, sysconfig
print(platform.python_version())
print(sysconfig.get_path("include"))
print(bool(importlib.util.find_spec("venv") and importlib.util.find_spec("ensurepip")))
"""


class Interpreter(NamedTuple):
    """A Python, by the real path of its program."""

    path: str
    version: str


def running() -> Interpreter:
    """The Python that runs this, or the one that its virtual environment was made with."""
    path = getattr(sys, "_base_executable", None) or sys.executable
    return at(path)


def at(path: str) -> Interpreter:
    """The Python at `path`."""
    return Interpreter(os.path.realpath(path), _ask(path)[0])


def require(python: Interpreter, log) -> None:
    """See to it that the compiler, `python`'s headers and venv are there, with apt-get if this user may.

    Raises SetupError, with the exact line to type, if something is missing and cannot be installed from here.
    """
    missing = _missing(python)
    if not missing:
        return
    packages = list(missing)
    listed = ", ".join(f"{what} ({package})" for package, what in missing.items())
    if not shutil.which("apt-get"):
        raise SetupError(f"missing on this machine: {listed}. Install them and start again.")
    install = ["apt-get", "install", "-y", "--no-install-recommends", *packages]
    if os.geteuid() == 0:
        become_root = []
    elif _sudo_without_password():
        become_root = ["sudo", "-n"]
    else:
        line = f"apt-get update && {shlex.join(install)}"
        line = f"sudo sh -c '{line}'" if shutil.which("sudo") else f"su -c '{line}'"
        raise SetupError(
            f"missing on this machine: {listed}. Nothing has been changed yet. Run this, then start again:\n{line}"
        )
    quiet = [*become_root, "env", "DEBIAN_FRONTEND=noninteractive"]
    with Task(f"installing with apt-get: {' '.join(packages)}", "about 1 min", log) as task:
        with contextlib.suppress(SetupError):  # one broken source is no harm if the others have the packages
            task.run([*quiet, "apt-get", "update"], dict(os.environ), own_group=False)
        task.run([*quiet, *install], dict(os.environ), own_group=False)
    left = _missing(python)
    if left:
        raise SetupError(f"still missing after apt-get install: {', '.join(left.values())}. Its output: {log}")


def _missing(python: Interpreter) -> dict:
    """What is missing: the name of the package that has it, and what it is."""
    version, include, has_venv = _ask(python.path)
    series = "python" + ".".join(version.split(".")[:2])
    missing = {}
    if not any(shutil.which(name) for name in ("c++", "g++", "clang++")):
        missing["g++"] = "a C++ compiler"
    if not os.path.exists(os.path.join(include, "Python.h")):
        missing[f"{series}-dev"] = f"the headers of Python {version}"
    if has_venv != "True":
        missing[f"{series}-venv"] = f"venv of Python {version}"
    # apt knows the distribution's own interpreter only; its headers would be of no use to another one.
    if missing and not python.path.startswith("/usr/bin/"):
        own = [what for package, what in missing.items() if package != "g++"]
        if own:
            raise SetupError(
                f"{python.path} came without {' and '.join(own)} (looked in {include}). "
                "Reinstall it with them, or start again with another Python: /usr/bin/python3 ./trackvib ..."
            )
    return missing


def _ask(path: str) -> list:
    done = subprocess.run([path, "-I", "-c", _QUESTION], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        raise SetupError(f"{path} does not work:\n{done.stderr.strip()}")
    return done.stdout.splitlines()


def _sudo_without_password() -> bool:
    if not shutil.which("sudo"):
        return False
    return subprocess.run(["sudo", "-n", "true"], stdin=subprocess.DEVNULL, capture_output=True).returncode == 0
