"""Travel, force, energy and current of mounts against signals whose numbers are known, in blocks that do not show."""

import numpy as np
import pytest
from trackvib_sim.analysis import mount_numbers as module
from trackvib_sim.analysis.history import bin_means
from trackvib_sim.analysis.levels import build_bins
from trackvib_sim.analysis.mount_numbers import currents, moments, mount_numbers
from trackvib_sim.bags.recording import Mounts

MS = 1_000_000  # ns
STAMP = np.arange(1, 10_001) * MS
AFTER = 2000 * MS


@pytest.mark.analytic
def test_mounts_of_known_motion(monkeypatch):
    """A sine of travel about a static deflection, force against it, a loss of 5 W left and 10 W right for 8 s."""
    monkeypatch.setattr(module, "BLOCK", 777)
    sine = np.sin(2.0 * np.pi * 2.0 * STAMP / 1e9)
    shape = np.array([[0.0, 0.0, 1e-3], [0.0, 0.0, 2e-3]])
    static = np.array([0.0, 0.0, -5e-3])
    deflection = static + sine[:, None, None] * shape
    current = np.stack((np.where(STAMP <= 6000 * MS, 1.0, 3.0), STAMP / 1e9), axis=1)
    pair = np.ones((len(STAMP), 2))
    mounts = Mounts(STAMP, current, pair, pair, deflection, 0.0 * deflection, -1e6 * deflection, pair * (5.0, 10.0))
    left, right = mount_numbers(mounts, ("left", "right"), AFTER).values()
    assert left.axes["z"].deflection_mean == pytest.approx(-5e-3, rel=1e-9)
    assert left.axes["z"].travel_rms == pytest.approx(1e-3 / np.sqrt(2.0), rel=1e-9)
    assert right.axes["z"].travel_peak == pytest.approx(2e-3, rel=1e-9)
    assert right.axes["z"].force_mean == pytest.approx(5e3, rel=1e-9)
    assert right.axes["z"].force_rms == pytest.approx(2e3 / np.sqrt(2.0), rel=1e-9)
    assert left.axes["z"].force_peak == pytest.approx(1e3, rel=1e-9)
    assert left.axes["x"].travel_rms == 0.0
    assert (left.energy_dissipated, right.energy_dissipated) == pytest.approx((40.0, 80.0), rel=1e-9)
    assert (left.power_dissipated, right.power_dissipated) == pytest.approx((5.0, 10.0), rel=1e-12)
    assert left.current.mean == pytest.approx(2.0) and left.current.rms == pytest.approx(np.sqrt(5.0))
    assert (left.current.least, left.current.greatest, left.current.slew) == (1.0, 3.0, pytest.approx(2000.0))
    assert right.current.slew == pytest.approx(1.0, rel=1e-6)


@pytest.mark.property
def test_a_jump_of_the_current_over_a_gap_is_no_slew():
    """What happened within the gap is not known."""
    stamp = np.append(STAMP[:5000], STAMP[6000:])
    current = np.where(stamp < 5500 * MS, 1.0, 3.0)[:, None] * (1.0, 1.0)
    assert currents(stamp, current, ("left", "right"), AFTER)["left"].slew == 0.0


@pytest.mark.property
@pytest.mark.parametrize(("coils", "count"), [(0, 1), (1, 1), (4, 4), (2, 6), (16, 32)])
def test_any_number_of_mounts(coils, count):
    """Each has the numbers of its own columns, and the current of its coil if it has one."""
    ones = np.ones((len(STAMP), count)) * np.arange(1, count + 1)
    vectors = ones[:, :, None] * np.sin(2.0 * np.pi * 2.0 * STAMP / 1e9)[:, None, None] * (1.0, 10.0, 100.0)
    mounts = Mounts(STAMP, ones[:, :coils], ones, ones, vectors, vectors, vectors, ones)
    found = mount_numbers(mounts, [f"mount {k}" for k in range(1, count + 1)], AFTER)
    assert list(found) == [f"mount {k}" for k in range(1, count + 1)]
    for k, numbers in enumerate(found.values(), 1):
        travel = [numbers.axes[axis].travel_rms for axis in "xyz"]
        np.testing.assert_allclose(travel, k * np.array([1.0, 10.0, 100.0]) / np.sqrt(2.0), rtol=1e-9)
        assert numbers.power_dissipated == pytest.approx(k)
        assert numbers.current.mean == k if k <= coils else np.isnan(numbers.current.mean)


@pytest.mark.property
def test_without_a_sample_there_is_no_number():
    """All nan, no warning, of no sample and of none that counts."""
    for stamp in (np.empty(0, np.int64), STAMP[:10]):
        found = moments(stamp, np.ones((len(stamp), 2)), AFTER)
        assert found.count == 0 and np.isnan(np.concatenate(found[1:])).all()


@pytest.mark.property
def test_means_in_bins(monkeypatch):
    """The mean and the deviation of each second, and nan where a second is empty."""
    monkeypatch.setattr(module, "BLOCK", 333)
    values = np.random.default_rng(2).normal(size=(10_000, 2))
    kept = np.delete(np.arange(10_000), np.s_[4000:5000])
    mean, deviation = bin_means(build_bins(0, int(STAMP[-1])), STAMP[kept], values[kept])
    seconds = values.reshape(10, 1000, 2)
    there = np.delete(np.arange(10), 4)
    np.testing.assert_allclose(mean[there], seconds.mean(axis=1)[there], atol=1e-12)
    np.testing.assert_allclose(deviation[there], seconds.std(axis=1)[there], rtol=1e-9)
    assert np.isnan(mean[4]).all() and np.isnan(deviation[4]).all()
