"""Loops whose parameters are known give them back; files that are none are refused."""

import csv

import numpy as np
import pytest
from trackvib_sim.mount_bench.fit import fit_loops
from trackvib_sim.mount_bench.harmonic import shake
from trackvib_sim.mount_bench.measured import COLUMNS, LoopsFileError, read_loops
from trackvib_sim.vehicle.mount_law import mount_characteristics

LIMIT = 1500.0  # N
NOISE = 20.0  # N


@pytest.fixture(scope="module")
def loops_file(system, tmp_path_factory):
    """A function that writes loops of the shipped mounts with a yield force and noise, and returns the file."""

    def write(limit):
        random = np.random.default_rng(1)
        mounts = system.mounts._replace(yield_fit=np.array([(0.0, 0.0, 0.0, limit)] * 2))
        path = tmp_path_factory.mktemp("loops") / "loops.csv"
        with path.open("w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(COLUMNS)
            for current in (0.0, 1.0, 2.0, 4.0):
                for amplitude, frequency in ((1e-3, 1.0), (3e-3, 8.0)):
                    loop = shake(mounts, 0, current, amplitude, frequency)
                    time = np.arange(len(loop.force)) / (len(loop.force) * frequency)
                    force = loop.force + 100.0 + NOISE * random.normal(size=len(time))
                    rows.writerows(zip(time, loop.displacement, force, np.full(len(time), current), strict=True))
        return path

    return write


@pytest.mark.property
@pytest.mark.parametrize(("law", "limit"), [("viscoelastic", np.inf), ("yielding", LIMIT)])
def test_known_parameters_come_back(system, loops_file, law, limit):
    """Each to a percent of itself or its interval, with nothing but the noise left over."""
    fit = fit_loops(read_loops(loops_file(limit)), law)
    assert fit.offset.value == pytest.approx(100.0, abs=5.0)
    assert set(fit.stiffness) == set(fit.damping) == {0.0, 1.0, 2.0, 4.0}
    for current, found in fit.stiffness.items():
        k, c = mount_characteristics(system.mounts, 0, current)
        damping = fit.damping[current]
        assert found.value == pytest.approx(k, rel=0.01, abs=3.0 * found.half)
        assert damping.value == pytest.approx(c, rel=0.02, abs=3.0 * damping.half)
        assert 0.0 < found.half < 0.05 * found.value
    assert set(fit.yield_force) == ({1.0, 2.0, 4.0} if law == "yielding" else set())
    for found in fit.yield_force.values():
        assert found.value == pytest.approx(limit, rel=0.02)
    assert fit.residual < 0.03


@pytest.mark.slow(reason="fits every law")
@pytest.mark.property
def test_a_law_without_yield_leaves_more_over(loops_file):
    """Loops that yield are not those of a spring and a damper."""
    loops = read_loops(loops_file(LIMIT))
    assert fit_loops(loops, "viscoelastic").residual > 3.0 * fit_loops(loops, "yielding").residual


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1: must name the column time_s"),
        ("time_s,displacement_m,force_N\n", "current_A"),
        ("time_s,time_s,displacement_m,force_N,current_A\n", "time_s once"),
        ("time_s,displacement_m,force_N,current_A\n0,0,0\n", "line 2"),
        ("time_s,displacement_m,force_N,current_A\n0,0,nan,1\n", "line 2: has"),
        ("time_s,displacement_m,force_N,current_A\n0,0,1,1\n", "has 1 rows"),
        ("time_s,displacement_m,force_N,current_A\n" + "1,0,1,1\n" * 30, "time_s must rise"),
        ("time_s,displacement_m,force_N,current_A\n" + "".join(f"{k},5,1,1\n" for k in range(30)), "must move"),
        ("\x00\x01\xff", "line 1"),
    ],
)
def test_bad_files_are_refused(tmp_path, text, words):
    """In one line that names the place and what is accepted."""
    path = tmp_path / "loops.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(LoopsFileError) as caught:
        read_loops(path)
    assert words in str(caught.value) and "\n" not in str(caught.value)
