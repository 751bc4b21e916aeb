"""The environment variables that a job runs with."""

import contextlib
import json
import os
from pathlib import Path

from environment.own_folder import own_folder
from environment.places import Places
from environment.ros import Ros

# What a shell may carry from elsewhere (another workspace, ROS 1, a hand-set PYTHONPATH). With the wheels nothing of
# it fits; a machine's own ROS 2, on the other hand, is found through these.
_FOREIGN = ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH", "PYTHONPATH")

# Says that a shell was opened by this checkout's trackvib, so that what was added to its lists since is the user's.
_MARK = "TRACKVIB_ENVIRONMENT"


def captured_path(places: Places) -> Path:
    """File with what the set-up scripts of ROS 2 and of the workspace change (see `ros.changes`)."""
    return places.workspace / "environment.json"


def variables(places: Places, ros: Ros, environ) -> dict:
    """Variables for a job, from the user's `environ`; what the user set for ROS 2 stays as it is."""
    env = before_workspace(places, ros, environ)
    captured = json.loads(captured_path(places).read_text())
    if ros.prefix and not ros.sourced:
        apply(env, captured["ros"])
    apply(env, captured["workspace"])
    if ros.prefix is None and environ.get(_MARK) != str(places.root):
        _add_own_modules(env, places, environ.get("PYTHONPATH"))
    with_sources(env, places)
    # The virtual environment in front of everything, the stand-in for `ros2` behind: a real one wins.
    put_first(env, "PATH", [str(places.venv / "bin")])
    stand_in = str(places.environment / "bin")
    env["PATH"] = os.pathsep.join([e for e in env["PATH"].split(os.pathsep) if e != stand_in] + [stand_in])
    return env


def before_workspace(places: Places, ros: Ros, environ) -> dict:
    """Variables without those of the colcon workspace and of the machine's own ROS 2: what both are added to."""
    env = dict(environ)
    env.pop("PYTHONHOME", None)
    if ros.prefix is None:
        if env.get(_MARK) != str(places.root):
            for name in _FOREIGN:
                env.pop(name, None)
        apply(env, _wheels(places))
    put_first(env, "PATH", [str(places.venv / "bin")])
    env[_MARK] = str(places.root)
    env["VIRTUAL_ENV"] = str(places.venv)
    env["PYTHONNOUSERSITE"] = "1"  # packages under ~/.local are neither pinned nor known
    env["HOME"] = env.get("HOME") or _home(places)
    env.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    # The shared memory of a process that was killed can block every later one; not in force with LOCALHOST, see docs.
    env.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
    env.setdefault("FASTRTPS_DEFAULT_PROFILES_FILE", str(places.environment / "fastdds.xml"))
    with contextlib.suppress(OSError):  # rclpy says itself that it has no place for its logs
        env.setdefault("ROS_LOG_DIR", str(_ros_logs(places, environ)))
    return env


def with_sources(env: dict, places: Places) -> dict:
    """Let our packages be imported from their sources, to which all that colcon installs of them leads, too.

    So compiled kernels, which numba keeps by the paths of their modules, can be made before the workspace is.
    """
    put_first(env, "PYTHONPATH", sorted(str(path.parent) for path in places.sources.glob("*/setup.py")))
    return env


def outside(environ) -> dict:
    """`environ` as if it were not from inside this checkout's environment: its lists count as foreign."""
    return {name: value for name, value in environ.items() if name != _MARK}


def apply(env: dict, change: dict) -> None:
    """Carry out a change in the form of `ros.changes` on `env`; a second time changes nothing."""
    for name, entries in change["first"].items():
        put_first(env, name, entries)
    env.update(change["set"])


def put_first(env: dict, name: str, entries: list) -> None:
    """Put `entries` in front of the list variable `name`, each once."""
    rest = [entry for entry in env.get(name, "").split(os.pathsep) if entry and entry not in entries]
    if entries or rest:
        env[name] = os.pathsep.join([*entries, *rest])


def _wheels(places: Places) -> dict:
    """What the ROS 2 wheels need; without it they start every Python twice, to set it themselves."""
    libraries = sorted(str(path) for path in places.venv.glob("lib/python3.*/site-packages/ros_*.libs"))
    first = {
        "AMENT_PREFIX_PATH": [str(places.venv)],
        "CMAKE_PREFIX_PATH": [str(places.venv)],
        "LD_LIBRARY_PATH": [str(places.venv / "lib"), *libraries],
    }
    return {"first": first, "set": {"_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}}


def _add_own_modules(env: dict, places: Places, user_path) -> None:
    """Let a user's own modules be found, but behind the locked packages, which they must not replace."""
    if user_path:
        packages = sorted(str(path) for path in places.venv.glob("lib/python3.*/site-packages"))
        env["PYTHONPATH"] = os.pathsep.join([env["PYTHONPATH"], *packages, user_path])


def _ros_logs(places: Places, environ) -> Path:
    """Folder for the logs of rclpy; a checkout may belong to somebody else."""
    return places.logs / "ros" if os.access(places.logs, os.W_OK) else own_folder(environ) / "log"


def _home(places: Places) -> str:
    """A home for users without one, who cannot start rclpy otherwise."""
    home = os.path.expanduser("~")
    return home if os.path.isdir(home) else str(places.home)
