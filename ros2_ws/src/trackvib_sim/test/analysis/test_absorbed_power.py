"""Vertical absorbed power: the published transfer function, an independent filter for it, and sines of known power."""

import numpy as np
import pytest
from trackvib_sim.analysis import absorbed_power as module
from trackvib_sim.analysis.absorbed_power import FOOT, absorbed_by_frequency, absorbed_power, transfer

FREQUENCY = np.geomspace(0.5, 40.0, 200)  # Hz


@pytest.mark.literature
def test_transfer_function_is_that_of_an_independent_filter():
    """Project Chrono's vertical filter, 14.5 s (s + 44) / ((s + 63) (s² + 24 s + 750)) on ft/s², by its source.

    It is a fit of third order: within 30 % everywhere, and within 6 % where most is absorbed, of 3.5 to 6 Hz.
    """
    s = 2j * np.pi * FREQUENCY
    fit = np.abs(14.5 * s * (s + 44.0) / ((s + 63.0) * (s**2 + 24.0 * s + 750.0))) ** 2
    ratio = absorbed_by_frequency(FREQUENCY) * FOOT**2 / fit
    assert ratio.min() > 0.7 and ratio.max() < 1.3
    most = (FREQUENCY > 3.5) & (FREQUENCY < 6.0)
    assert ratio[most] == pytest.approx(1.0, abs=0.06)
    assert abs(FREQUENCY[absorbed_by_frequency(FREQUENCY).argmax()] - FREQUENCY[fit.argmax()]) < 0.2


@pytest.mark.analytic
def test_transfer_function_is_that_of_a_passive_body():
    """A man's mass at rest, stable poles, and no power given back at any frequency."""
    assert pytest.approx(63.5, abs=0.1) == module._K0 * 14.594  # kg a slug
    # F3 + s F4 in rising powers of s: even ones of F3, odd ones of F4, with s² = -ω²
    signs = (-1.0) ** np.arange(4)
    below = np.ravel(np.column_stack((module._F3.coef * signs, module._F4.coef * signs)))
    assert np.polynomial.polynomial.polyroots(below).real.max() < 0.0
    assert absorbed_by_frequency(np.geomspace(0.01, 1000.0, 2000)).min() > 0.0
    assert absorbed_by_frequency(0.0) == 0.0


@pytest.mark.analytic
def test_response_has_the_published_gain():
    """The factored response, whose gain squared is the power of a sine, at every frequency."""
    frequency = np.geomspace(0.05, 500.0, 400)
    assert np.abs(transfer(frequency)) ** 2 == pytest.approx(absorbed_by_frequency(frequency), rel=1e-9)


@pytest.mark.analytic
@pytest.mark.parametrize("rate", [50.0, 200.0, 1000.0])
def test_sine_upon_gravity_has_its_power(rate):
    """1 m/s² RMS at 4.5 Hz and 2 m/s² at 12 Hz, alone and together; gravity leaves nothing."""
    time = np.arange(round(30.0 * rate)) / rate
    sines = np.sqrt(2.0) * np.sin(2.0 * np.pi * np.outer((4.5, 12.0), time)) * ((1.0,), (2.0,))
    wanted = absorbed_by_frequency((4.5, 12.0)) * (1.0, 4.0)
    for sine, power in zip((*sines, sines.sum(axis=0)), (*wanted, wanted.sum()), strict=True):
        assert absorbed_power(9.81 + sine, rate)[round(10.0 * rate) :].mean() == pytest.approx(power, rel=2e-3)
    assert absorbed_power(np.full(5000, 9.81), rate).max() < 1e-12


@pytest.mark.property
@pytest.mark.parametrize("rate", [49.0, 0.0, float("nan")])
def test_low_rate_is_refused(rate):
    """As by the weightings of ISO 2631-1."""
    with pytest.raises(ValueError, match=f"sampling rate is {rate} Hz, must be at least 50 Hz"):
        absorbed_power(np.zeros(100), rate)
