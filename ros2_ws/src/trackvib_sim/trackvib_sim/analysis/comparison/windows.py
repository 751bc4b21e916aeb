"""A drive as short windows: of each when it was, how fast, where, and its powers in bands."""

from typing import NamedTuple

import numpy as np
from scipy import signal

from ...numerics.units import NANO
from ..motion import speed_of, way_of
from ..numbers import SENSORS
from ..stamps import blocks

LENGTH = 2.0  # s: bins of 0.5 Hz
_BLOCK = 100  # windows at a time


class Windows(NamedTuple):
    """n windows, Hann, half overlapping, of all segments that count."""

    speed: np.ndarray  # (n,) m/s, nan where unknown
    way: np.ndarray  # (n,) m, likewise
    power: np.ndarray  # (n, b, 2, 3) mean square in bands, by sensor and axis, (m/s^2)^2
    cross: np.ndarray  # (n, b, 3) complex, of chassis and powertrain


def frequencies(rate):
    """Return the frequencies (f,) [Hz] of a window at a rate [Hz]; of a higher rate there are more of the same."""
    return np.arange(round(LENGTH * rate) // 2 + 1) / LENGTH


def windows_of(recording, segments, bands):
    """Return the `Windows` of a recording's `segments.Segments`, reduced to `bands.Band`s."""
    length = round(LENGTH * segments.rate)
    hop = length - length // 2
    weights = np.stack([band.weights for band in bands]) / LENGTH  # density times width of a bin
    window = signal.get_window("hann", length)
    scale = np.full(length // 2 + 1, 2.0 / (segments.rate * np.square(window).sum()))
    scale[0] *= 0.5
    if length % 2 == 0:
        scale[-1] *= 0.5
    speed, way = speed_of(recording), way_of(recording)
    speeds, ways, powers, crosses = [], [], [], []
    for segment in segments.segments:
        pair = [getattr(recording, sensor) for sensor in SENSORS]
        firsts = [first + segment.measured for first in segment[:2]]
        count = (segment.size - segment.measured - length // 2) // hop
        for block in blocks(max(count, 0), _BLOCK):
            begin = hop * np.arange(block.start, block.stop)
            spectra = [
                _spectra(each.specific_force, first + begin, window) for each, first in zip(pair, firsts, strict=True)
            ]
            density = np.stack([scale[:, None] * np.abs(each) ** 2 for each in spectra], axis=2)
            powers.append(np.einsum("bfa,nfsa->nbsa", weights, density, optimize=True))
            product = scale[:, None] * np.conj(spectra[0]) * spectra[1]
            crosses.append(np.einsum("bfa,nfa->nba", weights, product, optimize=True))
            middle = pair[0].stamp[firsts[0] + begin] + round(0.5 * LENGTH * NANO)
            for found, slow in ((speeds, speed), (ways, way)):
                found.append(np.full(len(begin), np.nan) if slow is None else slow.at(middle))
    if not powers:
        raise ValueError(f"no part of it without a gap is {LENGTH:g} s long, after settling")
    return Windows(*(np.concatenate(each) for each in (speeds, ways, powers, crosses)))


def _spectra(values, begin, window):
    cut = np.stack([np.array(values[first : first + len(window)]) for first in begin])
    cut -= cut.mean(axis=1, keepdims=True)
    return np.fft.rfft(cut * window[:, None], axis=1)
