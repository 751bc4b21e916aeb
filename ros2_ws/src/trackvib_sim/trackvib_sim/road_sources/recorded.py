"""The road of a recorded run, from the patches in its bag."""

from dataclasses import dataclass

import numpy as np

from ..bags.errors import BagError
from ..bags.reading import read_recording
from ..road.profile import ProfileError


@dataclass(frozen=True, eq=False)
class RecordedRoad:
    """Heights where they were recorded; before and behind them the road goes on level."""

    spacing: float  # m, between samples
    first: int
    samples: np.ndarray  # (2, n) m
    begins = 0.0  # m; a run began there

    @property
    def ends(self) -> float:
        """Distance at which the recording ends [m]."""
        return self.spacing * (self.first + self.samples.shape[1] - 1)

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""
        index = np.clip(np.arange(first, first + count) - self.first, 0, self.samples.shape[1] - 1)
        return self.samples[:, index]


def read_recorded_road(bag):
    """Return the `RecordedRoad` of a bag.

    Raises
    ------
    ProfileError
        The bag cannot be read, or its patches leave a gap or differ in their spacing.
    """
    try:
        patches = read_recording(bag).road
    except BagError as error:
        raise ProfileError(str(error)) from None
    if not patches:
        raise ProfileError(f"{bag} holds no road")
    spacings = {spacing for _, spacing, *_ in patches}
    if len(spacings) > 1:
        raise ProfileError(f"{bag}: road of {len(spacings)} spacings, accepted is one")
    (spacing,) = spacings
    found = {}
    for start, _, left, right in patches:
        first = round(start / spacing)
        found.update({first + k: pair for k, pair in enumerate(zip(left.tolist(), right.tolist(), strict=True))})
    order = sorted(found)
    gaps = [k for k, after in zip(order, order[1:], strict=False) if after != k + 1]
    if gaps:
        raise ProfileError(f"{bag}: no road from {gaps[0] * spacing:g} m on, accepted is one without gaps")
    return RecordedRoad(spacing, order[0], np.array([found[k] for k in order]).T.copy())
