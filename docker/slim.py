"""Leave out of an image's environment what only builds, tests and measures: packages, their own tests, object files.

Which packages those are say the sections of `environment/requirements*.in`.
"""

import re
import shutil
import subprocess
import sys
import sysconfig
from importlib.metadata import distributions
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NEEDLESS = ("# Building", "# Testing", "# Benchmarks")  # how the headings of such sections begin
REQUIREMENT = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*")


def sections():
    """Names of the packages asked for: those that a running trackvib needs, and all others."""
    needed, needless = set(), {"pip"}
    for path in ROOT.glob("environment/requirements*.in"):
        kind = needed
        for line in path.read_text().splitlines():
            if line.startswith("# "):
                kind = needless if line.startswith(NEEDLESS) else needed
            elif name := REQUIREMENT.match(line):
                kind.add(normal(name[0]))
    return needed, needless


def normal(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def reached(names, installed):
    """`names` with all that they ask for, in turn, without extras, as far as it is `installed`."""
    found, left = set(), list(names)
    while left:
        name = left.pop()
        if name in installed and name not in found:
            found.add(name)
            asked_for = [text for text in installed[name].requires or () if "extra ==" not in text]
            left += [normal(REQUIREMENT.match(text)[0]) for text in asked_for]
    return found


def main():
    installed = {normal(each.metadata["Name"]): each for each in distributions()}
    needed, needless = sections()
    kept = reached(needed, installed)
    left_out = sorted(
        name
        for name in reached(needless, installed) - kept
        # the machine's own packages stay as they are, and those of ROS ask for each other without saying so
        if not name.startswith("ros-") and Path(installed[name].locate_file("")).is_relative_to(sys.prefix)
    )
    print("left out:", *left_out)
    subprocess.run([sys.executable, "-m", "pip", "uninstall", "--quiet", "--yes", *left_out], check=True)
    for tests in Path(sysconfig.get_path("purelib")).glob("**/tests"):
        shutil.rmtree(tests, ignore_errors=True)
    for object_file in ROOT.glob(".trackvib/workspace/build/**/*.o"):
        object_file.unlink()
    # numba writes where it reads; so whoever a container runs as can compile for a processor of another level
    subprocess.run(["chmod", "-R", "a+rwX", ROOT / ".trackvib" / "kernels"], check=True)


if __name__ == "__main__":
    main()
