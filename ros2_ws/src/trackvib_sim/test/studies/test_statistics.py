"""Deviations and intervals of few samples."""

import numpy as np
import pytest
from trackvib_sim.studies.statistics import deviation, half_interval


@pytest.mark.literature
def test_students_table():
    """Half intervals of n samples with deviation 1 are t / sqrt(n): 12.706, 4.303 and 2.365 for 2, 3 and 8 of them."""
    random = np.random.default_rng(1)
    for n, factor in ((2, 12.706), (3, 4.303), (8, 2.365)):
        values = random.normal(size=n)
        values = (values - values.mean()) / values.std(ddof=1)
        assert half_interval(values) == pytest.approx(factor / np.sqrt(n), rel=5e-4)


@pytest.mark.property
def test_intervals_hold_the_mean_as_often_as_they_say():
    """Of 4000 times 5 samples 95 % hold it, to three standard errors."""
    samples = np.random.default_rng(2).normal(3.0, 2.0, (4000, 5))
    held = np.mean([abs(each.mean() - 3.0) <= half_interval(each) for each in samples])
    assert held == pytest.approx(0.95, abs=3.0 * np.sqrt(0.95 * 0.05 / 4000))


@pytest.mark.property
def test_a_single_sample_tells_nothing():
    """Neither a deviation nor an interval; columns do not mix."""
    assert np.isnan(half_interval([1.0])) and np.isnan(deviation([[1.0, 2.0]])).all()
    assert deviation([[1.0, 5.0], [3.0, 5.0]]) == pytest.approx([np.sqrt(2.0), 0.0])
