"""Mean spectra of both sensors over segments of any length, in blocks as in `levels`."""

import numpy as np
from scipy import signal

from .numbers import Spectra
from .stamps import blocks
from .vibration import psd

BLOCK = 120.0  # s
WINDOW = 1.0  # s: a resolution of 1 Hz


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
