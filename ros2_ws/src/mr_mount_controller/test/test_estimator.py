"""The washout integrator against its transfer function s / (s + w)^2."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.laws.estimator import WashoutIntegrator

PERIOD = 1e-3


def response(frequency, corner, period=PERIOD):
    """Complex gain of the estimator for a sinusoidal acceleration, whose samples are means over their period."""
    s = 2j * np.pi * frequency
    estimator = WashoutIntegrator(period, corner)
    settle = int(20.0 / (2.0 * np.pi * corner) / period)  # exp(-20) (1 + 20) = 4e-8 of the start is left
    count = settle + int(round(4.0 / frequency / period))
    end = period * np.arange(1, count + 1)
    mean = (np.exp(s * end) - np.exp(s * (end - period))) / (s * period)
    velocity = np.array([estimator.update(a) for a in mean.real])[settle:]
    basis = np.exp(s * end[settle:])
    fit = np.linalg.lstsq(np.stack((basis.real, -basis.imag), axis=1), velocity, rcond=None)[0]
    return fit[0] + 1j * fit[1]


@pytest.mark.analytic
@pytest.mark.parametrize("corner", [0.2, 0.5, 2.0])
@pytest.mark.parametrize("frequency", [0.1, 0.5, 2.0, 8.7, 50.0])
def test_frequency_response_is_the_transfer_function(frequency, corner):
    """Amplitude and phase are those of s / (s + w)^2.

    Each of the two first-order filters takes its input as constant over a period, which puts a relative error of at
    most |s + w| period / 2 on the first one (the second is exact for the mean that it gets), plus the same again for
    the product of the two at the end of the period.
    """
    s, w = 2j * np.pi * frequency, 2.0 * np.pi * corner
    exact = s / (s + w) ** 2
    assert abs(response(frequency, corner) / exact - 1.0) < abs(s + w) * PERIOD


@pytest.mark.analytic
def test_error_shrinks_with_the_period():
    """Half the period halves the error against the transfer function, as a first-order error does."""
    s, w = 2j * np.pi * 2.0, np.pi
    error = [abs(response(2.0, 0.5, period) / (s / (s + w) ** 2) - 1.0) for period in (4e-3, 2e-3, 1e-3)]
    # second-order terms are |s + w| period smaller, 5 % at most
    assert error[0] / error[1] == pytest.approx(2.0, rel=0.05)
    assert error[1] / error[2] == pytest.approx(2.0, rel=0.05)


@pytest.mark.property
@given(acceleration=st.floats(-100.0, 100.0))
def test_constant_acceleration_gives_no_velocity(acceleration):
    """Gravity or an offset that is there from the first sample on gives exactly zero for ever."""
    estimator = WashoutIntegrator(PERIOD, 0.5)
    assert all(estimator.update(acceleration) == 0.0 for _ in range(100))


@pytest.mark.analytic
def test_step_of_acceleration_is_forgotten():
    """After a step of 1 m/s^2 the velocity follows t exp(-w t), whose peak is 1 / (e w), and dies out."""
    w = 2.0 * np.pi * 0.5
    estimator = WashoutIntegrator(PERIOD, 0.5)
    estimator.update(9.81)
    velocity = np.array([estimator.update(10.81) for _ in range(10_000)])
    time = PERIOD * np.arange(1, 10_001)
    # first-order error of the cascade: w period of the peak
    assert np.abs(velocity - time * np.exp(-w * time)).max() < 2.0 * w * PERIOD / (np.e * w)
    assert abs(velocity[-1]) < 1e-11
