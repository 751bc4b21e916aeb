"""Frequency weightings Wk and Wd of [ISO2631-1], annex A, as digital filters.

Each factor of the standard's transfer functions, band limits included, becomes a second-order section by the bilinear
transform, whose warping is undone at the factor's own corner frequencies.
"""

from math import pi, sqrt, tan
from typing import NamedTuple

import numpy as np
from scipy import signal

LEAST_RATE = 500.0  # Hz; below it the filters leave the standard's tolerance
_BAND = (0.4, 100.0)  # Hz, of second-order Butterworth filters


class Weighting(NamedTuple):
    """Parameters of the transfer functions, [ISO2631-1] table A.1."""

    transition: tuple  # f3, f4 [Hz], Q4 of the transition from acceleration to velocity
    step: tuple | None  # f5 [Hz], Q5, f6 [Hz], Q6 of the upward step


WEIGHTINGS = {
    "Wk": Weighting((12.5, 12.5, 0.63), (2.37, 0.91, 3.35, 0.91)),  # vertical
    "Wd": Weighting((2.0, 2.0, 0.63), None),  # horizontal
}


def sections(name, rate):
    """Return the second-order sections (m, 6) of a weighting at a sampling rate [Hz], as `scipy.signal.sosfilt` wants.

    Raises
    ------
    ValueError
        The rate is too low for the standard's tolerance.
    """
    if not rate >= LEAST_RATE:
        raise ValueError(f"sampling rate is {rate} Hz, must be at least {LEAST_RATE:g} Hz for ISO 2631-1")

    def corner(frequency):
        return 2.0 * rate * tan(pi * frequency / rate)  # rad/s, which the bilinear transform takes to `frequency`

    low, high = map(corner, _BAND)
    weighting = WEIGHTINGS[name]
    f3, f4, q4 = weighting.transition
    w3, w4 = corner(f3), corner(f4)
    factors = [  # numerator and denominator in falling powers of s
        ((1.0, 0.0, 0.0), (1.0, sqrt(2.0) * low, low**2)),
        ((0.0, 0.0, high**2), (1.0, sqrt(2.0) * high, high**2)),
        ((0.0, w4**2 / w3, w4**2), (1.0, w4 / q4, w4**2)),
    ]
    if weighting.step:
        f5, q5, f6, q6 = weighting.step
        w5, w6 = corner(f5), corner(f6)
        factors.append(((1.0, w5 / q5, w5**2), (1.0, w6 / q6, w6**2)))
    return np.array([np.concatenate(signal.bilinear(*factor, fs=rate)) for factor in factors])


def weighted(acceleration, name, rate):
    """Return accelerations (k, ...) [m/s^2], one row a sample, under the weighting "Wk" or "Wd".

    The filter starts as if the first sample had lasted for ever, so that gravity leaves no transient.

    Raises
    ------
    ValueError
        As `sections` does.
    """
    filters = sections(name, rate)
    acceleration = np.asarray(acceleration, dtype=float)
    at_rest = signal.sosfilt_zi(filters)
    start = at_rest.reshape(*at_rest.shape, *[1] * (acceleration.ndim - 1)) * acceleration[0]
    return signal.sosfilt(filters, acceleration, axis=0, zi=start)[0]
