"""The body subsystem: hull, the bodies on it, running gear and powertrain, numbered by the rule of [Tao2025].

The hull is the root. Its superstructure has the first numbers, from the last body in the file to the hull, a hinge
between two bodies each; hinge and powertrain follow, then the hinges on the hull (sprocket, arms, rollers and idler,
left before right), the arms, the hinges of the road wheels, and the wheels (road wheels, sprocket, rollers, idler).
For the vehicle of [Tao2025], with turret, gun and recoil part, that gives the paper's own numbers.

Arms, wheels, rollers, sprockets and idlers turn about +y: rolling forward is positive, and so is the jounce of a
trailing arm; a leading arm turns about -y.
"""

from itertools import count
from math import cos, radians, sin

import numpy as np

from ..rui.table import Body, Hinge
from .parameters import HULL, POWERTRAIN

GRAVITY = 9.81  # m/s^2
LEFT, RIGHT = 0, 1
SIDES = {LEFT: 1.0, RIGHT: -1.0}  # sign of y
SIDE_NAMES = {LEFT: "left", RIGHT: "right"}
FRONT, REAR = 1.0, -1.0  # sign of x
_ROLLING = (0, 1, 0)
_KINDS = {"revolute": "revolute", "prismatic": "prismatic", "fixed": "locked", "elastic": "elastic", "free": "elastic"}


def build_body_table(vehicle):
    """Return the table of bodies (`rui.table.Body`), parents before children, for `rui.sweeps.tree.build_tree`."""
    v, above = vehicle, len(vehicle.bodies)
    hull = Body(2 * above + 1, HULL, v.hull.mass, v.hull.centre, inertia_matrix(v.hull))
    superstructure = [
        _body(2 * (above - k) - 1, 2 * (above - k), name, body) for k, (name, body) in enumerate(v.bodies.items())
    ]
    powertrain = _body(2 * above + 3, 2 * above + 2, POWERTRAIN, v.powertrain)
    # The hull's inputs in the paper's order: the left sprocket's brings the first one, the powertrain's the last.
    return [hull, *superstructure, *_running_gear(v, 2 * above + 4), powertrain]


def mass_of_bodies(vehicle):
    """Return the mass of all bodies [kg], summed in the order of the table, which need not be built for it."""
    v, stations = vehicle, vehicle.swing_arms.stations
    rollers = len(v.carrier_rollers.x) * [v.carrier_rollers.mass] if v.carrier_rollers else []
    wheels = [v.idlers.mass, *stations * [v.road_wheels.mass]]
    side = [v.sprockets.mass, *stations * [v.swing_arms.mass], *rollers, *wheels]
    return sum([v.hull.mass, *(body.mass for body in v.bodies.values()), *len(SIDES) * side, v.powertrain.mass])


def whole_mass(vehicle):
    """Return the mass of a vehicle with its tracks [kg]."""
    tracks = vehicle.tracks
    return mass_of_bodies(vehicle) + sum(tracks.links) * tracks.shoe_mass


def bodies_on_hinges(vehicle):
    """Return the sections of all bodies between hull and running gear by name, the powertrain's last."""
    return {**vehicle.bodies, POWERTRAIN: vehicle.powertrain}


def sprung_bodies(vehicle):
    """Return the sections of the bodies that the suspension carries by name: the hull, then `bodies_on_hinges`."""
    return {HULL: vehicle.hull, **bodies_on_hinges(vehicle)}


def inertia_matrix(solid):
    """Return the (3, 3) inertia matrix of a section with `inertia` and `products` [kg m^2]."""
    xy, xz, yz = solid.products
    return np.array([[0.0, xy, xz], [xy, 0.0, yz], [xz, yz, 0.0]]) + np.diag(solid.inertia)


def drive_end(vehicle):
    """Return `FRONT` or `REAR`: where the sprockets are; the idlers are at the other end."""
    return FRONT if vehicle.sprockets.x > vehicle.idlers.x else REAR


def arm_signs(arms):
    """Return 1.0 for each station with trailing arms, -1.0 for each with leading ones, (stations,)."""
    return np.broadcast_to([1.0 if word == "trailing" else -1.0 for word in arms.direction], arms.stations)


def wheel_name(side, station):
    """Return the name of a road wheel; station 0 is the front one."""
    return f"{SIDE_NAMES[side]}_wheel_{station + 1}"


def arm_name(side, station):
    """Return the name of a swing arm; station 0 is the front one."""
    return f"{SIDE_NAMES[side]}_arm_{station + 1}"


def roller_name(side, roller):
    """Return the name of a carrier roller; roller 0 is the front one."""
    return f"{SIDE_NAMES[side]}_roller_{roller + 1}"


def sprocket_name(side):
    """Return the name of a sprocket."""
    return f"{SIDE_NAMES[side]}_sprocket"


