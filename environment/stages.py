"""The stages of the set-up: what each depends on, where it lies, what makes it."""

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

from environment import activate, packages
from environment.kernels import sources, usable
from environment.packages import make_extra, make_library, make_packages
from environment.places import Setup
from environment.steps import Task, fingerprint, hash_of
from environment.workspace import make_workspace, workspace_key


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
    beside = f"packages beside ROS 2 Jazzy of {ros.prefix}" if ros.prefix else "ROS 2 Jazzy from Python wheels"
    decisive = setup.lock_file, Path(packages.__file__)
    venv = fingerprint([str(places.root), list(python), str(ros.prefix), *map(hash_of, decisive)])
    workspace = fingerprint([venv, workspace_key(setup)])
    compiled = sources(places.sources / "trackvib_sim" / "trackvib_sim")
    kernels = fingerprint([venv, [[str(path), hash_of(path)] for path in compiled]])
    fetching = "about 1 min with a fast network"
    stages = [
        Stage("library", "setting up (once): what the simulation is compiled with", "about 20 s", places.venv, venv,
              partial(make_library, setup), None),
        Stage("kernels", "compiling the simulation", "about 60 s", places.kernels, kernels,
              partial(_make_kernels, setup, kernels), "library"),
        Stage("packages", f"setting up (once): {beside}", fetching, places.packages, venv,
              partial(make_packages, setup), "library"),
        Stage("workspace", "building the ROS 2 packages", "about 40 s", places.workspace, workspace,
              partial(make_workspace, setup), "packages"),
        Stage("modules", "importing all modules once", "about 5 s", places.modules, workspace,
              partial(_make_modules, setup, kernels), "workspace"),
    ]  # fmt: skip
    before = "packages"
    for extra in extras:  # one after the other, for two of them may bring the same package
        key = fingerprint([venv, hash_of(extra.lock(places))])
        what, make = f"setting up (once): {extra.what}", partial(make_extra, setup, extra)
        stages.append(Stage(extra.name, what, fetching, extra.folder(places), key, make, before))
        before = extra.name
    return {stage.name: stage for stage in stages}


def job_variables(setup: Setup, kernels: str) -> dict:
    """Variables for a job in the finished environment; `kernels` is the key of that stage."""
    return _with_kernels(activate.variables(setup.places, setup.ros, os.environ), setup, kernels)


def _with_kernels(env: dict, setup: Setup, key: str) -> dict:
    # numba looks at the file of a compiled function, not at those of the functions it calls: a folder per key
    return env | {"NUMBA_CACHE_DIR": str(usable(setup.places.kernels / key[:16], os.environ))}


def _make_kernels(setup: Setup, key: str, task: Task) -> None:
    places = setup.places
    env = activate.with_sources(activate.before_workspace(places, setup.ros, os.environ), places)
    _compile("trackvib_sim.compile_kernels", setup, _with_kernels(env, setup, key), task)


def _make_modules(setup: Setup, kernels: str, task: Task) -> None:
    _compile("trackvib_sim.compile_modules", setup, job_variables(setup, kernels), task)


def _compile(module: str, setup: Setup, env: dict, task: Task) -> None:
    """Run a module that compiles; Python then keeps what it has compiled of the modules itself."""
    env.pop("PYTHONDONTWRITEBYTECODE", None)
    task.run([str(setup.places.python), str(setup.places.starter), module], env)
