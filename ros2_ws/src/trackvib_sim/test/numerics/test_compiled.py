"""Kernels that are kept beside the sources are never those of other sources."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import trackvib_sim

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="compiles kernels anew")]

# a kernel (`rui/sweeps/riccati.py`) that calls parts of another file (`numerics/spatial.py`)
SCRIPT = """
import numpy as np
from trackvib_sim import rui
rod = rui.Hinge(1, "revolute", "base", (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
base = rui.Body(0, "base", 1.0, (0.0, 0.0, 0.0), np.eye(3))
bodies = [base, rui.Body(1, "arm", 2.0, (0.0, 0.0, -0.5), np.eye(3), rod)]
loads = rui.no_loads(bodies)
loads.torque[1] = 5.0
print(rui.accelerations(bodies, rui.rest_state(bodies), loads).hinge[1])
"""


@pytest.fixture
def copy(tmp_path):
    """The package's sources in a folder of their own, and a function that runs the script with them."""
    folder = tmp_path / "trackvib_sim"
    shutil.copytree(Path(trackvib_sim.__file__).parent, folder, ignore=shutil.ignore_patterns("__pycache__"))
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    environment["NUMBA_OPT"] = "0"  # compiled for a few steps only

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
    kept = {file.name: file.stat().st_mtime_ns for file in folder.rglob("*.nbc")}
    assert kept and run() == first
    assert {file.name: file.stat().st_mtime_ns for file in folder.rglob("*.nbc")} == kept
    spatial = folder / "numerics" / "spatial.py"
    text = spatial.read_text()
    assert "def dot(a, b):" in text
    spatial.write_text(
        text + "\n\n@inlined\ndef dot(a, b):\n    return 2.0 * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2])\n"
    )
    assert run() != pytest.approx(first, rel=0.01)
