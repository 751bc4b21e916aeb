"""The teeth of a sprocket as the contact with the pins has them."""

import numpy as np

_ALONG = np.linspace(0.0, 1.0, 33)  # of the tooth's height


def half_gap(sprockets):
    """Return radii (m,) [m] and angles (m,) [rad] of a flank and its round corner, from the middle of its gap.

    `sprockets` is the record of `vehicle.tracks.sprockets`.
    """
    s = sprockets
    radius = s.pitch_radius + _ALONG * (s.tip_radius - s.pitch_radius)
    to_tip = np.maximum(s.corner - (s.tip_radius - radius), s.sine * s.corner)  # from the corner's centre
    # on the circle of the corner, in the skew axes of the normals of tip and flank
    to_flank = s.sine * to_tip + s.cosine * np.sqrt(s.corner**2 - to_tip**2)
    way = s.backlash + s.slope * (radius - s.pitch_radius) + (s.corner - to_flank) / s.cosine
    return radius, way / radius


def tooth_outline(sprockets):
    """Return the outline (m, 2) of one tooth from the hub, its middle along the first axis [m]."""
    radius, gap = half_gap(sprockets)
    angle = np.pi / sprockets.teeth - gap
    there = np.maximum(angle, 0.0)  # a tooth that its gaps leave nothing of ends in a point
    upper = np.stack((radius * np.cos(there), radius * np.sin(there)), axis=-1)
    return np.concatenate((upper * (1.0, -1.0), upper[::-1]))
