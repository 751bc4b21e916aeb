"""The drawing of the vehicle: its teeth are those that the pins feel, its track is the one that is laid."""

from contextlib import suppress

import numpy as np
import pytest
import yaml
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.drawings.assembled_vehicle import assemble_vehicle
from trackvib_sim.drawings.labels import Labels
from trackvib_sim.drawings.sprocket_drawing import free_entry, tooth_profile
from trackvib_sim.drawings.vehicle_picture import vehicle_picture
from trackvib_sim.scene.teeth import half_gap
from trackvib_sim.vehicle.tracks.layout import TrackDoesNotFit
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeWorkOffset, new_node_work
from trackvib_sim.vehicle.tracks.rims import WheelLoadOffset
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket
from trackvib_sim.vehicle.tracks.wheels import Hub
from trackvib_sim.vehicle.vehicle_file import parse_vehicle, read_vehicle

PNG = b"\x89PNG"
NEAR = 1e-7  # m to either side of the outline
ANGLE = 0.3  # rad, of the sprocket
PINS = 120


@pytest.fixture(scope="module")
def assembled(vehicle):
    """The shipped vehicle with its tracks laid."""
    return assemble_vehicle(vehicle)


def force(sprockets, place):
    """The teeth's force (3,) on a lone resting pin at a place (2,), x and z from the hub [m]."""
    work = new_node_work()[0]
    for axis, far in ((0, 10.0), (2, 10.0)):  # all other pins
        work[axis * STRIDE : (axis + 1) * STRIDE] = far
    work[1], work[2 * STRIDE + 1] = place
    hub = Hub(**dict.fromkeys(Hub._fields, 0.0))
    add_sprocket(sprockets, hub, ANGLE, 1, PINS, work, np.zeros(WheelLoadOffset.SIZE))
    return work[[(NodeWorkOffset.CONTACT + axis) * STRIDE + 1 for axis in range(3)]]


@pytest.mark.property
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("tooth", [0, 5, 11])
def test_flanks_are_where_pins_touch_them(assembled, tooth, side):
    """A pin just inside the drawn gap is free, one just inside the drawn tooth is pushed out."""
    s = assembled.sprockets
    middle = ANGLE + 2.0 * np.pi * tooth / s.teeth
    for radius, gap in list(zip(*half_gap(s), strict=True))[1:-1:6]:
        for beyond, pushed in ((-NEAR, False), (NEAR, True)):
            angle = middle + side * (gap + beyond / radius)
            touched = force(s, radius * np.array([np.cos(angle), -np.sin(angle)]))
            assert np.any(touched != 0.0) == pushed


@pytest.mark.property
def test_gaps_begin_on_the_pitch_circle(assembled):
    """In the middle of a gap a pin is free outside the pitch circle and pushed outwards inside."""
    s, outwards = assembled.sprockets, np.array([np.cos(ANGLE), -np.sin(ANGLE)])
    assert np.all(force(s, (s.pitch_radius + NEAR) * outwards) == 0.0)
    assert force(s, (s.pitch_radius - NEAR) * outwards)[[0, 2]] @ outwards > 0.0


