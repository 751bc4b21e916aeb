"""The ROS 2 packages of the workspace: built by colcon, with links to the sources of those in Python."""

import json
import os
from pathlib import Path

from environment import SetupError, activate
from environment import ros as ros2
from environment.places import Places, Setup
from environment.ros import Ros
from environment.steps import Task, fingerprint, hash_of

# Files of a package that decide what colcon builds and installs; the contents of all others are live, through links.
_DECISIVE = {"package.xml", "CMakeLists.txt", "pyproject.toml", "setup.py", "setup.cfg"}
_INTERFACES = {".msg", ".srv", ".action"}
_OTHERS = {"test", "build"}  # folders that colcon does not install from; the second is left by pip

_SETTINGS = "workspace.cmake"


def workspace_key(setup: Setup) -> str:
    """Return what stands for all that the build depends on, beside the Python packages."""
    places = setup.places
    files = [hash_of(each) for each in (Path(__file__), places.environment / _SETTINGS)]
    return fingerprint([files, [_workspace_sources(folder) for folder in _packages(places, setup.ros)]])


def make_workspace(setup: Setup, task: Task) -> None:
    """Build all packages, and note what their set-up scripts change."""
    places, ros, python = setup
    script = ros.prefix and ros.prefix / "setup.bash"
    of_ros = ros2.changes(script, _bare()) if script and script.exists() else {"first": {}, "set": {}}
    install = places.workspace / "install"
    variables = _build_variables(setup, of_ros)
    try:
        task.run([*_colcon(places, ros, "parallel"), "--install-base", str(install)], variables)
    except SetupError:  # one package after the other, so that the log ends with the output of the one that fails
        task.run([*_colcon(places, ros, "sequential"), "--install-base", str(install)], variables)
    _mend_first_lines(install)
    # Sourced where nothing else was: what a variable holds already would not be seen as the workspace's.
    env = activate.before_workspace(places, ros, _bare())
    activate.apply(env, of_ros)
    # The script calls Python without quotes; the virtual environment's may lie in a path with a space.
    env["COLCON_PYTHON_EXECUTABLE"] = python.path
    captured = {"ros": of_ros, "workspace": ros2.changes(install / "local_setup.bash", env)}
    activate.captured_path(places).write_text(json.dumps(captured, indent=1))


def _build_variables(setup: Setup, of_ros: dict) -> dict:
    """The user's variables (a compiler's, for example) with those of ROS 2, for colcon."""
    places, ros, _ = setup
    env = activate.before_workspace(places, ros, activate.outside(os.environ))
    if not ros.sourced:
        activate.apply(env, of_ros)
        activate.put_first(env, "PATH", [str(places.venv / "bin")])
    # A user's own defaults for colcon could ask for other folders or another kind of build.
    env.update(COLCON_HOME=str(places.workspace / "colcon"), COLCON_LOG_PATH=str(places.logs / "colcon"))
    env.pop("COLCON_DEFAULTS_FILE", None)
    env.pop("PYTHONDONTWRITEBYTECODE", None)  # dozens of generators start, which import the same modules
    return env


def _colcon(places: Places, ros: Ros, executor: str) -> list:
    """The command that builds the workspace, up to the folder to install to."""
    cmake = ["-G", "Ninja", f"-DPython3_EXECUTABLE={places.python}", "-DBUILD_TESTING=OFF"]
    cmake += [f"-DCMAKE_PROJECT_INCLUDE={places.environment / _SETTINGS}", f"-DFROM_WHEELS={not ros.prefix}"]
    # Not the `colcon` script: its first line cannot name an interpreter whose path has a space.
    colcon = [str(places.python), "-c", "import sys; from colcon_core.command import main; sys.exit(main())", "build"]
    how = ["--symlink-install", "--executor", executor, "--cmake-args", *cmake]
    shows = ["--event-handlers", "console_cohesion+", "console_stderr-", "desktop_notification-", "status-"]
    bases = map(str, _packages(places, ros))
    return [*colcon, *how, *shows, "--base-paths", *bases, "--build-base", str(places.workspace / "build")]


def _packages(places: Places, ros: Ros) -> list:
    """Folders with ROS 2 packages: ours, and of the standard interfaces those that ROS 2 comes without."""
    there = ros.prefix / "share" if ros.prefix else None
    return [places.sources, *(each for each in places.interfaces if there is None or not (there / each.name).is_dir())]


def _mend_first_lines(install: Path) -> None:
    """Let the nodes' programs start where the checkout's path has a space.

    setuptools then writes `#!"/a path/python3"`, which the system cannot run; `/bin/sh` can, with the words that pip
    uses: a string to Python, a command to the shell.
    """
    for program in install.glob("*/lib/*/*"):
        if program.is_file() and program.read_bytes().startswith(b'#!"'):
            first, rest = program.read_text().split("\n", 1)
            interpreter = first[2:]
            program.write_text(f"#!/bin/sh\n'''exec' {interpreter} \"$0\" \"$@\"\n' '''\n{rest}")


def _bare() -> dict:
    """Variables of a shell in which nothing was sourced."""
    return {"PATH": "/usr/local/bin:/usr/bin:/bin", "HOME": os.environ.get("HOME", "/")}


def _workspace_sources(folder: Path) -> list:
    """Every file that colcon sees, with a hash where its contents decide; no modules and no tests: those are live."""
    found = []
    for parent, folders, files in os.walk(folder):
        folders[:] = sorted(each for each in folders if not each.startswith((".", "__")) and each not in _OTHERS)
        folders[:] = [each for each in folders if not each.endswith(".egg-info")]
        if "__init__.py" in files and "package.xml" not in files:
            folders.clear()
            continue
        for name in sorted(files):
            path = Path(parent, name)
            decisive = name in _DECISIVE or path.suffix in _INTERFACES
            if decisive or path.suffix != ".pyc":
                found.append([str(path.relative_to(folder)), hash_of(path) if decisive else None])
    return found
