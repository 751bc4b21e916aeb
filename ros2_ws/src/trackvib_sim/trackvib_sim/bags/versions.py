"""Which software made a bag."""

import os
import platform
from importlib.metadata import PackageNotFoundError, version

PACKAGES = ("trackvib_sim", "mr_mount_controller", "numpy", "scipy", "numba", "llvmlite", "mcap")


def versions():
    """Return a dict of versions: Python, machine, processor and the packages that results depend on."""
    found = {"python": platform.python_version(), "machine": platform.machine(), "system": platform.system()}
    found["processor"] = _processor()
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found


def _processor():
    """What kernels are compiled for: in the laboratory's environment a level of x86-64, else the very processor."""
    if chosen := os.environ.get("NUMBA_CPU_NAME"):
        return chosen
    from llvmlite.binding import get_host_cpu_name  # imported late, for it is large

    return get_host_cpu_name()
