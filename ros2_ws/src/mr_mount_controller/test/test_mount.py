"""The mounts as the controller knows them: the printed fits, and the current for a wanted damping."""

from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.mount import HIGHEST_CURRENT, LOWEST_CURRENT, PUBLISHED

CARRIED_MASS, RUBBER_DAMPING_RATIO = PUBLISHED.carried_mass, PUBLISHED.rubber_damping_ratio
stiffness, damping, current_for_damping = PUBLISHED.stiffness, PUBLISHED.damping, PUBLISHED.current_for_damping

FIRMEST = 3.71  # A, where the slope of c(I) is zero


@pytest.mark.literature
def test_rated_point():
    """At 1 A about 3 kN/mm and, with 1000 kg a mount, the 8.7 Hz and zeta of about 0.15 of [Tao2025]."""
    assert stiffness(1.0) == pytest.approx(3.196e6, rel=1e-3)
    assert sqrt(stiffness(1.0) / CARRIED_MASS) / 6.2832 == pytest.approx(8.7, rel=0.04)
    assert damping(1.0) / (2.0 * sqrt(stiffness(1.0) * CARRIED_MASS)) == pytest.approx(0.151, abs=1e-3)


@pytest.mark.property
@given(current=st.floats(-1e3, 1e3))
def test_fits_end_at_zero_and_at_the_highest_current(current):
    """Whatever the current, stiffness and damping are those of the nearest one between, and positive."""
    nearest = min(max(current, 0.0), HIGHEST_CURRENT)
    assert stiffness(current) == stiffness(nearest) > 0.0
    assert damping(current) == damping(nearest) > 0.0


@pytest.mark.property
@given(current=st.floats(0.0, 0.66))
def test_a_weak_field_leaves_the_rubber(current):
    """Stiffness goes on along its fit; damping is the rubber's where the fit gives less, or none."""
    assert stiffness(0.0) == pytest.approx(0.904e6) and stiffness(current) >= stiffness(0.0)
    assert damping(current) == pytest.approx(2.0 * RUBBER_DAMPING_RATIO * sqrt(stiffness(current) * CARRIED_MASS))


@pytest.mark.property
@given(current=st.floats(LOWEST_CURRENT, FIRMEST))
def test_current_gives_the_damping_it_is_for(current):
    """The damping at the current found is the wanted one, to the 1 N s/m of the table."""
    assert damping(current_for_damping(damping(current))) == pytest.approx(damping(current), abs=1.0)


@pytest.mark.property
@given(wanted=st.floats(allow_nan=False), more=st.floats(0.0, 1e5))
def test_current_rises_with_the_damping(wanted, more):
    """More damping never takes less current, and every damping gets one within the valid range."""
    low, high = current_for_damping(wanted), current_for_damping(wanted + more)
    assert LOWEST_CURRENT <= low <= high <= HIGHEST_CURRENT


@pytest.mark.property
def test_what_cannot_be_had_gets_the_nearest():
    """Less than the least damping gets the lowest current, more than the most that of the firmest damping."""
    assert current_for_damping(-1.0) == LOWEST_CURRENT
    assert current_for_damping(1e9) == pytest.approx(FIRMEST, abs=0.005)
