"""A single bump across the whole width of a level road."""

from dataclasses import dataclass

import numpy as np

from .iso8608 import SPACING


@dataclass(frozen=True)
class Bump:
    """A level road with one raised cosine, height / 2 (1 - cos(2 pi x / length)), that begins at distance `start`.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> float(tv.Bump(height=0.1, length=1.0, start=10.0).heights(first=0, count=400).max())
    0.1
    """

    height: float  # m
    length: float  # m
    start: float  # m
    spacing: float = SPACING  # m, between samples

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""
        place = (self.spacing * np.arange(first, first + count) - self.start) / self.length
        bump = np.where((place > 0.0) & (place < 1.0), 0.5 * self.height * (1.0 - np.cos(2.0 * np.pi * place)), 0.0)
        return np.stack((bump, bump))
