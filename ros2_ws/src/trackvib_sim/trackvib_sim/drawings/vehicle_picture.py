"""The vehicle drawn to scale from its parameters."""

from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure

from ..analysis.sensor_style import COLOURS
from ..vehicle.body_tree import (
    FRONT,
    LEFT,
    POWERTRAIN,
    REAR,
    RIGHT,
    arm_name,
    bodies_on_hinges,
    drive_end,
    end_wheels,
    idler_name,
    roller_name,
    sprocket_name,
    sprung_bodies,
    wheel_name,
)
from ..vehicle.running_gear_parameters import at_stations
from .assembled_vehicle import assemble_vehicle
from .labels import Labels
from .sprocket_drawing import sprocket_entry, tooth_profile
from .technical_drawing import (
    BACK,
    FAINT,
    INK,
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
    level_ground,
    spring,
    text,
)
from .vehicle_views import (
    FROM_LEFT,
    boxes,
    from_above,
    from_the_rear,
    mount_kind,
    mount_places,
    powertrain_hinge,
    sensors,
)

NOTE = """dashed: boxes of uniform density with a body's
mass and inertia, not its shape
blue swing arms: with shock absorber
wheels and sprockets have the radius of the pin line"""
STAGGERED = "\ndotted: road wheels of the right side"


def vehicle_picture(vehicle, path):
    """Draw a vehicle (`parameters.Vehicle`) to a PNG file.

    Raises
    ------
    TrackDoesNotFit
        The links do not close round the running gear.
    """
    assembled, labels = assemble_vehicle(vehicle), Labels()
    figure = Figure(figsize=(15, 11), dpi=110, layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.4, 1.0))
    _from_the_left(upper.subplots(), assembled, labels)
    rear, above, entry = lower.subplots(1, 3, width_ratios=(1.1, 0.85, 1.15))
    from_the_rear(rear, assembled)
    from_above(above, assembled, labels)
    sprocket_entry(entry, assembled, labels)
    labels.write(figure)
    figure.savefig(path, bbox_inches="tight", pad_inches=0.15)


def _from_the_left(plot, assembled, labels):
    v = assembled.vehicle
    drawing(plot, f"{v.name.replace('_', ' ')}, from the left, m")
    hub = {name: FROM_LEFT @ place for name, place in assembled.hub.items()}
    corners = boxes(plot, assembled, FROM_LEFT)
    rear, front = sorted(hub[name(LEFT)][0] for name in (sprocket_name, idler_name))
    level_ground(plot, rear - 1.0, front + 1.5)
    _running_gear(plot, assembled, hub)
    _measuring_points(plot, assembled, labels)
    _names(plot, assembled, hub, corners, labels)
    _dimensions(plot, assembled, hub)
    axes_cross(plot, (front + 1.7, 0.5), {"x": (1, 0), "z": (0, 1)})
    note = NOTE + STAGGERED * (not np.array_equal(*v.swing_arms.places)) + _links(v.tracks)
    plot.text(front + 0.45, -0.3, note, fontsize=TEXT, color=INK, va="top", linespacing=1.4)
    plot.set_xlim(min(rear - 1.3, corners["hull"][0, 0] - 0.3), max(front + 2.2, plot.dataLim.x1 + 0.1))
    plot.set_ylim(-0.9, max(high[1] for _, high in corners.values()) + 0.45)


def _links(tracks):
    left, right = tracks.links
    number = f"{left:g} links" if left == right else f"{left:g} links on the left, {right:g} on the right"
    return f"\ntracks: {number}, pitch {tracks.pitch:g}"


def _running_gear(plot, assembled, hub):
    v = assembled.vehicle
    arms, damping = v.swing_arms, at_stations(v.shock_absorbers.damping, v.swing_arms.stations)
    for station in range(arms.stations):
        wheel, pivot = hub[wheel_name(LEFT, station)], hub[arm_name(LEFT, station)]
        if not np.array_equal(*arms.places):
            style = {"facecolor": "none", "linestyle": ":", "zorder": BACK + 1}
            disc(plot, hub[wheel_name(RIGHT, station)], v.road_wheels.radius, **style)
        disc(plot, wheel, v.road_wheels.radius)
        disc(plot, wheel, 0.8 * v.road_wheels.radius, edgecolor=FAINT, linewidth=0.6)
        bar(plot, wheel, pivot, color=COLOURS["chassis"] if damping[station] > 0.0 else INK)
        disc(plot, pivot, 0.035)
        disc(plot, wheel, 0.05)
        text(plot, str(station + 1), wheel - (0.0, 0.5 * v.road_wheels.radius), bbox=None)
    for k in range(len(v.carrier_rollers.x) if v.carrier_rollers else 0):
        disc(plot, hub[roller_name(LEFT, k)], v.carrier_rollers.radius)
    idler, sprocket = hub[idler_name(LEFT)], hub[sprocket_name(LEFT)]
    disc(plot, idler, v.idlers.radius)
    profile = sprocket + tooth_profile(assembled.sprockets, assembled.sprocket_angle)
    plot.fill(*profile.T, facecolor=SHADE, edgecolor=INK, linewidth=0.6, zorder=PARTS)
    for wheel in (idler, sprocket):
        disc(plot, wheel, 0.05)
    pins = assembled.pins[LEFT]
    chain = np.vstack((pins, pins[:1])) @ FROM_LEFT.T
    plot.plot(*chain.T, color=INK, linewidth=3.2, zorder=PARTS + 1)
    pins = {"markersize": 2.2, "markerfacecolor": "white", "markeredgecolor": INK, "markeredgewidth": 0.5}
    plot.plot(*chain.T, "o", zorder=PARTS + 1, **pins)


