"""Views of a vehicle from the rear and from above, and what all its views share."""

import numpy as np
from matplotlib.markers import CARETDOWN, CARETUP

from ..analysis.plots import COLOURS
from ..vehicle.body_tree import SIDES, SPROCKET, STATIONS, arm_name, wheel_name
from .technical_drawing import (
    BACK,
    FAINT,
    MARKS,
    axes_cross,
    bar,
    box,
    centre_of_mass,
    dimension,
    drawing,
    extension,
    level_ground,
    spring,
    text,
)

# what becomes of x, y, z in a picture
FROM_LEFT = np.array([[1, 0, 0], [0, 0, 1]])
FROM_REAR = np.array([[0, -1, 0], [0, 0, 1]])
FROM_ABOVE = np.array([[1, 0, 0], [0, 1, 0]])
HINGE_AXIS = {"color": COLOURS["powertrain"], "linestyle": "-.", "linewidth": 1.6, "zorder": MARKS}
SHADES = {
    "hull": "#eef1f3",
    "turret": "#e3e8eb",
    "gun_mount": "#d4dbe0",
    "recoil_part": "#c6d0d6",
    "powertrain": "#f9e8dd",
}


def boxes(plot, assembled, view, names=tuple(SHADES)):
    """Draw bodies of whose shape no parameter tells: as boxes of even density with their mass and inertia.

    Returns the centres of mass (2,) by name.
    """
    centres = {}
    for name in names:
        solid = getattr(assembled.vehicle, name)
        inertia = np.array(solid.inertia)
        # I_x = m (l_y^2 + l_z^2) / 12, solved for the sides; the small products of inertia are left out
        sides = np.sqrt(np.maximum(6.0 * (inertia.sum() - 2.0 * inertia) / solid.mass, 0.0))
        centres[name] = view @ (assembled.hub[name] + solid.centre)
        edge = COLOURS["powertrain"] if name == "powertrain" else FAINT
        style = {"linestyle": "--", "facecolor": SHADES[name], "edgecolor": edge, "zorder": BACK}
        box(plot, centres[name], np.abs(view) @ sides, **style)
        centre_of_mass(plot, centres[name])
    return centres


def sensors(plot, assembled, view):
    """Draw both sensors, in the middle between the mounts, and return their place (2,)."""
    x, _, z = assembled.vehicle.mr_mounts.place
    place = view @ (assembled.hub["powertrain"] + (x, 0.0, z))
    for marker, sensor in ((CARETUP, "chassis"), (CARETDOWN, "powertrain")):
        plot.plot(*place, marker=marker, markersize=9, color=COLOURS[sensor], zorder=MARKS + 1)
    return place


def from_the_rear(plot, assembled):
    """Draw a `LaidVehicle` from the rear."""
    drawing(plot, "From the rear, m")
    v, view = assembled.vehicle, FROM_REAR
    boxes(plot, assembled, view)
    outside = v.road_wheels.y + 0.6
    level_ground(plot, -outside, outside)
    mount, hinge = v.mr_mounts.place[1], view @ assembled.hub["powertrain"]
    plot.plot((-1.0, 1.0), (hinge[1], hinge[1]), **HINGE_AXIS)
    middle = sensors(plot, assembled, view)
    for side, sign in SIDES.items():
        wheel, pivot = (view @ assembled.hub[name(side, STATIONS - 1)] for name in (wheel_name, arm_name))
        sprocket = view @ assembled.hub[f"sprocket_{SPROCKET[side]}"]
        box(plot, wheel, (v.road_wheels.width, 2.0 * v.road_wheels.radius))
        bar(plot, wheel, pivot)
        box(plot, sprocket, (v.sprockets.width, 2.0 * assembled.sprockets.tip_radius))
        spring(plot, middle + (sign * mount, 0.0))
        for x, depth in ((wheel[0], -0.55), (pivot[0], -0.35)):
            extension(plot, (x, -0.2), (x, depth))
    dimension(plot, (-abs(pivot[0]), -0.33), (abs(pivot[0]), -0.33))
    dimension(plot, (-abs(wheel[0]), -0.53), (abs(wheel[0]), -0.53))
    dimension(plot, middle + (-mount, 0.14), middle + (mount, 0.14))
    axes_cross(plot, (outside - 0.25, 2.5), {"y": (-1, 0), "z": (0, 1)})
    plot.margins(0.02)


def from_above(plot, assembled):
    """Draw the rear of a `LaidVehicle` from above."""
    drawing(plot, "Powertrain from above, m")
    v, view = assembled.vehicle, FROM_ABOVE
    boxes(plot, assembled, view, ("hull",))
    centre = boxes(plot, assembled, view, ("powertrain",))["powertrain"]
    hinge, middle = view @ assembled.hub["powertrain"], sensors(plot, assembled, view)
    plot.plot((hinge[0], hinge[0]), (-1.0, 1.0), **HINGE_AXIS)
    text(plot, "axis of hinge 8", hinge + (0.0, 1.08), color=COLOURS["powertrain"], bbox=None)
    for side, sign in SIDES.items():
        sprocket = view @ assembled.hub[f"sprocket_{SPROCKET[side]}"]
        box(plot, sprocket, (2.0 * assembled.sprockets.tip_radius, v.sprockets.width))
        for station in range(STATIONS - 2, STATIONS):
            wheel, pivot = (view @ assembled.hub[name(side, station)] for name in (wheel_name, arm_name))
            box(plot, wheel, (2.0 * v.road_wheels.radius, v.road_wheels.width))
            bar(plot, wheel, pivot)
        mount = middle + (0.0, sign * v.mr_mounts.place[1])
        box(plot, mount, (0.12, 0.12), zorder=MARKS)
        text(plot, "MR mount", mount + (0.0, sign * 0.15), bbox=None)
        extension(plot, mount, mount + (0.75, 0.0))
    dimension(plot, middle + (0.7, -v.mr_mounts.place[1]), middle + (0.7, v.mr_mounts.place[1]))
    for x, y in ((middle[0], -0.72), (centre[0], -0.9)):
        extension(plot, (x, 0.0), (x, y))
        dimension(plot, (hinge[0], y), (x, y))
    rear, front = v.sprockets.x[0] - 0.75, v.swing_arms.wheel_x[STATIONS - 2] + v.road_wheels.radius + 0.1
    axes_cross(plot, (rear + 0.1, 0.9), {"x": (1, 0), "y": (0, 1)})
    plot.set_xlim(rear, front)
    plot.set_ylim(-v.road_wheels.y - 0.3, v.road_wheels.y + 0.3)
