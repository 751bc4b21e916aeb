"""Analytic: latenesses by their quantiles, to the width of a bin."""

import numpy as np
import pytest
from trackvib_sim.nodes.timing import Lateness

pytestmark = pytest.mark.analytic


def test_quantiles_of_many():
    """Beside numpy's, over four decades."""
    late = np.random.default_rng(1).lognormal(np.log(1e-4), 1.5, 20_000)
    lateness = Lateness()
    for each in late:
        lateness.add(each)
    told = lateness.quantiles()
    assert list(told) == ["late_us_p50", "late_us_p99", "late_us_p99.9"]
    for found, share in zip(told.values(), (50, 99, 99.9), strict=True):
        assert found == pytest.approx(1e6 * np.percentile(late, share, method="inverted_cdf"), rel=0.021)


def test_extremes():
    """What is early or on time counts as the least, what is absurd as the most; without a period nothing is told."""
    lateness = Lateness()
    assert lateness.quantiles() == {}
    lateness.add(-1.0)
    assert lateness.quantiles()["late_us_p50"] <= 1.1
    lateness.add(1e9)
    assert lateness.quantiles()["late_us_p99"] > 6e7
