"""The drawing of the vehicle: its teeth are those that the pins feel, its track is the one that is laid."""

import numpy as np
import pytest
from trackvib_sim.drawings.assembled_vehicle import assemble_vehicle
from trackvib_sim.drawings.sprocket_drawing import free_entry, half_gap, tooth_profile
from trackvib_sim.drawings.vehicle_picture import vehicle_picture
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeWorkOffset, new_node_work
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket
from trackvib_sim.vehicle.tracks.wheels import Hub, WheelLoadOffset

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
def test_laid_track_is_closed_and_stands_on_the_ground(assembled):
    """All chords are one pitch, and the lowest pins lie on the ground."""
    chords = np.hypot(*(np.roll(assembled.pins, -1, axis=0) - assembled.pins)[:, [0, 2]].T)
    assert chords == pytest.approx(assembled.vehicle.tracks.pitch, rel=1e-5)
    assert assembled.pins[:, 2].min() == pytest.approx(0.0, abs=1e-9)


@pytest.mark.property
def test_centre_of_mass_is_in_the_middle_plane(assembled):
    """Both halves of the vehicle weigh the same."""
    assert assembled.centre[1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.property
def test_draws_other_vehicles(changed, tmp_path):
    """Low teeth with open flanks, between which no pin of the taut run lies yet, are drawn as well."""
    picture = tmp_path / "vehicle.png"
    vehicle_picture(changed("sprocket_teeth", flank_angle=25.0, height=0.005), picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
