"""The vehicle drawn to scale from its parameters."""

from itertools import pairwise

import matplotlib

matplotlib.use("Agg")  # files only: no display is needed

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from ..analysis.plots import COLOURS  # noqa: E402
from ..vehicle.body_tree import IDLER, LEFT, ROLLER, SPROCKET, STATIONS, arm_name, wheel_name  # noqa: E402
from .assembled_vehicle import assemble_vehicle  # noqa: E402
from .sprocket_drawing import sprocket_entry, tooth_profile  # noqa: E402
from .technical_drawing import (
    FAINT,
    INK,
    MARKS,
    PARTS,
    SHADE,
    TEXT,
    axes_cross,
    bar,
    centre_of_mass,
    dimension,
    disc,
    drawing,
    extension,
    leader,
    level_ground,
    spring,
    text,
)
from .vehicle_views import FROM_LEFT, boxes, from_above, from_the_rear, sensors  # noqa: E402

LABELS = {  # where the names of the boxes stand, from their centres, m
    "hull": (2.6, 0.62),
    "turret": (-0.9, 0.6),
    "gun_mount": (0.0, -0.24),
    "recoil_part": (1.5, 0.08),
    "powertrain": (0.6, 0.55),
}
NOTE = """dashed: boxes of even density with a body's
mass and inertia, not its shape
blue swing arms: with shock absorber
wheels and sprockets have the radius of the pin line"""


def vehicle_picture(vehicle, path):
    """Draw a vehicle (`parameters.Vehicle`) to a PNG file.

    Raises
    ------
    TrackDoesNotFit
        The links do not close round the running gear.
    """
    assembled = assemble_vehicle(vehicle)
    figure = plt.figure(figsize=(15, 11), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.4, 1.0))
    _from_the_left(upper.subplots(), assembled)
    rear, above, entry = lower.subplots(1, 3, width_ratios=(1.1, 0.85, 1.15))
    from_the_rear(rear, assembled)
    from_above(above, assembled)
    sprocket_entry(entry, assembled)
    figure.savefig(path, dpi=110, bbox_inches="tight", pad_inches=0.15)
    plt.close(figure)


def _from_the_left(plot, assembled):
    drawing(plot, "From the left, m")
    hub = {name: FROM_LEFT @ place for name, place in assembled.hub.items()}
    centres = boxes(plot, assembled, FROM_LEFT)
    rear, front = hub[f"sprocket_{SPROCKET[LEFT]}"][0], hub[f"idler_{IDLER[LEFT]}"][0]
    level_ground(plot, rear - 1.0, front + 1.5)
    _running_gear(plot, assembled, hub)
    _measuring_points(plot, assembled, hub["powertrain"])
    _names(plot, assembled, hub, centres)
    _dimensions(plot, assembled, hub)
    axes_cross(plot, (front + 1.7, 0.5), {"x": (1, 0), "z": (0, 1)})
    plot.text(front + 0.45, -0.3, NOTE, fontsize=TEXT, color=INK, va="top", linespacing=1.4)
    plot.margins(0.02)


def _running_gear(plot, assembled, hub):
    v = assembled.vehicle
    carriers = {int(station) - 1 for station in v.shock_absorbers.stations}
    for station in range(STATIONS):
        wheel, pivot = hub[wheel_name(LEFT, station)], hub[arm_name(LEFT, station)]
        disc(plot, wheel, v.road_wheels.radius)
        disc(plot, wheel, 0.8 * v.road_wheels.radius, edgecolor=FAINT, linewidth=0.6)
        bar(plot, wheel, pivot, color=COLOURS["chassis"] if station in carriers else INK)
        disc(plot, pivot, 0.035)
        disc(plot, wheel, 0.05)
        text(plot, str(station + 1), wheel - (0.0, 0.19), bbox=None)
    for k in range(len(v.carrier_rollers.x)):
        disc(plot, hub[f"roller_{ROLLER[LEFT] + k}"], v.carrier_rollers.radius)
    idler, sprocket = hub[f"idler_{IDLER[LEFT]}"], hub[f"sprocket_{SPROCKET[LEFT]}"]
    disc(plot, idler, v.idlers.radius)
    profile = sprocket + tooth_profile(assembled.sprockets, assembled.sprocket_angle)
    plot.fill(*profile.T, facecolor=SHADE, edgecolor=INK, linewidth=0.6, zorder=PARTS)
    for wheel in (idler, sprocket):
        disc(plot, wheel, 0.05)
    chain = np.vstack((assembled.pins, assembled.pins[:1])) @ FROM_LEFT.T
    plot.plot(*chain.T, color=INK, linewidth=3.2, zorder=PARTS + 1)
    pins = {"markersize": 2.2, "markerfacecolor": "white", "markeredgecolor": INK, "markeredgewidth": 0.5}
    plot.plot(*chain.T, "o", zorder=PARTS + 1, **pins)


