"""The training example of the documents: it learns something, and tells of it, in a small run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="learns for some ten seconds")]

EXAMPLE = Path(__file__).parents[1] / "docs" / "examples" / "train_mounts.py"


def test_it_learns_on_some_roads_and_is_tried_on_others():
    """Two generations on one road already find what is better than passive mounts there; the verdict is printed."""
    words = ("--generations", "2", "--roads", "1", "--held-back", "2", "--duration", "3")
    done = subprocess.run([sys.executable, EXAMPLE, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    levels = [float(level) for level in re.findall(r"best ([-+][\d.]+) % of passive", done.stdout)]
    assert len(levels) == 2 and levels[1] <= levels[0] and levels[1] < 0.0
    assert "on 2 roads held back, beside passive mounts:" in done.stdout
    assert re.search(r"^best constant current, [\d.]+ A: (not )?lower, [-+][\d.]+ % with", done.stdout, re.MULTILINE)
    assert re.search(r"^learnt law: (not )?lower, [-+][\d.]+ % with a standard error of", done.stdout, re.MULTILINE)
