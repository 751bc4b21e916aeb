"""Benchmarks, which are run by hand now and then, still run: each as small as it goes, with its own verdict."""

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each measures in processes of its own")]

BENCH = Path(__file__).parents[1] / "bench"
KINDS = ("vehicles", "plans", "options", "parameters", "messages", "bags")  # `bag_verbs` takes minutes


@pytest.mark.parametrize(
    "words",
    [
        "analyze.py --minutes 2",
        "forms_on_chains.py",
        "inverse_dynamics.py",
        "long_run.py --runs 1 --duration 4 --load 0",
        "recorder.py --rate 1000 --seconds 1",
        "soak.py 500",
        *(f"hostile_inputs.py {kind} --count 30" for kind in KINDS),
    ],
)
def test_it_runs(words, env, tmp_path):
    """To its end, with nothing found wrong."""
    file, *arguments = words.split()
    done = subprocess.run(
        [sys.executable, BENCH / file, *arguments], cwd=tmp_path, env=env, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
