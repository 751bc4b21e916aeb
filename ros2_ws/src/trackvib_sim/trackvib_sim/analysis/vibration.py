"""Vibration measures of sampled accelerations."""

from functools import lru_cache

import numpy as np
from scipy import fft, signal

IN_PHASE = 0.8  # of half the rate, up to which `through` keeps phases, too
FADE = 1.0  # s, in which what is put after the last sample dies away
LOWEST = 0.5  # Hz; below it lie gravity, slopes of the road and changes of speed


def band(rate):
    """Return the fixed band (low, high) [Hz] over which RMS values are taken at a sampling rate [Hz]."""
    return LOWEST, 0.5 * rate


def band_limited(acceleration, rate, highest=None):
    """Return accelerations (k, ...) with everything below the band removed, without shifting phases.

    Second-order Butterworth high-pass, run forwards and backwards. The upper end of the band is the Nyquist frequency,
    or `highest` [Hz] by a low-pass of eighth order, likewise.
    """
    # mirrored at the ends: an odd continuation would turn about the last value, which is mostly vibration
    ends = min(len(acceleration) - 1, round(2.0 * rate / LOWEST))
    return signal.sosfiltfilt(_band_filter(rate, highest), acceleration, axis=0, padtype="even", padlen=ends)


@lru_cache(maxsize=16)
def _band_filter(rate, highest):
    """Return the sections (n, 6) of a band's filter; to design it takes longer than to filter a second."""
    sections = signal.butter(2, LOWEST, "highpass", fs=rate, output="sos")
    if highest is None:
        return sections
    return np.vstack((sections, signal.butter(8, highest, fs=rate, output="sos")))


def through(transfer, samples, rate, memory):
    """Return samples (k, ...) as they come out of an analogue filter that lets nothing constant pass.

    The spectrum is multiplied by the filter's own, so that up to half the rate no frequency is bent: amplitudes are
    exact. Phases are up to `IN_PHASE` of it; beyond, they are led to zero, or else the jump that they have at half the
    rate would ring for long. The filter starts as if the first sample had lasted for ever; after the last one the
    samples go back and die away, so that nothing that ends there shows before.

    Parameters
    ----------
    transfer : callable
        Complex gain (n,) at frequencies (n,) [Hz] above 0.
    samples : (k, ...) array
    rate : float
        Hz
    memory : float
        Time after which the filter has forgotten what came in, s.
    """
    samples = np.asarray(samples, dtype=float)
    count = len(samples)
    back = min(count - 1, round(FADE * rate))
    columns = (-1, *[1] * (samples.ndim - 1))
    fade = _falling(np.arange(1, back + 1) / (back + 1))
    changes = samples - samples[0]
    changes = np.concatenate((changes, changes[count - 1 - back : count - 1][::-1] * fade.reshape(columns)))
    length = fft.next_fast_len(len(changes) + round(memory * rate), real=True)
    gain = np.zeros(length // 2 + 1, complex)
    frequency = fft.rfftfreq(length, 1.0 / rate)
    gain[1:] = transfer(frequency[1:])
    above = frequency > 0.5 * rate * IN_PHASE
    kept = _falling((2.0 * frequency[above] / rate - IN_PHASE) / (1.0 - IN_PHASE))
    gain[above] = np.abs(gain[above]) * np.exp(1j * np.unwrap(np.angle(gain[above])) * kept)
    with np.errstate(invalid="ignore"):  # what is no number stays none
        return fft.irfft(fft.rfft(changes, length, axis=0) * gain.reshape(columns), length, axis=0)[:count]


def _falling(part):
    """Return factors (n,) that fall from 1 to 0 without a corner as parts (n,) of the way go from 0 to 1."""
    return 0.5 + 0.5 * np.cos(np.pi * part)


def rms(acceleration):
    """Return the root mean square of each column."""
    return np.sqrt(np.mean(np.square(acceleration), axis=0))


def psd(acceleration, rate, resolution=1.0):
    """Return frequencies [Hz] and the one-sided power spectral density [(m/s^2)^2/Hz] of each column by Welch's method.

    `resolution` [Hz] is the width of a frequency bin; windows are Hann with half overlap.
    """
    segment = min(int(round(rate / resolution)), len(acceleration))
    return signal.welch(acceleration, fs=rate, nperseg=segment, axis=0)
