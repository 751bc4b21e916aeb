"""The set-up as a table of contents: find ROS 2, do the stages that are not done, give the job's variables."""

import os
import re
import signal
import time
from functools import partial
from pathlib import Path

from environment import SetupError, steps, system
from environment import ros as ros2
from environment.places import Places, Setup
from environment.stages import job_variables, plan

# What the tools of the build take for itself in a path. CMake takes brackets for patterns and drops what is not ASCII;
# the build's commands go to a shell with nothing but their spaces quoted.
_UNUSABLE = re.compile(r"[^A-Za-z0-9 /._+=@~%-]")


def prepare(root: Path, extras: tuple = ()) -> dict:
    """Make the environment of the checkout at `root` ready, and `Extra`s; return the variables of a job in it.

    A stage is done if its folder holds a stamp with the right key, which is written last. Any other stage, never
    begun or interrupted or out of date, is wiped and done anew. Raises SetupError if that is not possible.
    """
    unusable = "".join(sorted(set(_UNUSABLE.findall(str(root)))))
    if unusable:
        raise SetupError(f"the checkout's path must not contain any of {unusable!r} (it is {str(root)!r}); move it.")
    places = Places(root)
    ros = ros2.find(os.environ)
    setup = Setup(places, ros, _interpreter(places, ros))
    stages = plan(setup, extras)
    if not all(map(_is_done, stages.values())):
        began = time.monotonic()
        for stop in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(stop, _interrupt)
        with steps.only_one(places.lock) as lock:
            _do(setup, extras, lock)
        steps.say(f"ready after {time.monotonic() - began:.0f} s")
    return job_variables(setup, stages["kernels"].key)


def _do(setup: Setup, extras: tuple, lock: int) -> None:
    log = setup.places.logs / "setup"

    def make(stage):
        if _is_done(stage):
            return
        with steps.Task(stage.what, stage.takes, log / f"{stage.name}.log", keep=(lock,)) as task:
            steps.wipe(stage.folder)
            stage.make(task)
            stamp = {"key": stage.key, "python": setup.python._asdict(), "ros": str(setup.ros.prefix)}
            steps.write_stamp(stage.folder, stamp)

    stages = plan(setup, extras)
    if not _is_done(stages["library"]):
        if not setup.ros.prefix:
            ros2.check_wheels(setup.python.version)
        system.require(setup.python, log / "apt.log")
    steps.side_by_side({stage.name: (stage.needs, partial(make, stage)) for stage in stages.values()})


def _is_done(stage) -> bool:
    stamp = steps.read_stamp(stage.folder)
    return stamp is not None and stamp["key"] == stage.key


def _interpreter(places: Places, ros: ros2.Ros) -> system.Interpreter:
    """The Python that the environment was made with, as long as it is there; else the one to make it with.

    So a job does not depend on which `python3` happens to be first on PATH today.
    """
    stamp = steps.read_stamp(places.venv)
    if stamp and stamp["ros"] == str(ros.prefix):
        python = system.Interpreter(**stamp["python"])
        if os.path.exists(python.path) and os.path.realpath(places.python) == python.path:
            return python
    return system.at(ros2.interpreter(ros)) if ros.prefix else system.running()


def _interrupt(*_) -> None:
    raise KeyboardInterrupt
