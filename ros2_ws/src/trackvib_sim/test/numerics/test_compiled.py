"""Kernels that are kept beside the sources are never those of other sources."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import trackvib_sim

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="compiles kernels anew")]

# a kernel (`vehicle/drive/schedule.py`) that calls one of another file (`numerics/table.py`)
SCRIPT = """
import numpy as np
import trackvib_sim as tv
from trackvib_sim.vehicle.drive.schedule import new_wanted, wanted_speed
faster = tv.Schedule(False, np.array([0.0, 5.0]), np.array([5.0, 10.0]), np.zeros(2), np.zeros(2))
wanted = new_wanted(faster)
wanted.time[0] = 2.5
print(wanted_speed(faster, wanted, 0.0))
"""


@pytest.fixture
def copy(tmp_path):
    """The package's sources in a folder of their own, and a function that runs the script with them."""
    folder = tmp_path / "trackvib_sim"
    shutil.copytree(Path(trackvib_sim.__file__).parent, folder, ignore=shutil.ignore_patterns("__pycache__"))
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)

    def run():
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT], env=environment, cwd=tmp_path, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        return float(done.stdout)

    return folder, run


def test_a_change_below_a_kernel_is_noticed(copy):
    """The second run takes the kernels of the first, the third must not: a function that they call is another one."""
    folder, run = copy
    first = run()
    assert first == 7.5
    kept = {file.name: file.stat().st_mtime_ns for file in folder.rglob("*.nbc")}
    assert kept and run() == first
    assert {file.name: file.stat().st_mtime_ns for file in folder.rglob("*.nbc")} == kept
    table = folder / "numerics" / "table.py"
    text = table.read_text()
    assert text.count("def interpolate(at, values, x):") == 1
    table.write_text(text.replace("return (1.0 - part) * values[low]", "return 2.0 * values[low]"))
    assert run() != pytest.approx(first, rel=0.01)
