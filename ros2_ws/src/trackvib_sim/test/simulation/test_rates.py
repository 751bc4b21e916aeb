"""Rates that divide each other, or say which of them clash."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.numerics.units import NANO
from trackvib_sim.simulation.settings import Rates

DIVISORS = [d for d in range(1, 200_001) if NANO % d == 0]


@pytest.mark.property
@given(data=st.data())
def test_rates_that_divide_are_accepted(data):
    """Wherever each rate divides the one before and a second, steps and period are whole and fit exactly."""
    physics = data.draw(st.sampled_from(DIVISORS))
    control = data.draw(st.sampled_from([d for d in DIVISORS if physics % d == 0]))
    odometry = data.draw(st.sampled_from([d for d in DIVISORS if control % d == 0]))
    rates = Rates(physics, control, odometry)
    assert rates.steps * control == physics
    assert rates.period * control == NANO


@pytest.mark.property
@pytest.mark.parametrize(
    ("rates", "words"),
    [
        ((10_000, 3_000, 100), ("physics_rate 10000 Hz", "control_rate 3000 Hz", "must be a multiple")),
        ((1_000, 10_000, 100), ("physics_rate 1000 Hz", "control_rate 10000 Hz")),
        ((10_000, 1_000, 300), ("control_rate 1000 Hz", "odometry_rate 300 Hz")),
        ((10_000, 100, 1_000), ("control_rate 100 Hz", "odometry_rate 1000 Hz")),
        ((3_000, 1_000, 100), ("physics_rate 3000 Hz", "whole nanoseconds")),
        ((7_000, 7_000, 7_000), ("physics_rate 7000 Hz", "whole nanoseconds")),
    ],
)
def test_clash_names_both_rates(rates, words):
    """Rates that do not divide are refused with the two that clash, their values and what is wanted."""
    with pytest.raises(ValueError) as refused:
        Rates(*rates)
    for word in words:
        assert word in str(refused.value)


@pytest.mark.property
def test_default_rates():
    """By default ten physics steps make a control period of a millisecond."""
    assert (Rates().steps, Rates().period) == (10, 1_000_000)
