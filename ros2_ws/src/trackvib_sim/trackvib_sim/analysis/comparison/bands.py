"""The bands in which two drives are compared: all of both, weighted, third octaves, lines with a known cause."""

from typing import NamedTuple

import numpy as np

from ..iso2631 import transfer
from ..levels import WEIGHTINGS
from ..numbers import AXES
from ..vibration import LOWEST

FIRST, LAST = 3, 27  # numbers of third octaves: 2 to 500 Hz
LEAST_WIDTH = 0.4  # Hz, of a band that windows of 2 s tell apart


class Band(NamedTuple):
    """What of a spectrum is summed up; of lines both drives have their own."""

    quantity: str
    frequency: float  # Hz, nan of a wide one
    weights: np.ndarray  # (f, 3) of the frequencies, by axis


def common_bands(frequency, highest, weighted):
    """Return the `Band`s that do not depend on the drive.

    Parameters
    ----------
    frequency : (f,) array
        Evenly spaced, from 0, Hz.
    highest : float
        Up to which both drives hold something, Hz.
    weighted : bool
        Whether the rates of both allow the weightings of ISO 2631-1.
    """
    every = _between(frequency, LOWEST, highest)
    found = [Band("RMS", np.nan, every)]
    if weighted:
        gains = np.zeros((len(frequency), len(AXES)))
        for column, name in enumerate(WEIGHTINGS):
            gains[1:, column] = np.abs(transfer(name, frequency[1:])) ** 2
        found.append(Band("RMS, weighted", np.nan, gains * _between(frequency, 0.0, highest)))
    for number in range(FIRST, LAST + 1):
        centre = 10.0 ** (number / 10.0)
        low, high = centre * 10.0**-0.05, centre * 10.0**0.05
        if high <= highest and high - low >= LEAST_WIDTH:
            found.append(Band("RMS, third octave", round_third(centre), _between(frequency, low, high)))
    return found


def line_bands(frequency, lines, highest):
    """Return `Band`s of `numbers.Line`s by name."""
    return {
        line.name: Band(line.name, line.frequency, _between(frequency, line.low, line.high))
        for line in lines
        if line.high <= highest
    }


def round_third(centre):
    """Return the nominal centre of a third octave."""
    power = 10.0 ** np.floor(np.log10(centre) + 1e-9)
    nominal = np.array((1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0))
    return float(power * nominal[np.abs(np.log(nominal * power / centre)).argmin()])


def _between(frequency, low, high):
    """Return the part of each bin (f, 3) that lies between two frequencies."""
    half = 0.5 * frequency[1]
    inside = np.minimum(frequency + half, high) - np.maximum(frequency - half, low)
    return np.repeat((np.clip(inside, 0.0, None) / frequency[1])[:, None], len(AXES), axis=1)
