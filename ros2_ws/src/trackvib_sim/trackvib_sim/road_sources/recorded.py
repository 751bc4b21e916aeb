"""The road of a recorded run, from the patches in its bag."""

from dataclasses import dataclass

import numpy as np
from mr_mount_controller.node_base.plain_text import readable

from ..bags.errors import BagError
from ..bags.reading import read_recording
from ..road.profile import Profile, ProfileError, checked
from ..road.store import RoadStore


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

    @property
    def profile(self) -> Profile:
        """The same as a profile, to be driven elsewhere."""
        return Profile(self.spacing * (self.first + np.arange(self.samples.shape[1])), self.samples)

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""
        index = np.clip(np.arange(first, first + count) - self.first, 0, self.samples.shape[1] - 1)
        return self.samples[:, index]


def read_recorded_road(bag):
    """Return the `RecordedRoad` of a bag.

    Raises
    ------
    ProfileError
        The bag cannot be read, its patches cannot be used, or leave a gap or differ in their spacing.
    """
    try:
        patches = read_recording(bag).road
    except BagError as error:
        raise ProfileError(str(error)) from None
    return road_of_patches(patches, readable(str(bag)))


def road_of_patches(patches, name):
    """Return the `RecordedRoad` of patches (start, spacing, left, right) [m] from what is called `name`.

    Raises
    ------
    ProfileError
        They cannot be used, or leave a gap or differ in their spacing.
    """
    store = RoadStore()
    try:
        for patch in patches:
            store.add(*patch)
    except ValueError as error:
        raise ProfileError(f"{name}: a patch of road whose {error}") from None
    if not patches:
        raise ProfileError(f"{name} holds no road")
    spacings = {spacing for _, spacing, *_ in patches}
    if len(spacings) > 1:
        raise ProfileError(f"{name}: road of {len(spacings)} spacings, accepted: one")
    (spacing,) = spacings
    begin = min(start for start, *_ in patches)
    end = max(start + spacing * (len(left) - 1) for start, _, left, _ in patches)
    road = store.around(begin, end - 0.5 * spacing)
    if road is None:
        raise ProfileError(f"{name}: no road without gaps from {begin:g} to {end:g} m")
    recorded = RecordedRoad(road.spacing, road.first, road.height)
    checked(*recorded.profile, name)
    return recorded
