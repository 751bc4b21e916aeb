"""The recorder on a disk that is full, at its start or at last: one error, and what was written can be repaired."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from trackvib_sim.bags.repair import repair

from .bag_helpers import counted

STREAM = Path(__file__).parent / "imu_stream.py"

pytestmark = pytest.mark.system


def last_words(process):
    """Return the one error that a process printed."""
    assert process.output.count("error:") == 1 and "Traceback" not in process.output, process.output
    return process.output[process.output.index("error:") :]


@pytest.fixture
def small_disk(tmp_path):
    """A folder in which a file cannot grow beyond 300 kB, and what a command must begin with for that to hold."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", str(folder)]
    if os.geteuid() == 0 and subprocess.run(mount, capture_output=True).returncode == 0:
        yield folder, [], "No space left on device"
        subprocess.run(["umount", "-l", str(folder)], check=True)
    else:  # shared memory of DDS counts as a file, so it goes without
        yield folder, ["env", "FASTDDS_BUILTIN_TRANSPORTS=UDPv4", "prlimit", "--fsize=300000"], "File too large"


@pytest.mark.slow(reason="a real recorder that fills a disk")
def test_full_disk(start, start_node, small_disk, tmp_path):
    """One error, an exit code, and what was written can be repaired elsewhere."""
    disk, before, words = small_disk
    start([sys.executable, STREAM, "stream"])
    recorder = start_node("recorder", bag=disk / "bag", topics="[stream]", compression="none", before=before)
    assert recorder.wait() == 1
    said = last_words(recorder)
    assert words in said and "disk/bag" in said and "trackvib bag repair" in said
    assert "xception" not in recorder.output
    saved = shutil.copytree(disk / "bag", tmp_path / "saved")
    assert repair(saved).files[0].messages > 300
    _, counts = counted(saved, "/stream")
    np.testing.assert_array_equal(np.diff(counts), 1.0)


def test_disk_that_is_full_at_the_start(start_node, small_disk, tmp_path):
    """Nothing half-made is left."""
    disk, before, words = small_disk
    if before:
        before[-1] = "--fsize=0"
    else:
        (disk / "filler").write_bytes(bytes(290_000))
        for k in range(1000):
            try:
                (disk / f"{k}").write_bytes(b"x")
            except OSError:
                break
    recorder = start_node("recorder", bag=disk / "bag", before=before)
    assert recorder.wait() == 1
    assert re.search(rf"bag '.*disk/bag' cannot be created: {words}", last_words(recorder))
    assert not (disk / "bag").exists()
