"""The recorded road where a vehicle went its way."""

import numpy as np
from mr_mount_controller.node_base.plain_text import readable

from ..road_sources.recorded import road_of_patches
from ..scene.road_strips import BEYOND, road_strips

_MOST_SAMPLES = 20_000


def strips_of(recording, vehicle, way):
    """Return the `Strips` of the road of a recording where a vehicle went its `Way`.

    Raises
    ------
    ProfileError
        The road cannot be put together.
    """
    road = road_of_patches(recording.road, readable(str(recording.path)))
    begin = max(way.distance[0] - BEYOND, road.spacing * road.first)
    end = min(way.distance[-1] + BEYOND, road.ends)
    first, last = int(np.floor(begin / road.spacing)), int(np.ceil(end / road.spacing))
    stride = 1 + (last - first) // _MOST_SAMPLES
    distance = road.spacing * np.arange(first, last + 1, stride)
    heights = road.heights(first, last + 1 - first)[:, ::stride]
    return road_strips(distance, heights, way, vehicle.road_wheels.y)
