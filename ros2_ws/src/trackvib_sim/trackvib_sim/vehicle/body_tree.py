"""The body subsystem of [Tao2025]: 41 bodies, 40 hinges, 46 degrees of freedom, numbered as in the paper.

The hull (7) is the root. Hinge axes: arms, wheels, rollers, sprockets, idlers and the powertrain turn about +y
(rolling forward, jounce and nose-down are positive), the turret about +z, the gun about -y (muzzle up is positive),
the recoil part slides along +x.
"""

from math import cos, radians, sin

import numpy as np

from ..rui.table import Body, Hinge

GRAVITY = 9.81  # m/s^2
LEFT, RIGHT = 0, 1
SIDES = {LEFT: 1.0, RIGHT: -1.0}  # sign of y
STATIONS = 6

# first numbers on the left and on the right side
SPROCKET = {LEFT: 64, RIGHT: 76}
ARM = {LEFT: 34, RIGHT: 40}
WHEEL = {LEFT: 58, RIGHT: 70}
ROLLER = {LEFT: 65, RIGHT: 77}
IDLER = {LEFT: 69, RIGHT: 81}
# hinges hull-sprocket; arms, rollers and idler follow in this order; then arm-wheel
HULL_HINGE = {LEFT: 10, RIGHT: 22}
WHEEL_HINGE = {LEFT: 46, RIGHT: 52}


def build_body_table(vehicle):
    """Return the table of bodies (`rui.table.Body`), parents before children, for `rui.tree.build_tree`."""
    v = vehicle
    table = [
        Body(7, "hull", v.hull.mass, v.hull.centre, inertia_matrix(v.hull)),
        _hinged(5, "turret", v.turret, Hinge(6, "revolute", "hull", v.turret.place, (0, 0, 1))),
        _hinged(3, "gun_mount", v.gun_mount, Hinge(4, "revolute", "turret", v.gun_mount.place, (0, -1, 0))),
        _hinged(1, "recoil_part", v.recoil_part, Hinge(2, "prismatic", "gun_mount", v.recoil_part.place, (1, 0, 0))),
    ]
    # The hull's inputs in the paper's order: hinge 10 brings the first one, hinge 8 the last.
    for side in SIDES:
        table += _side(v, side)
    hinge = Hinge(8, "revolute", "hull", v.powertrain.place, (0, 1, 0))
    return [*table, _hinged(9, "powertrain", v.powertrain, hinge)]


def inertia_matrix(solid):
    """Return the (3, 3) inertia matrix of a section with `inertia` and `products` [kg m^2]."""
    xy, xz, yz = solid.products
    return np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]]) + np.diag(solid.inertia)


def arm_to_wheel(arms):
    """Return the place of the wheel's centre in the arm, x and z components [m]."""
    angle = radians(arms.static_angle)
    return -arms.length * cos(angle), -arms.length * sin(angle)


def wheel_name(side, station):
    """Return the name of a road wheel; station 0 is the front one."""
    return f"wheel_{WHEEL[side] + station}"


def arm_name(side, station):
    """Return the name of a swing arm; station 0 is the front one."""
    return f"arm_{ARM[side] + station}"


def _hinged(number, name, solid, hinge):
    return Body(number, name, solid.mass, solid.centre, inertia_matrix(solid), hinge)


def _disc(section):
    """Inertia of a disc about the y axis."""
    across = section.mass * (3.0 * section.radius**2 + section.width**2) / 12.0
    return np.diag([across, 0.5 * section.mass * section.radius**2, across])


def _side(v, side):
    sign = SIDES[side]
    hinge = HULL_HINGE[side]
    arms = v.swing_arms
    to_x, to_z = arm_to_wheel(arms)
    outwards = v.road_wheels.y - arms.pivot_y
    # the wheel's centre stands one loaded radius above ground; the arm's pivot follows from it
    pivot_z = v.road_wheels.radius - to_z

    yield from _hull_wheels(v.sprockets, "sprocket", SPROCKET[side], hinge, sign)
    centre = (arms.centre[0], sign * arms.centre[1], arms.centre[2])
    inertia = inertia_matrix(arms) * np.outer((1, sign, 1), (1, sign, 1))
    for station, x in enumerate(arms.wheel_x):
        place = (x - to_x, sign * arms.pivot_y, pivot_z)
        joint = Hinge(hinge + 1 + station, "revolute", "hull", place, (0, 1, 0))
        yield Body(ARM[side] + station, arm_name(side, station), arms.mass, centre, inertia, joint)
    yield from _hull_wheels(v.carrier_rollers, "roller", ROLLER[side], hinge + 1 + STATIONS, sign)
    yield from _hull_wheels(v.idlers, "idler", IDLER[side], hinge + 1 + STATIONS + len(v.carrier_rollers.x), sign)
    for station in range(STATIONS):
        joint = Hinge(
            WHEEL_HINGE[side] + station,
            "revolute",
            arm_name(side, station),
            (to_x, sign * outwards, to_z),
            (0, 1, 0),
        )
        wheels = v.road_wheels
        yield Body(WHEEL[side] + station, wheel_name(side, station), wheels.mass, (0, 0, 0), _disc(wheels), joint)


def _hull_wheels(section, name, first, hinge, sign):
    for k, (x, z) in enumerate(zip(section.x, section.z, strict=True)):
        joint = Hinge(hinge + k, "revolute", "hull", (x, sign * section.y, z), (0, 1, 0))
        yield Body(first + k, f"{name}_{first + k}", section.mass, (0, 0, 0), _disc(section), joint)
