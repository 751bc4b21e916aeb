"""Frequency weightings Wk, Wd and Wf of [ISO2631-1], annex A, at any sampling rate from 50 Hz on.

The standard's transfer functions are applied to spectra (`vibration.through`), so that no sampling rate bends them: up
to half the rate they are the analogue ones. Beyond it a recording holds nothing, and no weighting can bring it back.
"""

from math import inf, pi, sqrt
from typing import NamedTuple

import numpy as np
from scipy.signal import bilinear

from .vibration import through

LEAST_RATE = 50.0  # Hz; below it less than half of what Wk weighs most is in the band
REACH = 100.0  # Hz, upper end of the band of Wk and Wd; a rate of less than twice it cuts into it


class Weighting(NamedTuple):
    """Parameters of the transfer functions, [ISO2631-1] tables A.1 and A.2."""

    limits: tuple  # f1, f2 [Hz] of the band, second-order Butterworth
    transition: tuple  # f3, f4 [Hz], Q4 of the transition from acceleration to velocity
    step: tuple | None  # f5 [Hz], Q5, f6 [Hz], Q6 of the upward step
    memory: float  # s, after which the slowest part has fallen by exp(-35)


WEIGHTINGS = {
    "Wk": Weighting((0.4, REACH), (12.5, 12.5, 0.63), (2.37, 0.91, 3.35, 0.91), 20.0),  # vertical
    "Wd": Weighting((0.4, REACH), (2.0, 2.0, 0.63), None, 20.0),  # horizontal
    "Wf": Weighting((0.08, 0.63), (inf, 0.25, 0.86), (0.0625, 0.80, 0.10, 0.80), 110.0),  # motion sickness, vertical
}


def transfer(name, frequency):
    """Return the transfer function (n,) of a weighting at frequencies (n,) [Hz], as annex A writes it."""
    p = 2j * pi * np.asarray(frequency, dtype=float)
    found = np.ones_like(p)
    for numerator, denominator in _sections(name):
        found *= np.polyval(numerator, p) / np.polyval(denominator, p)
    return found


def weighting_filter(name, rate):
    """Return a weighting as a recursive filter of second-order sections (n, 6) for samples at a rate [Hz].

    It is for what must be weighted while it comes, for the bilinear transform bends frequencies: at 1 kHz the corner
    at 100 Hz lies at 97 Hz.
    """
    require_rate(rate, "ISO 2631-1")
    return np.array([np.concatenate(bilinear(*section, rate)) for section in _sections(name)])


def _sections(name):
    """Return numerator and denominator of each part of annex A's transfer function, polynomials (3,) in p."""
    weighting = WEIGHTINGS[name]
    w1, w2 = (2.0 * pi * corner for corner in weighting.limits)
    (w3, w4), q4 = (2.0 * pi * corner for corner in weighting.transition[:2]), weighting.transition[2]
    sections = [
        ((1.0, 0.0, 0.0), (1.0, sqrt(2.0) * w1, w1**2)),
        ((0.0, 0.0, 1.0), (1.0 / w2**2, sqrt(2.0) / w2, 1.0)),
        ((0.0, 1.0 / w3, 1.0), (1.0 / w4**2, 1.0 / (q4 * w4), 1.0)),
    ]
    if weighting.step:
        f5, q5, f6, q6 = weighting.step
        w5, w6 = 2.0 * pi * f5, 2.0 * pi * f6
        part = (w5 / w6) ** 2
        sections.append(((part / w5**2, part / (q5 * w5), part), (1.0 / w6**2, 1.0 / (q6 * w6), 1.0)))
    return sections


def weighted(acceleration, name, rate):
    """Return accelerations (k, ...) [m/s^2], one row a sample, under the weighting "Wk", "Wd" or "Wf".

    The weighting starts as if the first sample had lasted for ever, so that gravity leaves no transient.

    Raises
    ------
    ValueError
        The rate [Hz] is below `LEAST_RATE`.
    """
    require_rate(rate, "ISO 2631-1")
    return through(lambda frequency: transfer(name, frequency), acceleration, rate, WEIGHTINGS[name].memory)


def require_rate(rate, what):
    """Raise ValueError if a sampling rate [Hz] is below `LEAST_RATE`, of which `what` cannot be had."""
    if not rate >= LEAST_RATE:
        raise ValueError(f"sampling rate is {rate} Hz, must be at least {LEAST_RATE:g} Hz for {what}")
