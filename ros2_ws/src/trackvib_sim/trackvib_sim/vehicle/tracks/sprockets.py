"""Sprockets: tooth by tooth contact of the pins.

A pin between two teeth rests on the seat, at the pitch circle, and is driven by a flank. Flanks are straight and open
outwards by the flank angle and end in a tip with round corners; between pin and flank there is backlash. A pin that
comes in on the taut track must pass the corner, and with a sprocket pitch other than the track's the load jumps from
tooth to tooth. That, at the link-passing frequency v/p, is the strongest excitation of the vehicle. Every force but
damping is the gradient of a potential without jumps, so that teeth make no energy.
"""

from math import pi, radians, sin
from typing import NamedTuple

import numpy as np

from ...numerics.compiled import inlined, kernel
from ..body_tree import SIDES, drive_end, sprocket_name
from .nodes import STRIDE, NodeWorkOffset
from .wheels import WheelLoadOffset, add_reaction


class Sprockets(NamedTuple):
    """Both sprockets."""

    row: np.ndarray  # (2,) in the tree
    end: float  # of the vehicle where they are, sign of x
    teeth: int
    pitch_radius: float  # m
    slope: float  # of the flank, tan
    cosine: float  # of the flank angle
    sine: float
    backlash: float  # m from a pin in the middle to the flank, at the pitch circle
    tip_radius: float  # m
    corner: float  # radius of the tip's corner as the pins' centres see it, m
    stiffness: float  # N/m
    damping: float  # N s/m
    guide_stiffness: float  # N/m
    guide_damping: float  # N s/m


def pitch_radius(vehicle):
    """Return the radius of the circle on which pins rest [m]."""
    s = vehicle.sprocket_teeth
    return vehicle.tracks.pitch * (1.0 + s.pitch_excess) / (2.0 * sin(pi / s.teeth))


def build_sprockets(vehicle, rows):
    """Return the record for the vehicle."""
    s, angle = vehicle.sprocket_teeth, radians(vehicle.sprocket_teeth.flank_angle)
    return Sprockets(
        row=np.array([rows[sprocket_name(side)] for side in SIDES]),
        end=drive_end(vehicle),
        teeth=int(s.teeth),
        pitch_radius=pitch_radius(vehicle),
        slope=np.tan(angle),
        cosine=np.cos(angle),
        sine=np.sin(angle),
        backlash=s.backlash,
        tip_radius=pitch_radius(vehicle) + s.height,
        corner=s.corner_radius,
        stiffness=s.stiffness,
        damping=s.damping,
        guide_stiffness=s.guide_stiffness,
        guide_damping=s.guide_damping,
    )


@kernel
def add_sprocket(sprockets, hub, angle, outermost, n, work, load):
    """Add the teeth's forces to the pins around the outermost node, and their reactions to `load` (wheels.LOAD,).

    `angle` [rad] is that of the sprocket in the hull.
    """
    s = sprockets
    share = 2.0 * np.pi / s.teeth
    i = outermost - s.teeth // 2 - 1
    i = i + n if i < 1 else i
    for _ in range(s.teeth + 3):
        dx, dz = work[i] - hub.x, work[2 * STRIDE + i] - hub.z
        square = dx * dx + dz * dz
        if square < s.tip_radius * s.tip_radius:
            distance = np.sqrt(square)
            rx, rz = dx / distance, dz / distance  # outwards; (rz, -rx) is the way a sprocket turns
            # off: angle from the middle between the two teeth, as rotation about +y
            off = np.arctan2(-dz, dx) - angle
            off -= share * np.floor(off / share + 0.5)
            turn = 1.0 if off > 0.0 else -1.0
            vx, vz = work[3 * STRIDE + i] - hub.vx, work[5 * STRIDE + i] - hub.vz
            outwards = vx * rx + vz * rz
            along = vx * rz - vz * rx - hub.spin * distance
            radial, tangential = 0.0, 0.0
            seat = s.pitch_radius - distance
            if seat > 0.0:
                radial = max(0.0, s.stiffness * seat - s.damping * outwards)
                load[WheelLoadOffset.DISSIPATION] += outwards * (s.stiffness * seat - radial)
                load[WheelLoadOffset.STORED] += 0.5 * s.stiffness * seat * seat
            depth, across, outward = _in_tooth(s, abs(off) * distance, distance)
            if depth > 0.0:
                # the way along the circumference grows with distance as well
                across, outward = turn * across, outward + abs(off) * across
                closing = across * along + outward * outwards
                push = max(0.0, s.stiffness * depth + s.damping * closing)
                tangential = -across * push
                radial -= outward * push
                load[WheelLoadOffset.DISSIPATION] += closing * (push - s.stiffness * depth)
                load[WheelLoadOffset.STORED] += 0.5 * s.stiffness * depth * depth
            if radial != 0.0 or tangential != 0.0:
                sideways = work[STRIDE + i] - hub.y
                vy = work[4 * STRIDE + i] - hub.vy - hub.yaw * dx + hub.roll * dz
                guide = s.guide_stiffness * sideways + s.guide_damping * vy
                load[WheelLoadOffset.DISSIPATION] += s.guide_damping * vy * vy
                load[WheelLoadOffset.STORED] += 0.5 * s.guide_stiffness * sideways * sideways
                force = (radial * rx + tangential * rz, -guide, radial * rz - tangential * rx)
                for axis in range(3):
                    work[(NodeWorkOffset.CONTACT + axis) * STRIDE + i] += force[axis]
                add_reaction(load, (dx, sideways, dz), force)
        i = i + 1 if i < n else 1


@inlined
def _in_tooth(s, way, distance):
    """Return how deep a pin is in a tooth [m], and the depth's gradient along the circumference and outwards.

    `way` [m] is that along the circumference from the middle of the gap. Flank and tip of the tooth are straight; their
    corner is round: beyond both lines of its centre the depth is that in a circle.
    """
    above = distance - s.pitch_radius
    flank = (way - s.backlash - s.slope * max(above, 0.0)) * s.cosine
    if flank <= 0.0:
        return 0.0, 0.0, 0.0
    to_flank, to_tip = s.corner - flank, s.corner - (s.tip_radius - distance)  # from the corner's centre
    # the way from that centre to the pin, in parts along the normals of flank and tip
    on_flank = (to_flank - s.sine * to_tip) / (s.cosine * s.cosine)
    on_tip = (to_tip - s.sine * to_flank) / (s.cosine * s.cosine)
    # deeper than the corner's centre from both lines, the nearer one is the way out
    core = to_flank <= 0.0 and to_tip <= 0.0
    if on_tip <= 0.0 and not (core and to_tip > to_flank):
        return flank, s.cosine, -s.sine if above > 0.0 else 0.0
    if on_flank <= 0.0 or core:
        return s.tip_radius - distance, 0.0, -1.0
    from_centre = np.sqrt(on_flank * to_flank + on_tip * to_tip)
    outward = -(s.sine * on_flank + on_tip) / from_centre
    return s.corner - from_centre, s.cosine * on_flank / from_centre, outward
