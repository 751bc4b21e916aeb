"""How far the reading of a recording has come, whatever it is in: it moves, never back, and ends whole."""

from itertools import pairwise

import pytest
import zstandard
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.sources import Sources

pytestmark = pytest.mark.property


def told(path, **options):
    """Return the parts read that are told while a recording is read."""
    parts = []
    read_recording(path, lambda done, total: parts.append(done / total), **options)
    return parts


def test_progress_of_csv_files(tmp_path):
    """Also between the beginning and the end of each of two files."""
    rows = "".join(f"{0.001 * k:.3f},0,0,9.81\n" for k in range(45_000))
    for name in ("one.csv", "other.csv"):
        (tmp_path / name).write_text("time_s,x_m/s2,y_m/s2,z_m/s2\n" + rows)
    parts = told(tmp_path / "one.csv", sources=Sources({"powertrain": str(tmp_path / "other.csv")}, {}, "mean", {}))
    assert all(a <= b for a, b in pairwise(parts)) and parts[-1] == 1.0
    assert sum(0.0 < part < 0.5 for part in parts) >= 3 and sum(0.5 < part < 1.0 for part in parts) >= 3


def test_progress_of_a_compressed_bag(bag, tmp_path):
    """By what has been read of the decompressed file, never beyond the whole."""
    (file,) = bag.glob("*.mcap")
    packed = tmp_path / "bag.mcap.zstd"
    packed.write_bytes(zstandard.compress(file.read_bytes()))
    for path in (bag, packed):
        parts = told(path)
        assert all(a <= b for a, b in pairwise(parts)) and parts[-1] == 1.0 and 0.0 < parts[0] < 1.0
