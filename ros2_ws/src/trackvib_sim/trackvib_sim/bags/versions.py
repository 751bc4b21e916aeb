"""Which software made a bag."""

import platform
from importlib.metadata import PackageNotFoundError, version

from ..numerics.processor import target

PACKAGES = ("trackvib_sim", "mr_mount_controller", "numpy", "scipy", "numba", "llvmlite", "mcap")


def versions():
    """Return a dict of versions: Python, machine, processor and the packages that results depend on."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "system": platform.system()}
    found["processor"] = target() or "none of the levels"
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found
