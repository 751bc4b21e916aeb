"""The sprocket's teeth as the contact with the pins has them, and how a pin comes in."""

import numpy as np

from ..analysis.sensor_style import COLOURS
from ..scene.teeth import half_gap
from ..vehicle.body_tree import LEFT, sprocket_name
from .technical_drawing import INK, MARKS, PARTS, SHADE, disc, drawing

MM = 1e3
WINDOW = 105.0  # mm to either side of the middle
WAY_IN = {"color": COLOURS["powertrain"], "linestyle": "--", "zorder": MARKS}


def tooth_profile(sprockets, angle):
    """Return the outline (m, 2) of a sprocket from its hub as the centres of the pins feel it, x forward, z up [m].

    `sprockets` is the record of `vehicle.tracks.sprockets`, `angle` that of the sprocket about +y. Between two teeth
    the gap opens from the pitch circle, where a pin rests, along both flanks and their round corners to the tips.
    """
    radius, gap = half_gap(sprockets)
    radius, off = np.concatenate((radius[::-1], radius)), np.concatenate((-gap[::-1], gap))
    middle = angle + 2.0 * np.pi / sprockets.teeth * np.arange(sprockets.teeth)
    return _places(radius, middle[:, None] + off).reshape(-1, 2)


def free_entry(sprockets):
    """Return radii (m,) [m] and angles (m,) [rad] of a pin that comes in on the taut run, from the gap it will rest in.

    Seen from the sprocket the way in is the involute of the pitch circle: at the radius r = R/cos(t) the pin is
    tan(t) - t ahead of the middle of its gap.
    """
    radius, _ = half_gap(sprockets)
    t = np.arccos(sprockets.pitch_radius / radius)
    return radius, np.tan(t) - t


def _places(radius, angle):
    """Places of polar coordinates whose angle counts about +y."""
    return np.stack((radius * np.cos(angle), -radius * np.sin(angle)), axis=-1)


def sprocket_entry(plot, assembled, labels):
    """Draw where pins enter the left sprocket of an `AssembledVehicle` that drives forwards."""
    drawing(plot, "Pins entering the sprocket, tooth outline for pin centres, mm")
    s, hub = assembled.sprockets, assembled.hub[sprocket_name(LEFT)]
    pins = (assembled.pins[LEFT] - hub)[:, [0, 2]]
    distance, share = np.hypot(*pins.T), 2.0 * np.pi / s.teeth
    entering = np.flatnonzero(distance < s.tip_radius)[-1]  # between the teeth, the next one is not yet
    angle = np.arctan2(-pins[entering, 1], pins[entering, 0])
    gap = assembled.sprocket_angle + share * np.round((angle - assembled.sprocket_angle) / share)

    plot.fill(*(MM * tooth_profile(s, assembled.sprocket_angle)).T, facecolor=SHADE, edgecolor=INK, zorder=PARTS)
    disc(plot, (0.0, 0.0), MM * s.pitch_radius, facecolor="none", edgecolor=INK, linewidth=0.7, linestyle="-.")
    radius, ahead = free_entry(s)
    for k in (-1, 0, 1):
        plot.plot(*(MM * _places(radius, gap + k * share + ahead)).T, **WAY_IN)
    plot.plot(*(MM * pins).T, "o-", color=INK, markersize=7, markerfacecolor="white", linewidth=2.0, zorder=MARKS)

    _, to_flank = half_gap(s)
    flank, seat = MM * _places(radius, gap - to_flank), MM * _places(s.pitch_radius, gap + 0.55 * share)
    way = MM * _places(radius, gap + ahead)
    x, z = MM * 0.5 * (pins[entering - 1] + pins[entering])
    labels.add(plot, f"flank, {np.degrees(np.arctan(s.slope)):.1f}° to the radius", flank[20])
    labels.add(plot, f"backlash {MM * s.backlash:.2g} to either side", flank[0])
    labels.add(plot, "path of a pin on the taut run", way[-1], WAY_IN["color"])
    labels.add(plot, f"pitch circle, R {MM * s.pitch_radius:.1f}", seat)
    plot.set_xlim(x - WINDOW, x + WINDOW)
    plot.set_ylim(z - 0.85 * WINDOW, z + 0.85 * WINDOW)
