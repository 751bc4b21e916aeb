"""Pin all packages anew, with their hashes: `python environment/renew_locks.py`, with uv on the path.

`requirements.lock` is what the environment has, `requirements-own-ros.lock` the same beside a ROS 2 of the machine's
own. The lock of an extra has what neither of them brings.
"""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))

from environment.extras import EXTRAS  # noqa: E402

PYTHON = (3, 10)  # the first one


def lock(name: str, python: tuple, *options: str) -> Path:
    """Write NAME.lock from NAME.in for a Python and all later ones; returns its path."""
    command = ["uv", "pip", "compile", "--quiet", "--universal", "--generate-hashes", "--no-header"]
    version = ["--python-version", ".".join(map(str, python))]
    subprocess.run([*command, *version, *options, f"{name}.in", "-o", f"{name}.lock"], cwd=FOLDER, check=True)
    return FOLDER / f"{name}.lock"


def packages(path: Path) -> set:
    """Return the names of the packages that a lock brings everywhere: for some kinds of machine only does not count."""
    entries = re.findall(r"^([\w.-]+)==\S+ (;?)", path.read_text(), re.MULTILINE)
    count = Counter(name for name, _ in entries)  # several versions of one share all machines among them
    return {name for name, marker in entries if not marker or count[name] > 1}


def main() -> None:
    """Renew every lock."""
    locks = [lock("requirements", PYTHON), lock("requirements-own-ros", PYTHON)]
    there = sorted(set.intersection(*map(packages, locks)))
    # Extras stand side by side in one environment, so that what two of them bring has to be the same.
    agreed = [locks[0]]
    for extra in EXTRAS:
        constraints = [word for path in agreed for word in ("-c", path.name)]
        without = [word for package in there for word in ("--no-emit-package", package)]
        agreed.append(lock(f"requirements-{extra.name}", extra.python, *constraints, *without))


if __name__ == "__main__":
    main()
