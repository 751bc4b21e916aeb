"""Views of a vehicle from the rear and from above, and what all its views share."""

import numpy as np
from matplotlib.markers import CARETDOWN, CARETUP

from ..analysis.sensor_style import COLOURS
from ..scene.bodies import even_density_sides
from ..vehicle.body_tree import (
    HULL,
    POWERTRAIN,
    REAR,
    SIDES,
    arm_name,
    end_wheels,
    idler_name,
    sprocket_name,
    sprung_bodies,
    wheel_name,
)
from ..vehicle.parameters import CHASSIS
from ..vehicle.sensors import sensors_of
from .technical_drawing import (
    BACK,
    FAINT,
    INK,
    MARKS,
    axes_cross,
    bar,
    box,
    centre_of_mass,
    dimension,
    disc,
    drawing,
    extension,
    level_ground,
    spring,
)

# what becomes of x, y, z in a picture
FROM_LEFT = np.array([[1, 0, 0], [0, 0, 1]])
FROM_REAR = np.array([[0, -1, 0], [0, 0, 1]])
FROM_ABOVE = np.array([[1, 0, 0], [0, 1, 0]])
HINGE_AXIS = {"color": COLOURS["powertrain"], "linestyle": "-.", "linewidth": 1.6, "zorder": MARKS}
SHADES = ("#eef1f3", "#e3e8eb", "#d4dbe0", "#c6d0d6", "#b8c4cc")  # of hull, what stands on it, what stands on that ...
POWERTRAIN_SHADE = "#f9e8dd"
SENSOR_MARKS = {CHASSIS: CARETUP, POWERTRAIN: CARETDOWN}
KINDS = {"mr": "MR mount", "rubber": "rubber mount"}


def boxes(plot, assembled, view, names=None):
    """Draw bodies of whose shape no parameter tells: as boxes of even density with their mass and inertia.

    Returns the corners (2, 2) of each by name, the lower left one first.
    """
    corners = {}
    for name, solid in sprung_bodies(assembled.vehicle).items():
        if names is not None and name not in names:
            continue
        sides = np.abs(view) @ even_density_sides(solid)
        centre = view @ (assembled.hub[name] + solid.centre)
        edge = COLOURS["powertrain"] if name == POWERTRAIN else FAINT
        style = {"linestyle": "--", "facecolor": _shade(assembled.vehicle, name), "edgecolor": edge, "zorder": BACK}
        low, high = centre - 0.5 * sides, centre + 0.5 * sides
        if view[1, 2]:
            low[1] = max(low[1], 0.0)  # ground hides what a hollow body's box has below it
        box(plot, 0.5 * (low + high), high - low, **style)
        centre_of_mass(plot, centre)
        corners[name] = np.array([low, high])
    return corners


def sensors(plot, assembled, view):
    """Draw all sensors, and return their places (2,) and colours by name."""
    places = {}
    for sensor in sensors_of(assembled.vehicle):
        place = view @ (assembled.hub[sensor.body] + sensor.place)
        colour = COLOURS.get(sensor.name, INK)
        plot.plot(*place, marker=SENSOR_MARKS.get(sensor.name, "D"), markersize=9, color=colour, zorder=MARKS + 1)
        places[sensor.name] = place, colour
    return places


def mount_places(assembled, view, body=None):
    """Return the places (2,) of the mounts' upper ends by name, of all or of one body's."""
    mounts = assembled.vehicle.mounts.items()
    return {name: view @ (assembled.hub[m.body] + m.place) for name, m in mounts if body in (None, m.body)}


def mount_kind(vehicle, name):
    """Return what kind of mount one is, in words."""
    return KINDS[vehicle.mount_types[vehicle.mounts[name].type].kind]


def powertrain_hinge(plot, assembled, view):
    """Draw the powertrain's hinge: its axis, or the place of a bushing; returns the place (2,), None if there is none.

    An axis that is seen from its end is a circle.
    """
    powertrain, style = assembled.vehicle.powertrain, {"edgecolor": COLOURS["powertrain"], "linewidth": 1.6}
    if powertrain.hinge in ("free", "fixed"):
        return None
    place = view @ assembled.hub[POWERTRAIN]
    if powertrain.hinge == "elastic":
        box(plot, place, (0.09, 0.09), zorder=MARKS, **style)
        return place
    way = 0.9 * assembled.vehicle.swing_arms.pivot_y * (view @ powertrain.axis) / np.linalg.norm(powertrain.axis)
    if np.hypot(*way) < 0.1:
        disc(plot, place, 0.045, zorder=MARKS, **style)
    else:
        plot.plot(*np.stack((place - way, place + way), axis=1), **HINGE_AXIS)
    return place