def idler_name(side):
    """Return the name of an idler."""
    return f"{SIDE_NAMES[side]}_idler"


def end_wheels(vehicle):
    """Return, by `FRONT` and `REAR`, what names the wheels at that end of the tracks, and their section."""
    end = drive_end(vehicle)
    return {end: (sprocket_name, vehicle.sprockets), -end: (idler_name, vehicle.idlers)}


def running_gear_kind(name):
    """Return "wheel", "arm", "roller", "sprocket" or "idler" for a body of the running gear, else ""."""
    side, _, rest = name.partition("_")
    return rest.partition("_")[0] if side in SIDE_NAMES.values() else ""


def _body(number, hinge_number, name, section):
    kind, item = section.hinge, {}
    if kind in ("revolute", "prismatic"):
        item = {"axis": tuple(section.axis)}
    elif kind == "elastic":
        item = {
            "stiffness": (*section.stiffness, *section.turning_stiffness),
            "damping": (*section.damping, *section.turning_damping),
        }
    hinge = Hinge(hinge_number, _KINDS[kind], section.parent, tuple(section.place), **item)
    return Body(number, name, section.mass, section.centre, inertia_matrix(section), hinge)


def _disc(section):
    """Inertia about the centre: as given, or that of a disc about the y axis."""
    if section.inertia is not None:
        return np.diag(section.inertia)
    across = section.mass * (3.0 * section.radius**2 + section.width**2) / 12.0
    return np.diag([across, 0.5 * section.mass * section.radius**2, across])


def _running_gear(v, first_hinge):
    """All bodies of both sides; numbers go through all sides kind by kind."""
    stations, rollers = v.swing_arms.stations, v.carrier_rollers
    roller_places = list(zip(rollers.x, rollers.z, strict=True)) if rollers else []
    on_hull = 2 + stations + len(roller_places)  # hinges a side; as many wheels
    first_arm = first_hinge + len(SIDES) * on_hull
    first_wheel = first_arm + 2 * len(SIDES) * stations
    hull_hinge, arm, wheel_hinge = count(first_hinge), count(first_arm), count(first_arm + len(SIDES) * stations)
    for side, sign in SIDES.items():
        road_wheel = first_wheel + side * on_hull
        wheel = count(road_wheel + stations)
        sprocket, idler = (v.sprockets.x, v.sprockets.z), (v.idlers.x, v.idlers.z)
        yield _wheel(next(wheel), next(hull_hinge), sprocket_name(side), v.sprockets, sprocket, sign)
        yield from _arms(v, side, arm, hull_hinge)
        for k, place in enumerate(roller_places):
            yield _wheel(next(wheel), next(hull_hinge), roller_name(side, k), rollers, place, sign)
        yield _wheel(next(wheel), next(hull_hinge), idler_name(side), v.idlers, idler, sign)
        yield from _road_wheels(v, side, road_wheel, wheel_hinge)


def _wheel(number, hinge, name, section, place, sign):
    x, z = place
    joint = Hinge(hinge, "revolute", HULL, (x, sign * section.y, z), _ROLLING)
    return Body(number, name, section.mass, (0, 0, 0), _disc(section), joint)


def _arms(v, side, number, hinge):
    arms, sign = v.swing_arms, SIDES[side]
    for station, (x, forward) in enumerate(zip(arms.places[side], arm_signs(arms), strict=True)):
        to_x, to_z = _arm_to_wheel(arms, forward)
        # the wheel's centre stands one loaded radius above ground; the arm's pivot follows from it
        place = (float(x - to_x), sign * arms.pivot_y, v.road_wheels.radius - to_z)
        joint = Hinge(next(hinge), "revolute", HULL, place, (0, int(forward), 0))
        mirror = (int(forward), sign, 1)
        centre = tuple(float(m) * c for m, c in zip(mirror, arms.centre, strict=True))
        inertia = inertia_matrix(arms) * np.outer(mirror, mirror)
        yield Body(next(number), arm_name(side, station), arms.mass, centre, inertia, joint)


def _road_wheels(v, side, number, hinge):
    arms, wheels = v.swing_arms, v.road_wheels
    outwards = SIDES[side] * (wheels.y - arms.pivot_y)
    for station, forward in enumerate(arm_signs(arms)):
        to_x, to_z = _arm_to_wheel(arms, forward)
        joint = Hinge(next(hinge), "revolute", arm_name(side, station), (to_x, outwards, to_z), _ROLLING)
        yield Body(number + station, wheel_name(side, station), wheels.mass, (0, 0, 0), _disc(wheels), joint)


def _arm_to_wheel(arms, forward):
    """Return the place of the wheel's centre in the arm, x and z components [m]."""
    angle = radians(arms.static_angle)
    return float(-forward * arms.length * cos(angle)), -arms.length * sin(angle)
