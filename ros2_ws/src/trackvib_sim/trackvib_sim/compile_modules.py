"""Import every module once, so that Python has compiled what they need: `python -m trackvib_sim.compile_modules`."""

from contextlib import suppress
from importlib import import_module
from pkgutil import walk_packages

import mr_mount_controller

import trackvib_sim


def main():
    """Import all modules of both packages, but those of extras that are not installed."""
    for package in (mr_mount_controller, trackvib_sim):
        for module in walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(ImportError):
                import_module(module.name)


if __name__ == "__main__":
    main()