def from_the_rear(plot, assembled):
    """Draw an `AssembledVehicle` from the rear."""
    drawing(plot, "From the rear, m")
    v, view = assembled.vehicle, FROM_REAR
    boxes(plot, assembled, view)
    outside, (name_at_end, at_end) = v.road_wheels.y + 0.6, end_wheels(v)[REAR]
    end_radius = assembled.sprockets.tip_radius if at_end is v.sprockets else at_end.radius
    level_ground(plot, -outside, outside)
    powertrain_hinge(plot, assembled, view)
    sensors(plot, assembled, view)
    for side in SIDES:
        wheel, pivot = (view @ assembled.hub[name(side, v.swing_arms.stations - 1)] for name in (wheel_name, arm_name))
        box(plot, wheel, (v.road_wheels.width, 2.0 * v.road_wheels.radius))
        bar(plot, wheel, pivot)
        box(plot, view @ assembled.hub[name_at_end(side)], (at_end.width, 2.0 * end_radius))
        for x, depth in ((wheel[0], -0.55), (pivot[0], -0.35)):
            extension(plot, (x, -0.2), (x, depth))
    for place in mount_places(assembled, view).values():
        spring(plot, place)
    dimension(plot, (-abs(pivot[0]), -0.33), (abs(pivot[0]), -0.33))
    dimension(plot, (-abs(wheel[0]), -0.53), (abs(wheel[0]), -0.53))
    axes_cross(plot, (outside - 0.25, plot.dataLim.y1 - 0.6), {"y": (-1, 0), "z": (0, 1)})
    plot.margins(0.02)


def from_above(plot, assembled, labels):
    """Draw the powertrain of an `AssembledVehicle` from above, with the running gear beside it."""
    drawing(plot, "Powertrain from above, m")
    v, view = assembled.vehicle, FROM_ABOVE
    boxes(plot, assembled, view, (HULL,))
    corners = boxes(plot, assembled, view, (POWERTRAIN,))[POWERTRAIN]
    hinge = powertrain_hinge(plot, assembled, view)
    sensors(plot, assembled, view)
    _running_gear_from_above(plot, assembled)
    mounts = mount_places(assembled, view, POWERTRAIN)
    for place in mounts.values():
        box(plot, place, (0.12, 0.12), zorder=MARKS)
    # the window holds the powertrain, its hinge and its mounts
    places = np.array([*corners, *mounts.values(), *([] if hinge is None else [hinge])])
    rear, front = places[:, 0].min() - 0.45, places[:, 0].max() + 0.45
    _dimensions_from_above(plot, corners, hinge, np.array(list(mounts.values())).reshape(-1, 2))
    axes_cross(plot, (rear + 0.1, v.road_wheels.y - 0.5), {"x": (1, 0), "y": (0, 1)})
    plot.set_xlim(rear, front)
    plot.set_ylim(-v.road_wheels.y - 0.3, v.road_wheels.y + 0.3)
    for name, place in mounts.items():
        labels.add(plot, f"{mount_kind(v, name)} {name.replace('_', ' ')}", place)
    if hinge is not None:
        labels.add(plot, f"hinge {assembled.number[POWERTRAIN]}", hinge + (0.0, 0.3), COLOURS["powertrain"])


def _running_gear_from_above(plot, assembled):
    v, view = assembled.vehicle, FROM_ABOVE
    for side in SIDES:
        sprocket, idler = view @ assembled.hub[sprocket_name(side)], view @ assembled.hub[idler_name(side)]
        box(plot, sprocket, (2.0 * assembled.sprockets.tip_radius, v.sprockets.width))
        box(plot, idler, (2.0 * v.idlers.radius, v.idlers.width))
        for station in range(v.swing_arms.stations):
            wheel, pivot = (view @ assembled.hub[name(side, station)] for name in (wheel_name, arm_name))
            box(plot, wheel, (2.0 * v.road_wheels.radius, v.road_wheels.width))
            bar(plot, wheel, pivot)


def _dimensions_from_above(plot, corners, hinge, mounts):
    """Where hinge, mounts and centre of mass are along x, from the rearmost of the first two; the mounts' span."""
    centre, ahead = corners.mean(axis=0), np.unique(mounts[:, 0].round(3))
    held = sorted({*ahead.tolist(), *([] if hinge is None else [hinge[0]])}) or [centre[0]]
    start = held[0]
    for k, x in enumerate(sorted({*held, centre[0]} - {start})):
        y = corners[0, 1] - 0.02 - 0.16 * k
        for end in (start, x):
            extension(plot, (end, min(0.0, centre[1])), (end, y))
        dimension(plot, (start, y), (x, y))
    if len(mounts) and np.ptp(mounts[:, 1]) > 0.1:
        low, high, x = mounts[:, 1].min(), mounts[:, 1].max(), ahead[-1] + 0.3
        for y in (low, high):
            extension(plot, (mounts[mounts[:, 1] == y][0, 0], y), (x + 0.02, y))
        dimension(plot, (x, low), (x, high))


def _shade(vehicle, name):
    if name == POWERTRAIN:
        return POWERTRAIN_SHADE
    depth, known = 0, sprung_bodies(vehicle)
    while name != HULL:
        name, depth = known[name].parent, depth + 1
    return SHADES[min(depth, len(SHADES) - 1)]
