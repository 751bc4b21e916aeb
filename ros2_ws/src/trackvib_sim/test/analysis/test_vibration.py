"""Vibration measures against signals whose answer is known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.analysis.vibration import LOWEST, band, band_limited, psd, rms

RATE = 1000.0
TIME = np.arange(20_000) / RATE


@pytest.mark.analytic
@given(amplitude=st.floats(1e-3, 1e3), frequency=st.integers(1, 499), phase=st.floats(0.0, 6.3))
def test_rms_of_a_sine(amplitude, frequency, phase):
    """Over whole periods a sine has its amplitude over the root of two; columns do not mix."""
    sine = amplitude * np.sin(2.0 * np.pi * frequency * TIME + phase)
    assert_allclose(rms(np.stack((sine, 0.0 * sine, 2.0 + 0.0 * sine), axis=1)), (amplitude / np.sqrt(2.0), 0.0, 2.0))


@pytest.mark.analytic
@pytest.mark.parametrize("frequency", [0.5, 1.0, 5.0, 100.0])
def test_band_limit_has_the_response_of_its_filter(frequency):
    """Twice through a Butterworth high-pass: gain 1 / (1 + (f_c / f)^4), phase zero.

    In the middle of 20 s the ends, which die out within seconds, are forgotten; the bilinear transform moves
    100 Hz by (pi f / rate)^2 / 3, where the gain is 1 anyway.
    """
    middle = slice(8000, 12_000)
    wave = np.sin(2.0 * np.pi * frequency * TIME)[:, None] * (1.0, 2.0, -1.0) + 9.81
    gain = 1.0 / (1.0 + (LOWEST / frequency) ** 4)
    assert_allclose(band_limited(wave, RATE)[middle], gain * (wave - 9.81)[middle], atol=2e-3)


@pytest.mark.property
def test_band_limit_removes_gravity():
    """A constant is gone altogether."""
    assert_allclose(band_limited(np.full((5000, 3), 9.81), RATE), 0.0, atol=1e-9)


@pytest.mark.property
def test_band_reaches_from_its_low_end_to_nyquist():
    """The band that RMS values are taken over ends at half the sampling rate."""
    assert band(RATE) == (0.5, 500.0)


@pytest.mark.analytic
def test_psd_of_white_noise_is_flat():
    """White noise of variance v has 2 v / rate in every band; Welch's mean over 39 windows is good to some 10 %."""
    noise = np.random.default_rng(3).normal(scale=3.0, size=(20_000, 2))
    frequency, density = psd(noise, RATE)
    assert frequency[1] == pytest.approx(1.0) and frequency[-1] == 500.0
    # means over 100 bins and 20 independent windows: 1 / sqrt(2000) of spread, four of them
    for low in range(10, 410, 100):
        assert_allclose(density[low : low + 100].mean(axis=0), 2.0 * 9.0 / RATE, rtol=0.09)


@pytest.mark.analytic
@pytest.mark.parametrize("resolution", [0.5, 1.0, 2.0])
def test_psd_of_a_sine_is_a_line(resolution):
    """A sine's power lies within two bins of its frequency and is half its amplitude squared."""
    frequency, density = psd(3.0 * np.sin(2.0 * np.pi * 50.0 * TIME)[:, None], RATE, resolution)
    assert frequency[1] == pytest.approx(resolution)
    near = np.abs(frequency - 50.0) <= 2.0 * resolution
    power = density[:, 0] * resolution
    assert power[near].sum() == pytest.approx(4.5, rel=1e-9)
    assert power[~near].sum() < 1e-9
    assert frequency[power.argmax()] == pytest.approx(50.0)


@pytest.mark.property
def test_psd_of_a_short_signal_uses_all_of_it():
    """A signal shorter than a window of the wanted resolution is taken whole."""
    frequency, _ = psd(np.random.default_rng(1).normal(size=(300, 3)), RATE)
    assert frequency[1] == pytest.approx(RATE / 300)
