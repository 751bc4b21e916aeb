"""Mean spectra of both sensors over segments of any length, in blocks as in `levels`, and levels about known lines."""

import numpy as np
from scipy import signal

from .numbers import Line, Spectra
from .segments import blocks
from .summary import AXES, SENSORS
from .vibration import psd

BLOCK = 120.0  # s
WINDOW = 1.0  # s: a resolution of 1 Hz
HALF_WIDTH = 2.0  # Hz, to either side of a line: what a Hann window spreads a sine over, rounded up
HARMONICS = 3  # of link passing


class MeanSpectra:
    """What has been summed up of windows over both sensors."""

    def __init__(self, rate):
        self._rate = rate
        self._segment = round(WINDOW * rate)
        self._windows = 0
        self._frequency, self._chassis, self._powertrain, self._cross = None, 0.0, 0.0, 0.0

    def add(self, chassis, powertrain):
        """Add a measured segment: specific forces (k, 3) of both sensors at the same instants."""
        segment = self._segment
        hop = segment - segment // 2  # scipy's own half overlap
        for block in blocks((len(chassis) - segment // 2) // hop, round(BLOCK / WINDOW)):
            samples = slice(block.start * hop, (block.stop - 1) * hop + segment)
            pair = [np.array(each[samples]) for each in (chassis, powertrain)]
            windows = block.stop - block.start
            (self._frequency, below), (_, above) = (psd(each, self._rate, 1.0 / WINDOW) for each in pair)
            cross = signal.csd(*pair, fs=self._rate, nperseg=segment, axis=0)[1]
            self._chassis = self._chassis + windows * below
            self._powertrain = self._powertrain + windows * above
            self._cross = self._cross + windows * cross
            self._windows += windows

    def spectra(self):
        """Return the `Spectra`; coherence and transmissibility are nan where the chassis does not move."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return Spectra(
                self._frequency,
                {"chassis": self._chassis / self._windows, "powertrain": self._powertrain / self._windows},
                np.abs(self._cross) ** 2 / (self._chassis * self._powertrain),
                np.abs(self._cross) / self._chassis,
            )


def known_lines(spectra, speed, speed_deviation, pitch, engine_speed, orders):
    """Return the `Line`s of links entering the sprockets and of the engine that lie within the spectra.

    Parameters
    ----------
    spectra : Spectra
    speed, speed_deviation : float
        Of the hull, m/s. The band about a line of link passing is wider by two deviations.
    pitch : float
        Of the tracks, m.
    engine_speed : float
        r/min
    orders : sequence of float
        Of the engine, cycles a revolution.
    """
    passing, turning = speed / pitch, engine_speed / 60.0
    wanted = [
        (f"link passing {n}", n * passing, HALF_WIDTH + 2.0 * n * speed_deviation / pitch)
        for n in range(1, HARMONICS + 1)
    ]
    wanted += [(f"engine order {order:g}", order * turning, HALF_WIDTH) for order in orders]
    highest = spectra.frequency[-1]
    return tuple(
        Line(name, frequency, max(frequency - half, 0.0), frequency + half, _in_band(spectra, frequency, half))
        for name, frequency, half in wanted
        if HALF_WIDTH < frequency <= highest - HALF_WIDTH  # false for nan
    )


def _in_band(spectra, frequency, half):
    inside = np.abs(spectra.frequency - frequency) <= half
    resolution = spectra.frequency[1]
    return {
        sensor: dict(zip(AXES, np.sqrt(spectra.psd[sensor][inside].sum(axis=0) * resolution).tolist(), strict=True))
        for sensor in SENSORS
    }
