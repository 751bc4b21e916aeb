"""The road as two strips in space, left and right, along the path that the vehicle takes."""

from typing import NamedTuple

import numpy as np

from ..vehicle.drive.path import SAMPLES, SPACING
from .colours import of_height

BEYOND = 25.0  # m of road that are shown behind the first place and ahead of the last one
_GAP = 0.3  # m between the strips
_SHADED = 0.25  # m of height between the darkest colour and the lightest, at most


class Way(NamedTuple):
    """Where the path was, sample by sample; before and behind these it goes on straight."""

    distance: np.ndarray  # (k,) along the path, m
    place: np.ndarray  # (k, 2) x and y of the path, m
    heading: np.ndarray  # (k,) rad

    def at(self, distance):
        """Return places (m, 2) [m] and headings (m,) [rad] at distances (m,) [m]."""
        heading = np.interp(distance, self.distance, self.heading)
        place = np.stack([np.interp(distance, self.distance, each) for each in self.place.T], axis=-1)
        out = distance - np.clip(distance, self.distance[0], self.distance[-1])
        return place + out[:, None] * np.stack((np.cos(heading), np.sin(heading)), axis=-1), heading


class Strips(NamedTuple):
    """Corners of both strips, the left one first: of each its left edge, then its right one."""

    corners: np.ndarray  # (4, m, 3), m
    colours: np.ndarray  # (4, m, 3) uint8

    @property
    def triangles(self):
        """Numbers (t, 3) of corners, counted through all edges."""
        m = self.corners.shape[1]
        first = np.arange(m - 1)
        faces = []
        for edge in (0, 2):
            left, right = edge * m + first, (edge + 1) * m + first
            faces += [np.stack((right, right + 1, left), -1), np.stack((left, right + 1, left + 1), -1)]
        return np.concatenate(faces)


def way_of(distance, offset, place, heading):
    """Return the `Way` along which a hull drove at distances (k,), with offsets (k,) from it to the left [m].

    `place` (k, 2) is that of the hull [m], `heading` (k,) that of the path [rad].
    """
    distance, first = np.unique(distance, return_index=True)
    heading = heading[first]
    left = np.stack((-np.sin(heading), np.cos(heading)), axis=-1)
    return Way(distance, place[first] - offset[first, None] * left, heading)


def way_held(path):
    """Return the `Way` that a `vehicle.drive.path.Path` holds, to a little ahead of the vehicle."""
    number = int(path.newest[0]) + np.arange(1 - SAMPLES, 1)
    index = number & (SAMPLES - 1)
    return Way(SPACING * number, path.place[:, index].T, path.heading[index])


def road_strips(distance, heights, way, track_y):
    """Return the `Strips` of heights (2, m), left and right, at distances (m,) [m] along a `Way`.

    Each strip is centred on a track, `track_y` [m] from the vehicle's middle.
    """
    place, heading = way.at(distance)
    left = np.stack((-np.sin(heading), np.cos(heading)), axis=-1)
    outer, inner = 2.0 * track_y - 0.5 * _GAP, 0.5 * _GAP
    edges = [place + y * left for y in (outer, inner, -inner, -outer)]
    rows = [heights[0], heights[0], heights[1], heights[1]]
    corners = np.stack([np.column_stack((edge, z)) for edge, z in zip(edges, rows, strict=True)])
    spread = max(float(np.ptp(heights)), 1e-3)
    share = 0.5 + (corners[..., 2] - float(np.mean(heights))) / min(2.0 * spread, _SHADED)
    return Strips(corners, of_height(share))
