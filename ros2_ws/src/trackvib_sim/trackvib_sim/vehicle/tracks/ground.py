"""Shoes on the ground: penalty springs along the road's normal, and shear of the soil with Coulomb's limit.

The pin line is the contact line: the road's profile is what the pins of a track follow. While a shoe lies on the ground its
shear is a spring and damper from the place where it came down; beyond friction the place slides along.
"""

from typing import NamedTuple

import numpy as np

from ...rui.compiled import kernel
from .nodes import GROUND, SHEAR, STRIDE


class Ground(NamedTuple):
    """Properties under one shoe."""

    stiffness: float  # N/m
    damping: float  # N s/m
    shear_stiffness: float  # N/m
    shear_damping: float  # N s/m
    friction: float


def ground(vehicle):
    """Return the record for the vehicle."""
    g = vehicle.ground
    return Ground(g.stiffness, g.damping, g.shear_stiffness, g.shear_damping, g.friction)


@kernel
def road_height(road, side, x):
    """Return the height of the road at distance x [m], between samples on a straight line."""
    place = x / road.spacing
    sample = np.floor(place)
    # the part between two samples must not depend on which stretch is held, to the last bit
    part = place - sample
    i = min(max(int(sample) - road.first, 0), road.height.shape[1] - 2)
    return (1.0 - part) * road.height[side, i] + part * road.height[side, i + 1]


@kernel
def add_ground(ground, nodes, heights, first, spacing, begin, end, work, dt):
    """Fill the ground's forces on the nodes `begin` ... `end - 1` of a track and advance their shear by dt.

    `heights` (m,) are the samples of the track's side from sample `first` on [m]. Returns the power turned into heat [W],
    the energy stored [J] and the number of shoes on the ground.
    """
    heat, stored, touching = 0.0, 0.0, 0.0
    last = len(heights) - 2
    for i in range(begin, end):
        place = nodes[i] / spacing
        sample = np.floor(place)
        k = int(sample) - first
        k = min(max(k, 0), last)
        low, rise = heights[k], heights[k + 1] - heights[k]
        slope = rise / spacing
        vx, vy, vz = nodes[3 * STRIDE + i], nodes[4 * STRIDE + i], nodes[5 * STRIDE + i]
        cosine = 1.0 / np.sqrt(1.0 + slope * slope)
        depth = (low + (place - sample) * rise - nodes[2 * STRIDE + i]) * cosine
        up, ahead = (vz - slope * vx) * cosine, (vx + slope * vz) * cosine
        on = 1.0 if depth > 0.0 else 0.0
        spring = on * ground.stiffness * depth
        normal = on * max(spring - ground.damping * up, 0.0)
        shear_x, shear_y = nodes[6 * STRIDE + i], nodes[7 * STRIDE + i]
        before = shear_x * shear_x + shear_y * shear_y
        pull_x = ground.shear_stiffness * (shear_x + dt * ahead) + ground.shear_damping * ahead
        pull_y = ground.shear_stiffness * (shear_y + dt * vy) + ground.shear_damping * vy
        limit, size = ground.friction * normal, np.sqrt(pull_x * pull_x + pull_y * pull_y)
        cut = limit / max(size, 1e-300) if size > limit else 1.0
        pull_x, pull_y = cut * pull_x, cut * pull_y
        shear_x = on * (pull_x - ground.shear_damping * ahead) / ground.shear_stiffness
        shear_y = on * (pull_y - ground.shear_damping * vy) / ground.shear_stiffness
        nodes[6 * STRIDE + i] = shear_x
        nodes[7 * STRIDE + i] = shear_y
        work[9 * STRIDE + i] = -cosine * (slope * normal + pull_x)
        work[10 * STRIDE + i] = -pull_y
        work[11 * STRIDE + i] = cosine * (normal - slope * pull_x)
        after = shear_x * shear_x + shear_y * shear_y
        heat += up * (spring - normal) + pull_x * ahead + pull_y * vy
        heat -= 0.5 * ground.shear_stiffness * (after - before) / dt
        stored += 0.5 * (spring * depth + ground.shear_stiffness * after)
        touching += on
    return heat, stored, touching