def _measuring_points(plot, assembled, hinge):
    """The ends of the mounts with both sensors, and hinge 8; the points of [Tao2025] are two of these."""
    mount = sensors(plot, assembled, FROM_LEFT)
    spring(plot, mount)
    disc(plot, hinge, 0.045, zorder=MARKS, edgecolor=COLOURS["powertrain"], linewidth=1.6)
    words = "powertrain IMU: upper ends of the MR mounts;\nthe powertrain's point in [Tao2025]"
    leader(plot, words, mount + (0.0, 0.05), (-2.3, 2.75), COLOURS["powertrain"])
    leader(plot, "chassis IMU: lower ends of the MR mounts", mount - (0.0, 0.05), (-2.45, 2.42), COLOURS["chassis"])
    leader(plot, "hinge 8 with the rubber mounts;\nthe chassis's point in [Tao2025]", hinge, (-2.95, 1.6))


def _names(plot, assembled, hub, centres):
    v, sprocket = assembled.vehicle, hub[f"sprocket_{SPROCKET[LEFT]}"]
    for name, away in LABELS.items():
        words = f"{name.replace('_', ' ')} {getattr(v, name).mass / 1e3:.1f} t"
        text(plot, words, centres[name] + away, bbox=None)
    centre = FROM_LEFT @ assembled.centre
    centre_of_mass(plot, centre, 0.07)
    leader(plot, f"whole vehicle with tracks {assembled.mass / 1e3:.1f} t", centre, (0.3, 1.4))
    teeth, pitch_radius = assembled.sprockets.teeth, assembled.sprockets.pitch_radius
    leader(plot, f"sprocket, {teeth} teeth,\nR {pitch_radius:.3f}", sprocket + (-0.2, 0.22), (-3.6, 1.2))
    above = np.array([0.05, 0.3])
    roller, idler = hub[f"roller_{ROLLER[LEFT]}"], hub[f"idler_{IDLER[LEFT]}"]
    leader(plot, f"roller, R {v.carrier_rollers.radius:g}", roller, roller + above)
    leader(plot, f"idler on its tensioner, R {v.idlers.radius:g}", idler + (0.15, 0.1), (3.15, 1.55))
    text(plot, f"road wheels, R {v.road_wheels.radius:g}", (0.0, 0.86), bbox=None)
    text(plot, f"{v.tracks.links:g} links of {v.tracks.pitch:g} a side", (sprocket[0] - 0.05, 0.12), bbox=None)


def _dimensions(plot, assembled, hub):
    sprocket, idler = hub[f"sprocket_{SPROCKET[LEFT]}"], hub[f"idler_{IDLER[LEFT]}"]
    wheels = [hub[wheel_name(LEFT, station)][0] for station in reversed(range(STATIONS))]
    along = [sprocket[0], *wheels, idler[0]]
    for x in along:
        extension(plot, (x, -0.2), (x, -0.75 if x in (along[0], along[-1]) else -0.55))
    for start, end in pairwise(along):
        dimension(plot, (start, -0.33), (end, -0.33))
    dimension(plot, (wheels[0], -0.52), (wheels[-1], -0.52))
    dimension(plot, (along[0], -0.71), (along[-1], -0.71))
    heights = ((sprocket, -3.75), (idler, 3.5), (FROM_LEFT @ assembled.centre, 3.8), (hub["gun_mount"], 4.1))
    for (x, z), outside in heights:
        extension(plot, (x, z), (outside, z))
        dimension(plot, (outside, 0.0), (outside, z))
