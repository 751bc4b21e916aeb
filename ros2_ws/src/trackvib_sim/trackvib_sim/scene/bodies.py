"""What every body of a vehicle looks like, from its parameters, as the drawing of the vehicle has it.

Of hull, powertrain and what else the suspension carries no parameter tells the shape: they are boxes of even density
with the body's mass and inertia. Wheels have the radius of the pin line.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from ..rui.reference.placement import place_bodies
from ..rui.sweeps.tree import to_table
from ..vehicle.body_tree import HULL, POWERTRAIN, build_body_table, running_gear_kind, sprung_bodies
from ..vehicle.running_gear_parameters import at_stations
from ..vehicle.system import new_state
from .colours import DAMPED, DISC, INK, PIN, POWERTRAIN_SHADE, SHADES, SHOE, TYRE
from .shapes import Box, Cylinder, Part, Prism
from .teeth import tooth_outline

PIVOT, HUB = 0.035, 0.05  # radii of a swing arm's ends, m
_ARM = 0.07  # thickness of a swing arm, m
_DISC = 0.8  # of a wheel's radius, within its tyre
_SPOKES = 5  # that show how a wheel turns
_SHOE = 0.03  # thickness of a shoe, m
_PROUD = 0.01  # m by which each ring of a wheel stands out beyond the one around it


def even_density_sides(solid):
    """Return the sides (3,) [m] of the box of even density with a section's mass and inertia.

    The small products of inertia are left out.
    """
    inertia = np.array(solid.inertia)
    # I_x = m (l_y^2 + l_z^2) / 12, solved for the sides
    return np.sqrt(np.maximum(6.0 * (inertia.sum() - 2.0 * inertia) / solid.mass, 0.0))


def body_parts(vehicle, system):
    """Return the `Part`s of every body of a vehicle by name, given a `System` of it."""
    table = build_body_table(vehicle)
    parts = _sprung(vehicle, dict(zip((body.name for body in table), _rest_heights(table, system), strict=True)))
    place = {body.name: np.array(body.hinge.place) for body in table if body.hinge is not None}
    sections = {"wheel": vehicle.road_wheels, "roller": vehicle.carrier_rollers, "idler": vehicle.idlers}
    for name in place:
        kind = running_gear_kind(name)
        if kind == "arm":
            side, _, station = name.partition("_arm_")
            damping = at_stations(vehicle.shock_absorbers.damping, vehicle.swing_arms.stations)[int(station) - 1]
            parts[name] = _arm(place[f"{side}_wheel_{station}"], DAMPED if damping > 0.0 else INK)
        elif kind == "sprocket":
            parts[name] = _sprocket(system.tracks.sprockets, vehicle.sprockets.width)
        elif kind:
            parts[name] = _wheel(sections[kind].radius, sections[kind].width)
    return {body.name: parts[body.name] for body in table}


def _rest_heights(table, system):
    """Heights of the bodies' origins above the road with every coordinate at zero [m]."""
    return place_bodies(table, to_table(system.tree, new_state(system).tree)).origin[:, 2]


def _sprung(vehicle, height):
    known, parts = sprung_bodies(vehicle), {}
    for name, solid in known.items():
        centre, half = np.array(solid.centre, dtype=float), 0.5 * even_density_sides(solid)
        low, high = centre - half, centre + half
        low[2] = max(low[2], min(-height[name], high[2]))  # what a hollow body's box has below the road
        shape = Box(tuple((high - low).tolist()))
        parts[name] = [Part(shape, tuple((0.5 * (low + high)).tolist()), _shade(known, name), see_through=True)]
    return parts


def _shade(known, name):
    """Darker the more bodies lie between one and the hull."""
    if name == POWERTRAIN:
        return POWERTRAIN_SHADE
    depth = 0
    while name != HULL:
        name, depth = known[name].parent, depth + 1
    return SHADES[min(depth, len(SHADES) - 1)]


def _arm(wheel, colour):
    """From the pivot along x and z in its plane, then outwards on the axle to the wheel's centre (3,)."""
    length, direction = np.hypot(wheel[0], wheel[2]), np.arctan2(-wheel[2], wheel[0])
    turn = Rotation.from_rotvec((0.0, direction, 0.0)).as_matrix()
    along = Part(Box((float(length), _ARM, _ARM)), (0.5 * wheel[0], 0.0, 0.5 * wheel[2]), colour, turn)
    pivot = Part(Cylinder(PIVOT, 3.0 * _ARM), (0.0, 0.0, 0.0), colour)
    axle = Part(Cylinder(PIVOT, float(abs(wheel[1]))), (wheel[0], 0.5 * wheel[1], wheel[2]), colour)
    return [along, pivot, axle]


def _wheel(radius, width):
    here = (0.0, 0.0, 0.0)
    tyre = Part(Cylinder(radius, width), here, TYRE)
    disc = Part(Cylinder(_DISC * radius, width + 2.0 * _PROUD), here, DISC)
    return [tyre, disc, *_spokes(_DISC * radius, width + 4.0 * _PROUD)]


def _sprocket(sprockets, width):
    disc = Part(Cylinder(sprockets.pitch_radius, width), (0.0, 0.0, 0.0), DISC)
    outline = tooth_outline(sprockets)
    base = np.array([outline[:, 0].min(), 0.0])  # the tooth's own origin on the pitch circle
    teeth = []
    for k in range(sprockets.teeth):
        turn = Rotation.from_rotvec((0.0, 2.0 * np.pi * (k + 0.5) / sprockets.teeth, 0.0)).as_matrix()
        teeth.append(Part(Prism(outline - base, width), tuple(turn[:, 0] * base[0]), DISC, turn))
    return [disc, *teeth, *_spokes(0.8 * sprockets.pitch_radius, width + 2.0 * _PROUD)]


def _spokes(radius, width):
    """Bars from the hub outwards, and the hub."""
    yield Part(Cylinder(min(HUB, 0.5 * radius), width + _PROUD), (0.0, 0.0, 0.0), INK)
    for k in range(_SPOKES):
        turn = Rotation.from_rotvec((0.0, 2.0 * np.pi * k / _SPOKES, 0.0)).as_matrix()
        yield Part(Box((0.95 * radius, width, 0.12 * radius)), tuple(0.475 * radius * turn[:, 0]), TYRE, turn)


def shoe_parts(vehicle):
    """Return the `Part`s of a track's link, from its middle: x to the next pin, y to the left.

    Shoes are as wide as the widest wheel: no parameter tells. Each has the pin behind it.
    """
    wheels = (vehicle.road_wheels, vehicle.sprockets, vehicle.idlers)
    pitch, width = vehicle.tracks.pitch, max(wheel.width for wheel in wheels) + 2.0 * _ARM
    plate = Part(Box((0.86 * pitch, width, _SHOE)), (0.0, 0.0, 0.0), SHOE)
    return [plate, Part(Cylinder(0.6 * _SHOE, 0.96 * width), (-0.5 * pitch, 0.0, 0.0), PIN)]
