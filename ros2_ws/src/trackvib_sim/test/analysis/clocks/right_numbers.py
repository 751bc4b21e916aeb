"""What tests of clocks have in common: numbers are as if the clocks had been perfect, and what was done is told."""

import numpy as np
import pytest

from .made_sensors import RMS_Z, TONES

LOGGED = pytest.mark.parametrize("logged", [True, False], ids=["recorder's times", "stamps alone"])


def require_right(found, rate, tones=False):
    """Make sure that an `Analysis` has the numbers of the made motion, as the issue's bounds have it."""
    assert found.rate == pytest.approx(rate, rel=1e-3)
    for name, gain in (("chassis", 1.0), ("powertrain", 0.5)):
        assert found.sensors[name]["z"].rms == pytest.approx(gain * RMS_Z, rel=0.02)
        assert found.sensors[name]["z"].mean == pytest.approx(9.81, rel=0.01)
    frequency, spectra = found.spectra.frequency, found.spectra
    strongest = np.argsort(spectra.psd["chassis"][1:, 2])[::-1][:6] + 1
    for tone in TONES:
        at = int(np.argmin(np.abs(frequency - tone)))
        assert at in strongest
        assert spectra.transmissibility[at, 2] == pytest.approx(0.5, rel=0.02)
        assert spectra.coherence[at, 2] > 0.95
    if tones:
        band = (frequency >= 2.0) & (frequency <= 0.4 * rate)
        assert spectra.coherence[band, 1].min() > 0.95
        assert spectra.transmissibility[band, 1] == pytest.approx(0.5, rel=0.02)


def says(found, *words):
    """Return whether a note holds all words."""
    return any(all(word in note for word in words) for note in found.notes)
