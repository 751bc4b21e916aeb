"""A single bump on a level road: its shape, and that every cut of it is the same."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from trackvib_sim.road.bump import Bump
from trackvib_sim.road.iso8608 import SPACING


@pytest.mark.analytic
def test_bump_is_a_raised_cosine():
    """Level before and after, both sides alike, its height in the middle, half of it at the quarters."""
    bump = Bump(0.1, 2.0, 8.0)
    left, right = bump.heights(0, 400)
    assert_array_equal(left, right)
    distance = SPACING * np.arange(400)
    assert not left[(distance <= 8.0) | (distance >= 10.0)].any()
    assert left[180] == left.max() == pytest.approx(0.1, rel=1e-12)
    assert left[[170, 190]] == pytest.approx(0.05, rel=1e-9)
    assert left.sum() * SPACING == pytest.approx(0.1, rel=1e-9)  # mean height times length


@pytest.mark.property
def test_heights_do_not_depend_on_the_cut():
    """Patches are parts of the whole to the last bit."""
    bump = Bump(0.1, 2.0, 8.0)
    whole = bump.heights(-50, 450)
    assert_array_equal(np.concatenate([bump.heights(-50, 217), bump.heights(167, 233)], axis=1), whole)
