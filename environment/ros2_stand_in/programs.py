"""`ros2 run`: becomes a program of an installed package. The standard library only."""

import os
import shlex
from pathlib import Path

from environment.ros2_stand_in.terminal import Failure


def run(chosen):
    """Replace this process by the program, so that signals and the exit code are its own."""
    program = find_executable(chosen.package_name, chosen.executable_name)
    words = [*shlex.split(chosen.prefix or ""), program, *chosen.argv]
    try:
        os.execvp(words[0], words)
    except OSError as error:
        raise Failure(f"cannot run {words[0]}: {error.strerror}") from None


def find_executable(package, executable):
    """Return the path of a package's program; raises `Failure`, which names what there is."""
    packages = _packages()
    if package not in packages:
        having = sorted(name for name, prefix in packages.items() if _executables(prefix, name))
        raise Failure(f"Package '{package}' not found; those with executables: {', '.join(having) or 'none'}")
    executables = _executables(packages[package], package)
    if executable not in executables:
        raise Failure(
            f"no executable {executable!r} in {package}; there is: {', '.join(sorted(executables)) or 'none'}"
        )
    return str(executables[executable])


def share_folder(package):
    """Return the folder of a package's own files; raises `Failure` if there is no such package."""
    packages = _packages()
    if package not in packages:
        raise Failure(f"Package '{package}' not found")
    return packages[package] / "share" / package


def _packages() -> dict:
    """Prefix of every package of the ament index; the first place on AMENT_PREFIX_PATH wins."""
    packages = {}
    for prefix in reversed(os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        index = Path(prefix, "share", "ament_index", "resource_index", "packages")
        if prefix and index.is_dir():
            packages.update({marker.name: Path(prefix) for marker in index.iterdir()})
    return packages


def _executables(prefix: Path, package: str) -> dict:
    """Programs of a package, by name."""
    folder = prefix / "lib" / package
    files = folder.iterdir() if folder.is_dir() else ()
    return {path.name: path for path in files if path.is_file() and os.access(path, os.X_OK)}
