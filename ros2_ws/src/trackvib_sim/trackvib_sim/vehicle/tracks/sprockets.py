"""Sprockets: tooth by tooth contact of the pins.

A pin between two teeth rests on the seat, at the pitch circle, and is driven by a flank. Flanks are straight and open
outwards by the flank angle and end in a tip with round corners; between pin and flank there is backlash. Or seat and
flanks are one concave arc. A pin that comes in on the taut track must pass the corner, and with a sprocket pitch other
than the track's the load jumps from tooth to tooth. That, at the link-passing frequency v/p, is the strongest
excitation of the vehicle. What touches need not be the pin: shoes may have cylinders for it at other places. Every
force but damping and friction is the gradient of a potential without jumps, so that teeth make no energy.
"""

from math import pi, radians, sin
from typing import NamedTuple

import numpy as np

from ...numerics.angles import sine_cosine, vector_angle
from ...numerics.compiled import inlined, kernel
from ..body_tree import SIDES, drive_end, sprocket_name
from .guides import hold
from .nodes import STRIDE, NodeWorkOffset
from .rims import CREEP, WheelLoadOffset, add_reaction


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
    arc_centre: float  # m from the hub to the centre of a concave seat; 0 where seat and flanks are straight
    arc_radius: float  # of a concave seat as the pins' centres see it, m
    contact: np.ndarray  # (c,) where links touch, parts of their length from the pin behind on
    friction: float
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
        arc_centre=s.arc_centre or 0.0,
        arc_radius=s.arc_radius or 0.0,
        contact=0.5 + np.array(s.contacts) / vehicle.tracks.pitch if s.contacts else np.zeros(1),
        friction=s.friction or 0.0,
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
    i = outermost - sprockets.teeth // 2 - 1
    i = i + n if i < 1 else i
    for _ in range(sprockets.teeth + 3):
        j = i + 1 if i < n else 1
        for k in range(sprockets.contact.size):
            _touch(sprockets, hub, angle, sprockets.contact[k], i, j, work, load)
        i = j


@inlined
def _touch(sprockets, hub, angle, share, i, j, work, load):
    """Add the force on a point of the link from node i to node j, at a part `share` of its length."""
    s = sprockets
    dx, dz = _between(work, i, share) - hub.x, _between(work, 2 * STRIDE + i, share) - hub.z
    square = dx * dx + dz * dz
    if square >= s.tip_radius * s.tip_radius:
        return
    distance = np.sqrt(square)
    rx, rz = dx / distance, dz / distance  # outwards; (rz, -rx) is the way a sprocket turns
    # off: angle from the middle between the two teeth, as rotation about +y
    gap = 2.0 * np.pi / s.teeth
    off = vector_angle(dx, -dz) - angle
    off -= gap * np.floor(off / gap + 0.5)
    turn = 1.0 if off > 0.0 else -1.0
    vx, vz = _between(work, 3 * STRIDE + i, share) - hub.vx, _between(work, 5 * STRIDE + i, share) - hub.vz
    outwards = vx * rx + vz * rz
    along = vx * rz - vz * rx - hub.spin * distance
    if s.arc_centre > 0.0:
        depth, across, outward = _in_arc(s, abs(off), distance)
        radial, tangential = _push(s, depth, turn * across, outward, along, outwards, load)
    else:
        radial, tangential = _push(s, s.pitch_radius - distance, 0.0, -1.0, along, outwards, load)
        depth, across, outward = _in_tooth(s, abs(off) * distance, distance)
        # the way along the circumference grows with distance as well
        flank = _push(s, depth, turn * across, outward + abs(off) * across, along, outwards, load)
        radial, tangential = radial + flank[0], tangential + flank[1]
    # guides reach as far as the teeth, and hold wholly at the pitch circle
    sideways = _between(work, STRIDE + i, share) - hub.y
    vy = _between(work, 4 * STRIDE + i, share) - hub.vy - hub.yaw * dx + hub.roll * dz
    height = s.tip_radius - s.pitch_radius
    more, guide, heat, stored = hold(
        s.guide_stiffness, s.guide_damping, height, s.pitch_radius - distance, sideways, vy
    )
    radial += more
    load[WheelLoadOffset.DISSIPATION] += heat
    load[WheelLoadOffset.STORED] += stored
    force = (radial * rx + tangential * rz, guide, radial * rz - tangential * rx)
    for axis in range(3):
        work[(NodeWorkOffset.CONTACT + axis) * STRIDE + i] += (1.0 - share) * force[axis]
        work[(NodeWorkOffset.CONTACT + axis) * STRIDE + j] += share * force[axis]
    add_reaction(load, (dx, sideways, dz), force)


@inlined
def _between(work, cell, share):
    """Return a quantity at a part `share` of a link's length, from that of the node behind it in a cell on."""
    return work[cell] if share == 0.0 else (1.0 - share) * work[cell] + share * work[cell + 1]


@inlined
def _push(s, depth, across, outward, along, outwards, load):
    """Return what a tooth does to a point in it, outwards and along the circumference [N].

    `across` and `outward` are the depth's gradient along the circumference and outwards, `along` and `outwards` the
    speeds against the tooth [m/s].
    """
    if depth <= 0.0:
        return 0.0, 0.0
    closing = across * along + outward * outwards
    push = max(0.0, s.stiffness * depth + s.damping * closing)
    load[WheelLoadOffset.DISSIPATION] += closing * (push - s.stiffness * depth)
    load[WheelLoadOffset.STORED] += 0.5 * s.stiffness * depth * depth
    if s.friction == 0.0:
        return -outward * push, -across * push
    steep = np.sqrt(across * across + outward * outward)  # 1, but for what is left out of a straight flank's gradient
    slip = (outward * along - across * outwards) / steep
    drag = s.friction * push * slip / np.sqrt(slip * slip + CREEP * CREEP)
    load[WheelLoadOffset.DISSIPATION] += drag * steep * slip
    return -outward * push + across * drag, -across * push - outward * drag


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


@inlined
def _in_arc(s, off, distance):
    """Return what `_in_tooth` does for a concave seat, `off` [rad] from the middle of the gap."""
    to_tip, (sine, cosine) = s.tip_radius - distance, sine_cosine(off)
    x, y = distance * cosine - s.arc_centre, distance * sine  # from the arc's centre, outwards and across
    reach = np.sqrt(x * x + y * y)
    flank = reach - s.arc_radius
    if flank <= 0.0:
        return 0.0, 0.0, 0.0
    across, outward = (y * cosine - x * sine) / reach, (x * cosine + y * sine) / reach
    on_flank, on_tip = max(s.corner - flank, 0.0), max(s.corner - to_tip, 0.0)
    if on_tip == 0.0 and flank <= to_tip:
        return flank, across, outward
    if on_flank == 0.0:
        return to_tip, 0.0, -1.0
    round_about = np.sqrt(on_flank * on_flank + on_tip * on_tip)
    return (
        s.corner - round_about,
        on_flank * across / round_about,
        (on_flank * outward - on_tip) / round_about,
    )
