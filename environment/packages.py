"""Python packages of the environment: the lock's, installed by pip into a virtual environment of its own.

A change in this file makes every stage of the set-up anew: its own text is among what they depend on.
"""

import os
import re
import shutil
from contextlib import suppress

from environment import SetupError, network
from environment.extras import Extra
from environment.places import Places, Setup
from environment.steps import Task, hash_of

_PROBE = 4  # s that the first package's server may be silent
_LARGE = 100_000  # bytes; what smaller files have in common is not worth a look

# What the kernels are compiled with, and what that needs in turn: installed first, for compiling takes longest.
_COMPILED_WITH = (
    "annotated-types", "lazy-loader", "llvmlite", "numba", "numpy", "packaging", "pydantic", "pydantic-core", "pyyaml",
    "scipy", "typing-extensions", "typing-inspection",
)  # fmt: skip


def make_library(setup: Setup, task: Task) -> None:
    """Make the virtual environment, with what the kernels are compiled with."""
    places, ros, python = setup
    env = _for_pip()
    share = ["--system-site-packages"] if ros.prefix else []
    task.run([python.path, "-I", "-m", "venv", *share, str(places.venv)], env)
    try:  # the first package also shows, soon, whether packages can be had at all
        _install(setup, ("setuptools",), ["--retries=0", f"--timeout={_PROBE}"], env, task)
    except SetupError as error:
        raise SetupError(f"{error}\n{network.settings(env)}") from None
    _install(setup, _COMPILED_WITH, [], env, task)


def make_packages(setup: Setup, task: Task) -> None:
    """Install all that the lock has; this stage's folder only says that it is there."""
    # empy comes as source: it is built with the lock's setuptools, which is there, not with what pip would fetch.
    task.run([*_pip(setup.places), "--no-build-isolation", "-r", str(setup.lock_file)], _for_pip())
    _leave_what_is_used(setup)


def make_extra(setup: Setup, extra: Extra, task: Task) -> None:
    """Install an extra's packages into the environment; its folder only says that they are there."""
    places, _, python = setup
    if tuple(map(int, python.version.split(".")[:2])) < extra.python:
        wanted = ".".join(map(str, extra.python))
        raise SetupError(f"{extra.what} needs Python {wanted} or later, this environment has {python.version}")
    task.run([*_pip(places), "--only-binary=:all:", "-r", str(extra.lock(places))], _for_pip())
    _leave_what_is_used(setup)


def _pip(places: Places) -> list:
    """pip as far as the packages; a lock is complete, so nothing has to be resolved.

    It compiles no module: few of them are ever imported (`stages.py`).
    """
    # -I keeps pip from counting what lies under ~/.local
    pip = [str(places.python), "-I", "-m", "pip", "--disable-pip-version-check", "--no-input", "install"]
    return [*pip, "--no-deps", "--no-compile", "--require-hashes", "--progress-bar=off"]


def _for_pip() -> dict:
    """The user's variables, without those that would lead pip astray."""
    env = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    env["PIP_USER"] = "0"  # a user's configuration may ask for --user, which venv's pip refuses
    env.pop("PIP_CONSTRAINT", None)  # the lock says it all
    return env


def _install(setup: Setup, names: tuple, options: list, env: dict, task: Task) -> None:
    """Install some packages of the lock."""
    chosen = setup.places.venv / "chosen.txt"
    entry = rf"^(?:{'|'.join(map(re.escape, names))})==(?:.*\\\n)*.*"
    chosen.write_text("\n".join(re.findall(entry, setup.lock_file.read_text(), re.MULTILINE)))
    task.run([*_pip(setup.places), *options, "-r", str(chosen)], env)


def _leave_what_is_used(setup: Setup) -> None:
    """Remove the packages' own tests; keep one copy of a large file that lies under several names.

    A wheel has no links, so it has copies instead.
    """
    for tests in [path for path in setup.places.venv.glob("lib/python*/site-packages/**/tests") if path.is_dir()]:
        shutil.rmtree(tests, ignore_errors=True)  # it may lie in another one
    kept = {}
    for path in list(setup.places.venv.rglob("*")):
        if path.is_symlink() or not path.is_file() or path.stat().st_size < _LARGE:
            continue
        first = kept.setdefault((hash_of(path), path.stat().st_mode), path)
        if not first.samefile(path):  # for an extra this is done once more
            link = path.with_name(f"{path.name}.link")
            with suppress(OSError):  # not every file system has links
                link.hardlink_to(first)
                link.replace(path)
