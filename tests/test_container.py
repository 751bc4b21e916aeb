"""The container: built, run and checked by docker/trial.sh, where an engine answers."""

import os
import shutil
import subprocess

import pytest

from .documents import ROOT

pytestmark = [pytest.mark.system, pytest.mark.container, pytest.mark.slow(reason="builds an image")]
BASE = "TRACKVIB_CONTAINER_BASE"


def _engine():
    """Why there is none; empty if one answers."""
    if not shutil.which("docker"):
        return "no container engine: no docker on PATH"
    try:
        asked = subprocess.run(["docker", "info", "--format", "{{.ServerVersion}}"], capture_output=True, timeout=20)
    except subprocess.TimeoutExpired:
        return "no container engine: docker does not answer"
    return "" if asked.returncode == 0 else "no container engine: docker reaches no daemon"


def test_image_is_built_and_drives(env):
    """A container a node: all samples answered, the bag drives again bit for bit outside; the image is small."""
    if reason := _engine():
        pytest.skip(reason)
    base = [os.environ[BASE]] if BASE in os.environ else []
    done = subprocess.run([ROOT / "docker" / "trial.sh", *base], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    assert "answers: 10000 accepted" in done.stdout and "identical to the last bit" in done.stdout
