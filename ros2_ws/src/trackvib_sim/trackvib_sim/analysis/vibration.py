"""Vibration measures of sampled accelerations."""

import numpy as np
from scipy import signal

LOWEST = 0.5  # Hz; below it lie gravity, slopes of the road and changes of speed


def band(rate):
    """Return the fixed band (low, high) [Hz] over which RMS values are taken at a sampling rate [Hz]."""
    return LOWEST, 0.5 * rate


def band_limited(acceleration, rate, highest=None):
    """Return accelerations (k, ...) with everything below the band removed, without shifting phases.

    Second-order Butterworth high-pass, run forwards and backwards. The upper end of the band is the Nyquist frequency,
    or `highest` [Hz] by a low-pass of eighth order, likewise.
    """
    sections = signal.butter(2, LOWEST, "highpass", fs=rate, output="sos")
    if highest is not None:
        sections = np.vstack((sections, signal.butter(8, highest, fs=rate, output="sos")))
    # mirrored at the ends: an odd continuation would turn about the last value, which is mostly vibration
    ends = min(len(acceleration) - 1, round(2.0 * rate / LOWEST))
    return signal.sosfiltfilt(sections, acceleration, axis=0, padtype="even", padlen=ends)


def rms(acceleration):
    """Return the root mean square of each column."""
    return np.sqrt(np.mean(np.square(acceleration), axis=0))


def psd(acceleration, rate, resolution=1.0):
    """Return frequencies [Hz] and the one-sided power spectral density [(m/s^2)^2/Hz] of each column by Welch's method.

    `resolution` [Hz] is the width of a frequency bin; windows are Hann with half overlap.
    """
    segment = min(int(round(rate / resolution)), len(acceleration))
    return signal.welch(acceleration, fs=rate, nperseg=segment, axis=0)
