"""What is compared of a history: levels in bands, third octaves and lines of link passing; all by Fourier transform."""

import numpy as np
from scipy import signal

BANDS = ((0.5, 5.0), (5.0, 20.0), (20.0, 100.0), (100.0, 500.0))  # Hz
ROAD_BORNE, HIGH = BANDS[0], BANDS[3]
THIRD_OCTAVES = tuple(10.0 ** (k / 10.0) for k in range(20, 27))  # centres from 100 to 400 Hz
LINES = (1, 2, 3, 4)
HALF_LINE = 1.5  # Hz on either side of k v/p
LINES_SHARE = "share of lines"


def band_name(low, high):
    """Return what a level is called."""
    return f"{low:g}-{high:g} Hz"


def octave_name(centre):
    """Return what a third octave is called."""
    return f"octave/3 {centre:.0f} Hz"


def line_name(k):
    """Return what a line is called."""
    return f"line {k}"


def levels(vertical, rate, passing):
    """Return the RMS values of a history (k,) [m/s^2] by name.

    `rate` [Hz] is that of its samples, `passing` [Hz] that at which links pass, v/p. Bands are parts of the sum of all
    squares, third octaves and lines those under a Hann window. `LINES_SHARE` is the part of the mean square in `HIGH`
    that all its lines make; noise without lines has twice `HALF_LINE` over `passing` there.
    """
    frequency = np.fft.rfftfreq(len(vertical), 1.0 / rate)
    plain, hann = (_power(vertical, window) for window in ("boxcar", "hann"))

    def level(power, low, high):
        return float(np.sqrt(power[(low <= frequency) & (frequency < high)].sum()))

    found = {band_name(*band): level(plain, *band) for band in BANDS}
    step = 10.0**0.05
    found |= {octave_name(centre): level(hann, centre / step, centre * step) for centre in THIRD_OCTAVES}
    found |= {line_name(k): level(hann, k * passing - HALF_LINE, k * passing + HALF_LINE) for k in LINES}
    high = (HIGH[0] <= frequency) & (frequency < HIGH[1])
    lines = high & (np.abs(frequency - passing * np.round(frequency / passing)) < HALF_LINE)
    return found | {LINES_SHARE: float(hann[lines].sum() / hann[high].sum())}


def _power(vertical, window):
    """Mean squares (f,) of a history's parts, one a frequency."""
    weight = signal.get_window(window, len(vertical))
    parts = np.fft.rfft((vertical - vertical.mean()) * weight)
    return 2.0 * np.abs(parts) ** 2 / (len(vertical) * (weight**2).sum())


def within(vertical, rate, band):
    """Return the part of a history (k,) within a band (low, high) [Hz]."""
    parts, frequency = np.fft.rfft(vertical), np.fft.rfftfreq(len(vertical), 1.0 / rate)
    parts[(frequency < band[0]) | (frequency >= band[1])] = 0.0
    return np.fft.irfft(parts, len(vertical))
