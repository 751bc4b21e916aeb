"""Frequency weightings of ISO 2631-1: the standard's tabulated factors, its transfer functions, and a sine's level."""

import numpy as np
import pytest
from scipy import signal
from trackvib_sim.analysis.iso2631 import LEAST_RATE, WEIGHTINGS, sections, weighted

# [ISO2631-1] table 3, from 0.1 Hz to 400 Hz in one-third octaves, factors times 1000; at 10 Hz it prints 212 for Wd,
# where its own transfer function gives 201
FACTORS = {
    "Wk": [31.2, 48.6, 79.0, 121, 182, 263, 352, 418, 459, 477, 482, 484, 494, 531, 631, 804, 967, 1039, 1054, 1036,
           988, 902, 768, 636, 513, 405, 314, 246, 186, 132, 88.7, 54.0, 28.5, 15.2, 7.90, 3.98, 1.95],
    "Wd": [62.4, 97.3, 158, 243, 365, 530, 713, 853, 944, 992, 1011, 1008, 968, 890, 776, 642, 512, 409, 323, 253,
           212, 161, 125, 100, 80.0, 63.2, 49.4, 38.8, 29.5, 21.1, 14.1, 8.63, 4.55, 2.43, 1.26, 0.64, 0.31],
}  # fmt: skip
THIRDS = np.array([1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0])
BANDS = np.concatenate([THIRDS / 10.0, THIRDS, THIRDS * 10.0, THIRDS[:7] * 100.0])  # Hz, nominal centres, as printed


def gain(name, rate, frequency=BANDS):
    """Return the digital filter's gain at frequencies [Hz]."""
    return np.abs(signal.sosfreqz(sections(name, rate), frequency, fs=rate)[1])


def transfer(name, frequency):
    """Return the standard's transfer function at frequencies [Hz], as its annex A writes it."""
    p = 2j * np.pi * frequency
    w1, w2, w3, w4 = (2.0 * np.pi * f for f in (0.4, 100.0, *WEIGHTINGS[name].transition[:2]))
    q4, step = WEIGHTINGS[name].transition[2], 1.0
    if WEIGHTINGS[name].step:
        f5, q5, f6, q6 = WEIGHTINGS[name].step
        w5, w6 = 2.0 * np.pi * f5, 2.0 * np.pi * f6
        step = (1 + p / (q5 * w5) + (p / w5) ** 2) / (1 + p / (q6 * w6) + (p / w6) ** 2) * (w5 / w6) ** 2
    limits = 1 / (1 + np.sqrt(2) * w1 / p + (w1 / p) ** 2) / (1 + np.sqrt(2) * p / w2 + (p / w2) ** 2)
    return limits * (1 + p / w3) / (1 + p / (q4 * w4) + (p / w4) ** 2) * step


@pytest.mark.literature
@pytest.mark.parametrize("name", WEIGHTINGS)
def test_transfer_function_gives_the_tabulated_factors(name):
    """To the digits printed, but for the misprint."""
    printed = np.array(FACTORS[name]) / 1000.0
    sound = np.full(BANDS.size, True)
    sound[20] = name != "Wd"
    assert np.abs(transfer(name, BANDS))[sound] == pytest.approx(printed[sound], rel=0.007)


@pytest.mark.literature
@pytest.mark.parametrize("name", WEIGHTINGS)
@pytest.mark.parametrize("rate", [LEAST_RATE, 1000.0, 10000.0])
def test_filter_is_within_the_tolerance(name, rate):
    """The standard allows 1 dB from 0.5 to 80 Hz and 2 dB outside; the filter may fall faster above 100 Hz."""
    error = 20.0 * np.log10(gain(name, rate) / np.array(FACTORS[name]) * 1000.0)[rate / 2.0 > BANDS]
    band = BANDS[rate / 2.0 > BANDS]
    assert np.abs(error[(band > 0.45) & (band < 90.0)]).max() < 1.0
    assert np.abs(error[band < 0.45]).max() < 2.0
    assert error[band > 90.0].max() < 2.0


@pytest.mark.analytic
@pytest.mark.parametrize("name", WEIGHTINGS)
def test_filter_becomes_the_transfer_function(name):
    """With a rising rate the difference up to 100 Hz falls as 1 / rate^2, phase included."""
    frequency = np.geomspace(0.1, 100.0, 50)

    def error(rate):
        response = signal.sosfreqz(sections(name, rate), frequency, fs=rate)[1]
        return np.abs(response - transfer(name, frequency)).max()

    assert error(4000.0) < 2e-3
    assert error(4000.0) / error(8000.0) == pytest.approx(4.0, rel=0.05)


@pytest.mark.analytic
def test_sine_upon_gravity_has_its_weighted_level():
    """1 m/s^2 RMS at 5 Hz in one column and 2 Hz in the other; gravity leaves nothing."""
    time = np.arange(20_000) / 1000.0
    sines = np.sqrt(2.0) * np.sin(2.0 * np.pi * np.outer(time, (5.0, 2.0)))
    levels = np.sqrt(np.mean(weighted(9.81 + sines, "Wk", 1000.0)[10_000:] ** 2, axis=0))
    assert levels == pytest.approx(np.abs(transfer("Wk", np.array((5.0, 2.0)))), rel=1e-3)
    assert np.abs(weighted(np.full(5000, 9.81), "Wk", 1000.0)).max() < 1e-9


@pytest.mark.property
@pytest.mark.parametrize("rate", [499.0, 0.0, float("nan")])
def test_low_rate_is_refused(rate):
    """Where the filter could not hold the tolerance there is none."""
    with pytest.raises(ValueError, match=f"sampling rate is {rate} Hz, must be at least 500 Hz"):
        sections("Wk", rate)
