"""Random road profiles of ISO 8608 by superposition of harmonics, reproducible from (seed, distance).

[ISO8608] gives the displacement power spectral density G_d(n) = G_d(n0) (n / n0)^-2 with n0 = 0.1 1/m and the
geometric means G_d(n0) = 16e-6 * 4^k m^3 for the classes A (k = 0) to H (k = 7). [Tao2025] sums harmonics of it with
random phase.

The standard says nothing of left beside right. A surface with the same statistics in all directions and waviness 2 has
the coherence x K1(x), x = 2 pi n d, between two lines d apart [Kamash1978]; K1 is the modified Bessel function.

[Kamash1978] K. M. A. Kamash, J. D. Robson, The application of isotropy in road surface modelling, J. Sound Vib. 57
(1978) 89-100.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import k1

from ..numerics.angles import sine_cosine
from ..numerics.compiled import kernel
from .classes import CLASSES

REFERENCE_FREQUENCY = 0.1  # 1/m
LOWEST, HIGHEST = 0.011, 2.83  # 1/m, the standard's range
HARMONICS = 1000
KEPT, LONGEST_KEPT = 1000, 1000  # patches, and samples of one: studies drive over the same few roads again and again
SPACING = 0.05  # m
TREAD = 2.8  # m between the tracks, by default
LEVEL_UNTIL, FADE = 8.0, 8.0  # m, by default: a vehicle starts on level ground, then the roughness fades in


class Roughness(NamedTuple):
    """A displacement PSD as in [ISO8608], G_d(n) = level (n / n0)^-waviness within a band.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.roughness_of("C").level, tv.Roughness(1e-4, waviness=2.5).psd(0.1)
    (0.000256, np.float64(0.0001))
    """

    level: float  # G_d(n0), m^3
    waviness: float = 2.0
    lowest: float = LOWEST  # 1/m
    highest: float = HIGHEST

    def psd(self, frequency):
        """Return the one-sided PSD [m^3] at spatial frequencies [1/m]."""
        return self.level * (np.asarray(frequency) / REFERENCE_FREQUENCY) ** -self.waviness

    @property
    def rms(self) -> float:
        """RMS value of the heights [m]."""
        edges = np.geomspace(self.lowest, self.highest, HARMONICS + 1)
        return float(np.sqrt(np.sum(self.psd(np.sqrt(edges[:-1] * edges[1:])) * np.diff(edges))))


def roughness_of(road_class: str) -> Roughness:
    """Return the `Roughness` of a class of the standard, its geometric mean.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.roughness_of("C").level  # m^3
    0.000256
    """
    return Roughness(16e-6 * 4.0 ** CLASSES.index(road_class))


@dataclass(frozen=True)
class Isotropic:
    """Coherence |G_lr| / sqrt(G_ll G_rr) of two parallel lines on an isotropic surface.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Isotropic(2.8)(0.1).round(2), tv.Isotropic(0.0)(0.1)
    (np.float64(0.34), np.float64(1.0))
    """

    distance: float = TREAD  # m, between the lines

    def __call__(self, frequency):
        """Return the coherence at spatial frequencies [1/m]."""
        x = np.maximum(2.0 * np.pi * np.asarray(frequency) * self.distance, np.finfo(float).tiny)
        return x * k1(x)


@dataclass(frozen=True)
class Exponential:
    """Coherence |G_lr| / sqrt(G_ll G_rr) that falls as exp(-length n).

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Exponential(1.4)(0.1).round(2)
    np.float64(0.87)
    """

    length: float  # m

    def __call__(self, frequency):
        """Return the coherence at spatial frequencies [1/m]."""
        return np.exp(-self.length * np.asarray(frequency))


@dataclass(frozen=True)
class Iso8608Road:
    """An endless random road of one class, or of a given `Roughness`.

    It is level up to `level_until` from its beginning, then the roughness fades in over `fade` [m]. The same holds
    behind the beginning.

    Sample i is at the distance i * `spacing`. Each of `HARMONICS` logarithmic bands contains one harmonic at a random
    frequency, so that the profile has no period.

    Examples
    --------
    Left and right, metres, beyond the level start:

    >>> import trackvib_sim as tv
    >>> heights = tv.Iso8608Road("E", seed=1).heights(first=400, count=1000)
    >>> heights.shape, bool(0.001 < heights.std() < 0.1)
    ((2, 1000), True)
    """

    roughness: str | Roughness  # a class by its letter
    seed: int
    level_until: float = LEVEL_UNTIL
    fade: float = FADE
    coherence: Callable = Isotropic()  # of left and right, a hashable function of the spatial frequency
    spacing: float = SPACING  # m, between samples

    ends = np.inf  # m

    @property
    def begins(self) -> float:
        """Distance from which the road has its full roughness [m]."""
        return self.level_until + self.fade

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`.

        The result for a sample does not depend on the requested patch, to the last bit.
        """
        return _kept(self, first, count).copy() if count <= LONGEST_KEPT else _heights(self, first, count)

    @cached_property
    def _harmonics(self):
        """Angular spatial frequencies (h,) [rad/m] and, of left and right, parts (2, 2, h) with cosine and sine [m]."""
        random = np.random.default_rng(self.seed)
        given = roughness_of(self.roughness) if isinstance(self.roughness, str) else self.roughness
        edges = np.geomspace(given.lowest, given.highest, HARMONICS + 1)
        frequency = edges[:-1] + (edges[1:] - edges[:-1]) * random.random(HARMONICS)
        amplitude = np.sqrt(2.0 * given.psd(frequency) * (edges[1:] - edges[:-1]))
        common = self.coherence(frequency)
        shared, *own = 2.0 * np.pi * random.random((3, HARMONICS))
        # each side is a shared part and one of its own: G_lr = coherence * G, G_ll = G_rr = G
        parts = [
            amplitude * (np.sqrt(common) * turn(shared) + np.sqrt(1.0 - common) * turn(phase))
            for phase in own
            for turn in (np.cos, np.sin)
        ]
        return 2.0 * np.pi * frequency, np.reshape(parts, (2, 2, HARMONICS))


def _heights(road, first, count):
    heights = np.empty((2, count))
    _superpose(heights, first, road.spacing, *road._harmonics, road.level_until, road.fade)
    return heights


_kept = lru_cache(KEPT)(_heights)


@kernel
def _superpose(heights, first, spacing, frequency, parts, level_until, fade):
    for i in range(heights.shape[1]):
        distance = (first + i) * spacing
        left, right = 0.0, 0.0
        for h in range(frequency.size):
            sine, cosine = sine_cosine(frequency[h] * distance)
            left += parts[0, 0, h] * cosine - parts[0, 1, h] * sine
            right += parts[1, 0, h] * cosine - parts[1, 1, h] * sine
        progress = min(max((abs(distance) - level_until) / fade, 0.0), 1.0)
        window = 0.5 - 0.5 * np.cos(np.pi * progress)
        heights[0, i] = window * left
        heights[1, i] = window * right