def _measuring_points(plot, assembled, labels):
    """Sensors, the mounts with their kinds, and the powertrain's hinge."""
    for name, (place, colour) in sensors(plot, assembled, FROM_LEFT).items():
        up = {"chassis": -0.05, "powertrain": 0.05}.get(name, 0.0)  # to the base of its triangle
        labels.add(plot, f"{name.replace('_', ' ')} IMU", place + (0.0, up), colour)
    alike = {}  # what is seen as one
    for name, place in mount_places(assembled, FROM_LEFT).items():
        alike.setdefault((tuple(place.round(2)), mount_kind(assembled.vehicle, name)), []).append(place)
    for (_, kind), (place, *others) in alike.items():
        spring(plot, place)
        labels.add(plot, f"{1 + len(others)} {kind}s" if others else kind, place - (0.0, 0.13))
    hinge = powertrain_hinge(plot, assembled, FROM_LEFT)
    if hinge is not None:
        words = f"hinge {assembled.number[POWERTRAIN]} of the powertrain, {assembled.vehicle.powertrain.hinge}"
        labels.add(plot, words, hinge)


def _names(plot, assembled, hub, corners, labels):
    v, sprocket, idler = assembled.vehicle, hub[sprocket_name(LEFT)], hub[idler_name(LEFT)]
    names = list(sprung_bodies(v))
    for k, (name, body) in enumerate(sprung_bodies(v).items()):
        on_it = [corners[other] for other in names[k + 1 :]]
        words = f"{name.replace('_', ' ')} {body.mass / 1e3:.1f} t"
        labels.add(plot, words, corners[name].mean(axis=0), box=corners[name], others=on_it)
    centre = FROM_LEFT @ assembled.centre
    centre_of_mass(plot, centre, 0.07)
    labels.add(plot, f"whole vehicle with tracks {assembled.mass / 1e3:.1f} t", centre)
    teeth, pitch_radius = assembled.sprockets.teeth, assembled.sprockets.pitch_radius
    outwards = drive_end(v)
    labels.add(plot, f"sprocket, {teeth} teeth,\nR {pitch_radius:.3f}", sprocket + (outwards * 0.2, 0.22))
    labels.add(plot, f"idler on its tensioner, R {v.idlers.radius:g}", idler + (-outwards * 0.15, 0.1))
    if v.carrier_rollers:
        labels.add(plot, f"roller, R {v.carrier_rollers.radius:g}", hub[roller_name(LEFT, 0)])
    middle = hub[wheel_name(LEFT, v.swing_arms.stations // 2)]
    labels.add(plot, f"road wheels, R {v.road_wheels.radius:g}", middle + (0.0, 0.85 * v.road_wheels.radius))


def _dimensions(plot, assembled, hub):
    v, ends = assembled.vehicle, end_wheels(assembled.vehicle)
    rear, front = (hub[name(LEFT)] for name, _ in (ends[REAR], ends[FRONT]))
    wheels = [hub[wheel_name(LEFT, station)][0] for station in reversed(range(v.swing_arms.stations))]
    along = [rear[0], *wheels, front[0]]
    for x in along:
        extension(plot, (x, -0.2), (x, -0.75 if x in (along[0], along[-1]) else -0.55))
    for start, end in pairwise(along):
        dimension(plot, (start, -0.33), (end, -0.33))
    dimension(plot, (wheels[0], -0.52), (wheels[-1], -0.52))
    dimension(plot, (along[0], -0.71), (along[-1], -0.71))
    heights = [(rear, rear[0] - 0.7), (front, front[0] + 0.7), (FROM_LEFT @ assembled.centre, front[0] + 1.0)]
    # the first of those that stand highest
    highest = max((hub[name] for name in bodies_on_hinges(v)), key=lambda place: place[1].round(6))
    if highest[1] > heights[-1][0][1]:
        heights.append((highest, front[0] + 1.3))
    for (x, z), outside in heights:
        extension(plot, (x, z), (outside, z))
        dimension(plot, (outside, 0.0), (outside, z))
