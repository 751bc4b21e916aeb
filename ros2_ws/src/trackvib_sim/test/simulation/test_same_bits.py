"""A drive has the same bits whichever way the linear algebra chooses by processor."""

import os
import subprocess
import sys

import pytest

PROGRAM = """
import hashlib, os
import numpy as np
import trackvib_sim as tv
from trackvib_sim import Simulation, run_open_loop

# With the kernels found, but not yet the run-in, which would be that of another call.
os.environ.pop("NUMBA_CACHE_DIR", None)
for name in ("tao2025", "leopard1"):
    vehicle, _ = tv.read_vehicle(tv.find_vehicle(name))
    settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    run = run_open_loop(Simulation(vehicle, settings), tv.Iso8608Road("E", seed=1), 100)
    print(name, hashlib.sha256(np.ascontiguousarray(run.specific_force)).hexdigest())
"""


@pytest.mark.slow(reason="two processes that build vehicles")
@pytest.mark.property
def test_linear_algebra_does_not_matter():
    """That for old processors, which new ones can do as well, and that for this one differ in the last bits."""

    def printed(**environment):
        return subprocess.check_output([sys.executable, "-c", PROGRAM], env={**os.environ, **environment}, text=True)

    own = printed()
    assert len(own.splitlines()) == 2
    assert printed(OPENBLAS_CORETYPE="Nehalem") == own