@pytest.mark.property
def test_outline_is_closed_by_equal_teeth(assembled):
    """The outline lies between both circles, and turning it by one pitch gives it again."""
    s = assembled.sprockets
    outline = tooth_profile(s, ANGLE)
    distance = np.hypot(*outline.T)
    assert distance.min() == pytest.approx(s.pitch_radius) and distance.max() == pytest.approx(s.tip_radius)
    turned = tooth_profile(s, ANGLE + 2.0 * np.pi / s.teeth)
    assert turned == pytest.approx(np.roll(outline, -len(outline) // s.teeth, axis=0))


@pytest.mark.analytic
def test_way_in_is_that_of_a_rolling_tangent(assembled):
    """A pin at a distance d before the point where the taut run meets the pitch circle R: the gap is d/R from there."""
    radius, ahead = free_entry(assembled.sprockets)
    pitch_radius = assembled.sprockets.pitch_radius
    d = np.sqrt(radius**2 - pitch_radius**2)
    assert ahead == pytest.approx(d / pitch_radius - np.arctan2(d, pitch_radius), abs=1e-12)


@pytest.mark.property
@pytest.mark.parametrize("name", vehicle_names())
def test_laid_tracks_are_closed_and_stand_on_the_ground(name):
    """All chords of both sides are one pitch, and the lowest pins lie on the ground."""
    assembled = assemble_vehicle(read_vehicle(find_vehicle(name))[0])
    tracks = assembled.vehicle.tracks
    for pins, links in zip(assembled.pins, tracks.links, strict=True):
        assert len(pins) == links
        chords = np.hypot(*(np.roll(pins, -1, axis=0) - pins)[:, [0, 2]].T)
        assert chords == pytest.approx(tracks.pitch, rel=1e-5)
        assert pins[:, 2].min() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.property
def test_centre_of_mass_is_in_the_middle_plane(assembled):
    """Both halves of the vehicle weigh the same."""
    assert assembled.centre[1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.slow(reason="draws a whole vehicle")
@pytest.mark.property
def test_draws_low_teeth(changed, tmp_path):
    """Low teeth with open flanks, between which no pin of the taut run lies yet, are drawn as well."""
    picture = tmp_path / "vehicle.png"
    vehicle_picture(changed("sprocket_teeth", flank_angle=25.0, height=0.005), picture)
    assert picture.read_bytes().startswith(PNG)


@pytest.mark.slow(reason="draws a whole vehicle")
@pytest.mark.property
def test_draws_what_the_paper_s_vehicle_has_not(tmp_path):
    """Leading arms, staggered sides, no superstructure, no rollers, a seat on a bushing, further sensors."""
    content = yaml.safe_load(find_vehicle("tao2025_free").read_text(encoding="utf-8"))
    of = lambda value, unit: {"value": value, "unit": unit, "source": "assumed"}  # noqa: E731
    three = lambda value, unit: of([value] * 3, unit)  # noqa: E731
    seat = {"hinge": "elastic", "place": of([1.0, 0.4, 0.9], "m"), "mass": of(90.0, "kg"), "centre": three(0.1, "m"),
            "inertia": three(5.0, "kg m^2"), "products": three(0.0, "kg m^2"), "stiffness": three(3e4, "N/m"),
            "damping": three(5e2, "N s/m"), "turning_stiffness": three(1e4, "N m/rad"),
            "turning_damping": three(1e2, "N m s/rad")}  # fmt: skip
    content["bodies"] = {"seat": seat}
    content["sensors"] = {**(content.get("sensors") or {}), "driver": {"body": "seat", "place": three(0.1, "m")}}
    del content["carrier_rollers"], content["roller_rims"]
    arms = content["swing_arms"]
    arms["direction"] = of(["trailing"] * 4 + ["leading"] * 2, "-")
    arms["right_wheel_x"] = of([x - 0.05 for x in arms["wheel_x"]["value"]], "m")
    vehicle = fitting(content)
    vehicle_picture(vehicle, tmp_path / "vehicle.png")
    assert (tmp_path / "vehicle.png").read_bytes().startswith(PNG)


def fitting(content):
    """The vehicle of a file's content with as many links as fit round it."""
    for links in range(100, 140):
        content["tracks"]["links"]["value"] = links
        vehicle = parse_vehicle(yaml.safe_dump(content, sort_keys=False), "made")
        with suppress(TrackDoesNotFit):
            assemble_vehicle(vehicle)
            return vehicle
    raise AssertionError("no number of links fits")


@pytest.mark.property
def test_words_keep_clear_of_each_other():
    """Words for points that lie close together do not overlap, stay in the plot, and keep off what is drawn."""
    figure = Figure(figsize=(6.0, 4.0), dpi=100, layout="constrained")
    plot = figure.subplots()
    plot.set_xlim(0.0, 6.0)
    plot.set_ylim(0.0, 4.0)
    plot.axis("off")
    plot.fill([2.0, 4.0, 4.0, 2.0], [1.9, 1.9, 2.1, 2.1], color="black")
    labels = Labels()
    for k in range(6):
        labels.add(plot, f"point number {k}", (2.7 + 0.1 * k, 2.1))
    labels.write(figure)
    figure.canvas.draw()
    extents = [words.get_bbox_patch().get_window_extent() for words in plot.texts]
    black = Bbox(plot.transData.transform([(2.0, 1.9), (4.0, 2.1)]))
    assert len(extents) == 6
    for k, extent in enumerate(extents):
        assert not any(extent.overlaps(other) for other in extents[:k])
        assert not extent.overlaps(black)
        assert plot.get_window_extent().contains(*extent.min) and plot.get_window_extent().contains(*extent.max)


@pytest.mark.property
def test_words_stand_in_their_box_where_there_is_room():
    """A name in a wide box has no leader, one in a box that is too small has."""
    figure = Figure(figsize=(6.0, 4.0), dpi=100, layout="constrained")
    plot = figure.subplots()
    plot.set_xlim(0.0, 6.0)
    plot.set_ylim(0.0, 4.0)
    labels = Labels()
    for low, high in (((1.0, 1.0), (3.0, 2.0)), ((4.0, 1.0), (4.1, 1.1))):
        labels.add(plot, "a body of 3 t", np.mean((low, high), axis=0), box=(low, high))
    labels.write(figure)
    wide, small = plot.texts
    assert not isinstance(wide, Annotation) and isinstance(small, Annotation)
    assert 1.0 < wide.get_position()[0] < 3.0 and 1.0 < wide.get_position()[1] < 2.0
