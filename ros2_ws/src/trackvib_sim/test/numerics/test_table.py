"""Looking up in tables."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trackvib_sim.numerics.table import interpolate

GROWING = st.lists(st.floats(-50.0, 50.0), min_size=1, max_size=8, unique=True).map(sorted)


@pytest.mark.property
@given(at=GROWING, seed=st.integers(0, 2**32 - 1), where=st.floats(-60.0, 60.0))
@settings(max_examples=100)
def test_between_points_a_value_is_that_of_the_straight_line(at, seed, where):
    """As numpy interpolates, beyond the ends as at them."""
    at, values = np.array(at), np.random.default_rng(seed).normal(size=len(at))
    assert interpolate(at, values, where) == pytest.approx(np.interp(where, at, values), rel=1e-12, abs=1e-12)
