"""Shoes on the ground: penalty springs along the road's normal, and shear of the soil with Coulomb's limit.

The pin line is the contact line: the road's profile is what the pins of a track follow. While a shoe lies on the
ground its shear is a spring and damper from the place where it came down; beyond friction the place slides along.
"""

from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ..drive.path import path_distance, path_point
from .nodes import STRIDE, NodeOffset, NodeWorkOffset

LEAST = 1e-9  # N, against division by zero where a shoe is not pulled at all


class Ground(NamedTuple):
    """Properties under one shoe."""

    stiffness: float  # N/m
    damping: float  # N s/m
    shear_stiffness: float  # N/m
    shear_damping: float  # N s/m
    friction: float


def build_ground(vehicle):
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
def find_on_path(path, nodes, begin, end, work):
    """Find where the nodes `begin` ... `end - 1` of a track are along the path, and its direction and length there."""
    along, tangent = NodeWorkOffset.ALONG * STRIDE, NodeWorkOffset.TANGENT * STRIDE
    if path.curved[0]:
        for i in range(begin, end):
            x, y = nodes[i], nodes[STRIDE + i]
            distance = path_distance(path, x, y, path.distance[0] + work[i])  # from the hull straight ahead
            px, py, tx, ty, curvature = path_point(path, distance)
            work[along + i] = distance
            work[tangent + i], work[tangent + STRIDE + i] = tx, ty
            stretch = 1.0 - curvature * (tx * (y - py) - ty * (x - px))
            work[NodeWorkOffset.CLOSENESS * STRIDE + i] = 1.0 / stretch
    else:
        for i in range(begin, end):
            work[along + i] = nodes[i]
            work[tangent + i], work[tangent + STRIDE + i] = 1.0, 0.0
            work[NodeWorkOffset.CLOSENESS * STRIDE + i] = 1.0


@inlined
def add_ground(ground, nodes, heights, first, spacing, begin, end, work, dt):
    """Fill the ground's forces on the nodes `begin` ... `end - 1` of a track and advance their shear by dt.

    `heights` (m,) are the samples of the track's side from sample `first` on [m]. Returns the power turned into heat
    [W], the energy stored [J] and the number of shoes on the ground. `find_on_path` comes first.
    """
    # from here on the first node is number 0, so that indices are seen to be positive and loops become vectors
    nodes, work, count = nodes[begin:], work[begin:], end - begin
    per_metre = 1.0 / spacing  # a product takes a tenth of a quotient's time
    for i in range(count):
        place = work[NodeWorkOffset.ALONG * STRIDE + i] * per_metre
        sample = np.floor(place)
        work[NodeWorkOffset.SAMPLE * STRIDE + i] = sample
        work[NodeWorkOffset.PART * STRIDE + i] = place - sample
    last = len(heights) - 2
    for i in range(count):
        k = min(max(int(work[NodeWorkOffset.SAMPLE * STRIDE + i]) - first, 0), last)
        work[NodeWorkOffset.LOW * STRIDE + i] = heights[k]
        work[NodeWorkOffset.RISE * STRIDE + i] = heights[k + 1] - heights[k]
    dissipation, stored, released, touching = 0.0, 0.0, 0.0, 0.0
    k_n, c_n, k_s, c_s, mu = (
        ground.stiffness,
        ground.damping,
        ground.shear_stiffness,
        ground.shear_damping,
        ground.friction,
    )
    # the soil's spring and damper yield by what friction lets through; a ground without springs keeps no shear
    give = dt / (k_s * dt + c_s) if k_s > 0.0 else 0.0  # m/N
    keep = c_s / (k_s * dt + c_s) if k_s > 0.0 else 0.0
    for i in range(count):
        low, rise = work[NodeWorkOffset.LOW * STRIDE + i], work[NodeWorkOffset.RISE * STRIDE + i]
        slope = rise * per_metre * work[NodeWorkOffset.CLOSENESS * STRIDE + i]
        cosine = 1.0 / np.sqrt(1.0 + slope * slope)
        sine = slope * cosine
        depth = (low + work[NodeWorkOffset.PART * STRIDE + i] * rise - nodes[2 * STRIDE + i]) * cosine
        tx, ty = work[NodeWorkOffset.TANGENT * STRIDE + i], work[(NodeWorkOffset.TANGENT + 1) * STRIDE + i]
        wx, wy = nodes[NodeOffset.VELOCITY * STRIDE + i], nodes[(NodeOffset.VELOCITY + 1) * STRIDE + i]
        vx, vy = tx * wx + ty * wy, tx * wy - ty * wx
        vz = nodes[(NodeOffset.VELOCITY + 2) * STRIDE + i]
        up, ahead = cosine * vz - sine * vx, cosine * vx + sine * vz
        on = 1.0 if depth > 0.0 else 0.0
        spring = on * k_n * depth
        normal = on * max(spring - c_n * up, 0.0)
        shear_x, shear_y = nodes[NodeOffset.SHEAR * STRIDE + i], nodes[(NodeOffset.SHEAR + 1) * STRIDE + i]
        before = shear_x * shear_x + shear_y * shear_y
        pull_x = k_s * (shear_x + dt * ahead) + c_s * ahead
        pull_y = k_s * (shear_y + dt * vy) + c_s * vy
        cut = min(mu * normal / (np.sqrt(pull_x * pull_x + pull_y * pull_y) + LEAST), 1.0)
        pull_x, pull_y = cut * pull_x, cut * pull_y
        shear_x = on * (give * pull_x + keep * shear_x)
        shear_y = on * (give * pull_y + keep * shear_y)
        nodes[NodeOffset.SHEAR * STRIDE + i] = shear_x
        nodes[(NodeOffset.SHEAR + 1) * STRIDE + i] = shear_y
        push = -sine * normal - cosine * pull_x
        work[NodeWorkOffset.GROUND * STRIDE + i] = tx * push + ty * pull_y
        work[(NodeWorkOffset.GROUND + 1) * STRIDE + i] = ty * push - tx * pull_y
        work[(NodeWorkOffset.GROUND + 2) * STRIDE + i] = cosine * normal - sine * pull_x
        after = shear_x * shear_x + shear_y * shear_y
        dissipation += up * (spring - normal) + pull_x * ahead + pull_y * vy
        stored += 0.5 * (spring * depth + k_s * after)
        released += before - after
        touching += on
    return dissipation + 0.5 * k_s * released / dt, stored, touching
