"""Cuts a road into patches and hands them out ahead of the vehicle."""

from typing import Protocol

import numpy as np

LENGTH = 5.0  # m of a patch, about
BEHIND = 20.0  # m of road behind the vehicle's origin, for the rear wheels
KEPT = 2  # patches by which a vehicle may go back without being fed anew


class HasHeights(Protocol):
    """A road: whatever gives the heights of its samples, sample i at distance i * `spacing` [m]."""

    spacing: float

    def heights(self, first: int, count: int) -> np.ndarray:
        """Return the heights (2, count) [m], left and right, of the samples `first` ... `first + count - 1`."""


class RoadFeeder:
    """Knows what has been handed out already; a vehicle that jumps back is fed anew from there."""

    def __init__(self, road: HasHeights, horizon: float):
        self._road = road
        self._horizon = horizon
        self._patch = max(round(LENGTH / road.spacing), 2)  # samples
        self._next = self._first = None  # numbers of patches

    def patches(self, distance):
        """Yield (start, spacing, heights (2, n)) of the patches still missing around a distance, all in m."""
        spacing, patch = self._road.spacing, self._patch
        behind = int((distance - BEHIND) // (patch * spacing))
        if self._next is None or behind < self._first or behind > self._next:
            self._first = self._next = behind
        while self._next * patch * spacing < distance + self._horizon:
            first = self._next * patch
            yield first * spacing, spacing, self._road.heights(first, patch)
            self._next += 1
        # whoever is fed keeps a stretch behind the vehicle, but not for ever
        self._first = max(self._first, behind - KEPT)
