"""Road wheels that roll on the road profile directly, without tracks.

A rubber tyre is a ring of radial springs and dampers (Winkler foundation): each reaches from the hub as far as the
free radius, and where the ground is nearer it pushes back along its own direction. A wheel so envelops roughness that
is short against its footprint, and has rolling resistance from the rubber's damping. Tangential forces are brushes
with a relaxation length, cut at the friction limit.
"""

from typing import NamedTuple

import numpy as np

from ...rui.compiled import kernel
from ...rui.cuts import apply_force
from ...rui.kinematics import HINGE_AXIS, ORIGIN, VELOCITY, motion_vector, point_velocity
from ...rui.spatial import add, cross, dot, scale
from ..body_tree import SIDES, STATIONS, wheel_name

FOOTPRINT = 0.22  # m, half length in which ground is looked for
SPRINGS = 17  # radial springs in the footprint


class WheelsOnRoad(NamedTuple):
    """The twelve wheels and the rubber that they share."""

    row: np.ndarray  # (12,) row of the wheel in the tree
    side: np.ndarray  # (12,) 0 left, 1 right
    radius: float  # m
    place: np.ndarray  # (SPRINGS,) of the springs along the footprint, m
    stiffness: float  # N/m of one radial spring
    damping: float  # N s/m of one radial spring
    static_depth: float  # m that the rubber gives under the static load
    longitudinal: tuple  # stiffness N/m, damping N s/m
    lateral: tuple
    relaxation: float  # m
    friction: float


class WheelsState(NamedTuple):
    """Deflection of the tangential brushes."""

    longitudinal: np.ndarray  # (12,) m
    lateral: np.ndarray  # (12,) m


def wheels_on_road(vehicle, rows, wheel_load):
    """Return the record for the vehicle; `wheel_load` [N] is the static load at which the rubber's rates hold."""
    t, radius = vehicle.tyres, vehicle.road_wheels.radius
    place = np.linspace(-FOOTPRINT, FOOTPRINT, SPRINGS)
    # A foundation k' [N/m^2] pressed in by d has the footprint 2 a = 2 sqrt(2 R d), load 4/3 k' a d, rate 2 k' a.
    depth = 1.5 * wheel_load / t.radial_stiffness
    springs_in_footprint = 2.0 * np.sqrt(2.0 * radius * depth) / (place[1] - place[0])
    return WheelsOnRoad(
        row=np.array([rows[wheel_name(side, station)] for side in SIDES for station in range(STATIONS)]),
        side=np.array([side for side in SIDES for _ in range(STATIONS)]),
        radius=radius,
        place=place,
        stiffness=t.radial_stiffness / springs_in_footprint,
        damping=t.radial_damping / springs_in_footprint,
        static_depth=depth,
        longitudinal=(t.longitudinal_stiffness, t.longitudinal_damping),
        lateral=(t.lateral_stiffness, t.lateral_damping),
        relaxation=t.relaxation_length,
        friction=t.friction,
    )


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
def radial_force(wheels, road, side, hub, velocity, forward):
    """Return the sum of the radial springs' forces on the hub [N] and the mean depth of those that push [m]."""
    total = (0.0, 0.0, 0.0)
    weight, depth = 0.0, 0.0
    for u in wheels.place:
        ground = road_height(road, side, hub[0] + forward[0] * u)
        clearance = hub[2] - ground
        reach = np.sqrt(u * u + clearance * clearance)
        if reach < wheels.radius and clearance > 0.0:
            towards_hub = scale(1.0 / reach, (-u * forward[0], -u * forward[1], clearance))
            push = wheels.stiffness * (wheels.radius - reach) - wheels.damping * dot(velocity, towards_hub)
            if push > 0.0:
                total = add(total, scale(push, towards_hub))
                weight += push
                depth += push * (wheels.radius - reach)
    return total, depth / weight if weight > 0.0 else 0.0


@kernel
def brush(deflection, slip, travel, properties, relaxation, dt):
    """Return force [N] and new deflection [m] of a brush: q' = slip - q travel / relaxation."""
    deflection = (deflection + dt * slip) / (1.0 + dt * travel / relaxation)
    return -properties[0] * deflection - properties[1] * slip, deflection


@kernel
def add_wheels_on_road(wheels, brushes, road, motion, cuts, dt):
    """Add the ground's forces to the wheels and advance the brushes by dt."""
    for i in range(wheels.row.size):
        b = wheels.row[i]
        hub, velocity = motion_vector(motion, ORIGIN, b), motion_vector(motion, VELOCITY, b)
        axle = motion_vector(motion, HINGE_AXIS, b)
        # rolling direction in the horizontal plane: axle x up
        norm = 1.0 / np.sqrt(axle[0] * axle[0] + axle[1] * axle[1])
        forward = (axle[1] * norm, -axle[0] * norm, 0.0)
        force, depth = radial_force(wheels, road, wheels.side[i], hub, velocity, forward)
        normal = np.sqrt(dot(force, force))
        if normal == 0.0:
            brushes.longitudinal[i] = brushes.lateral[i] = 0.0
            continue
        up = scale(1.0 / normal, force)
        sideways = (-forward[1], forward[0], 0.0)
        ahead = cross(sideways, up)
        contact = add(hub, scale(depth - wheels.radius, up))
        slip = point_velocity(motion, b, contact)
        rolling = abs(dot(velocity, ahead))
        f_x, q_x = brush(brushes.longitudinal[i], dot(slip, ahead), rolling, wheels.longitudinal, wheels.relaxation, dt)
        f_y, q_y = brush(brushes.lateral[i], dot(slip, sideways), rolling, wheels.lateral, wheels.relaxation, dt)
        tangential = np.sqrt(f_x * f_x + f_y * f_y)
        limit = wheels.friction * normal
        if tangential > limit:
            cut = limit / tangential
            f_x, f_y, q_x, q_y = cut * f_x, cut * f_y, cut * q_x, cut * q_y
        brushes.longitudinal[i], brushes.lateral[i] = q_x, q_y
        apply_force(cuts, motion, b, contact, add(force, add(scale(f_x, ahead), scale(f_y, sideways))))


@kernel
def wheel_below_road(wheels, road, motion):
    """Return whether the hub of any wheel lies below the road, where the rubber's springs know no way out."""
    for i in range(wheels.row.size):
        hub = motion_vector(motion, ORIGIN, wheels.row[i])
        if hub[2] < road_height(road, wheels.side[i], hub[0]):
            return True
    return False
