"""Which software made a bag."""

import platform
from importlib.metadata import PackageNotFoundError, version

PACKAGES = ("trackvib_sim", "mr_mount_controller", "numpy", "scipy", "numba", "llvmlite", "mcap")


def versions():
    """Return a dict of versions: Python, the machine's kind, and the packages that results depend on."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "system": platform.system()}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found
