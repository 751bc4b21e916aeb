"""How tracks are laid: closed round the running gear, at pretension, and what does not fit is refused."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.vehicle.system import new_state
from trackvib_sim.vehicle.tracks.initial import assemble_tracks
from trackvib_sim.vehicle.tracks.layout import TrackDoesNotFit, assemble_track, fit_idler, idler_load, sink
from trackvib_sim.vehicle.tracks.nodes import NodeOffset
from trackvib_sim.vehicle.tracks.sprockets import pitch_radius

from .momentum import shoes

pytestmark = pytest.mark.property

LEFT = 0
PHASES = [0.0, 0.25, 0.5, 0.99]


@pytest.fixture(scope="module")
def travel(vehicle):
    """Where the tensioners stand."""
    return fit_idler(vehicle, LEFT)


@pytest.fixture(scope="module")
def circles(vehicle, travel):
    """Everything that a track runs round: rows of x, z and radius."""
    v = vehicle
    wheels = [(x, v.road_wheels.radius, v.road_wheels.radius - sink(v)) for x in v.swing_arms.wheel_x]
    rollers = [(x, z, v.carrier_rollers.radius) for x, z in zip(v.carrier_rollers.x, v.carrier_rollers.z, strict=True)]
    idler = (v.idlers.x + travel, v.idlers.z, v.idlers.radius)
    return np.array([*wheels, *rollers, idler, (v.sprockets.x, v.sprockets.z, pitch_radius(v))])


@pytest.mark.parametrize("phase", PHASES)
def test_links_are_a_pitch_long_and_close(vehicle, travel, phase):
    """Every link spans one pitch, that from the last pin to the first among them.

    The idler is fitted at phase zero. At others the chords on the arcs lie otherwise, which the links make up for by a
    small part of their pretension.
    """
    place, _ = assemble_track(vehicle, LEFT, travel, phase)
    assert len(place) == vehicle.tracks.links[LEFT]
    length = np.linalg.norm(np.roll(place, -1, axis=0) - place, axis=1)
    atol = 0.05 * vehicle.tracks.pretension[LEFT] / vehicle.tracks.link_stiffness if phase else 1e-9
    assert_allclose(length, vehicle.tracks.pitch, rtol=0, atol=atol)


def test_laid_links_have_the_pretension(vehicle, system):
    """A link of one pitch is under pretension: its free length is shorter by what that gives."""
    chain, t = system.tracks.chain, vehicle.tracks
    assert_allclose(chain.stiffness * (t.pitch - chain.free_length), t.pretension, rtol=1e-9)


@pytest.mark.parametrize("phase", PHASES)
def test_track_runs_outside_of_everything(vehicle, travel, circles, phase):
    """No pin lies within a wheel, and the track goes once round all of them; the lower run lies level."""
    place, direction = assemble_track(vehicle, LEFT, travel, phase)
    away = np.hypot(*(place[:, None] - circles[:, :2]).transpose(2, 0, 1)) - circles[:, 2]
    assert away.min() > -1e-5
    # each is touched: somewhere a pin is within the sagitta of a link
    assert (away.min(axis=0) < vehicle.tracks.pitch**2 / (4.0 * circles[:, 2])).all()
    heading = np.arctan2(direction[:, 1], direction[:, 0])
    turning = np.unwrap(np.append(heading, heading[0]))
    assert turning[-1] - turning[0] == pytest.approx(2.0 * np.pi)
    assert np.diff(turning).min() > -1e-6
    lower = np.abs(place[:, 1] - sink(vehicle)) < 1e-4
    assert np.ptp(place[lower, 0]) > np.ptp(vehicle.swing_arms.wheel_x) - 2.0 * vehicle.tracks.pitch


def test_phase_shifts_the_pins_along_the_track(vehicle, travel):
    """The first pin moves forward by the phase, and a whole pitch brings the second one's place back."""
    places = {phase: assemble_track(vehicle, LEFT, travel, phase)[0] for phase in (0.0, 0.3, 1.0)}
    pitch = vehicle.tracks.pitch
    assert_allclose(places[0.3][0] - places[0.0][0], (0.3 * pitch, 0.0), rtol=0, atol=1e-6)
    assert_allclose(places[1.0], np.roll(places[0.0], -1, axis=0), rtol=0, atol=1e-4)


def test_right_track_is_laid_ahead_by_the_phase(vehicle, system):
    """Left and right differ by the phase; both lie still on the ground and run forward at twice the speed above."""
    state, speed, phase = new_state(system), 7.0, 0.4
    assemble_tracks(vehicle, system, state, speed, phase)
    left, right = shoes(system.tracks.chain, state.tracks.nodes)
    assert right[NodeOffset.PLACE, 0] - left[NodeOffset.PLACE, 0] == pytest.approx(
        phase * vehicle.tracks.pitch, abs=1e-6
    )
    assert_allclose(left[NodeOffset.PLACE + 1], vehicle.sprockets.y)
    assert_allclose(right[NodeOffset.PLACE + 1], -vehicle.sprockets.y)
    for node in (left, right):
        lower = np.abs(node[NodeOffset.PLACE + 2]) < 1e-6
        assert lower.sum() > 30
        # at either end of the lower run the line already turns up
        assert np.median(np.abs(node[NodeOffset.VELOCITY, lower])) < 1e-9
        assert node[NodeOffset.VELOCITY].max() == pytest.approx(2.0 * speed, rel=1e-3)
        along = np.hypot(node[NodeOffset.VELOCITY] - speed, node[NodeOffset.VELOCITY + 2])
        assert_allclose(along, speed, rtol=1e-12)


def test_teeth_fit_the_pins(vehicle, system):
    """Each sprocket stands so that the pins on it lie in the middle of its gaps, to what its pitch differs."""
    state, wheel = new_state(system), system.tracks.sprockets
    assemble_tracks(vehicle, system, state, 0.0, 0.37)
    share, hub = 2.0 * np.pi / wheel.teeth, (vehicle.sprockets.x, vehicle.sprockets.z - sink(vehicle))
    for side in range(2):
        node = shoes(system.tracks.chain, state.tracks.nodes)[side]
        x, z = node[NodeOffset.PLACE] - hub[0], node[NodeOffset.PLACE + 2] - hub[1]
        seated = np.hypot(x, z) < wheel.pitch_radius + 1e-4
        assert seated.sum() >= wheel.teeth // 2 - 2
        off = np.arctan2(-z, x)[seated] - state.tree.hinge[wheel.row[side]]
        off = (off + 0.5 * share) % share - 0.5 * share
        excess = abs(vehicle.sprocket_teeth.pitch_excess) * seated.sum() * share
        assert np.abs(off).max() < 0.6 * excess + 1e-3


def test_tensioner_stands_against_the_pretension(vehicle, system, travel):
    """In the travel that fits, the slide's spring holds the pull of both runs."""
    slide, load = system.tracks.tensioner, idler_load(vehicle, LEFT, travel)
    assert_allclose(slide.fitted, travel)
    assert slide.preload[LEFT] - slide.stiffness * travel == pytest.approx(-load)
    assert 1.0 < -load / vehicle.tracks.pretension[LEFT] < 2.0


@pytest.mark.parametrize(("links", "long"), [(130, True), (110, False)])
def test_links_that_do_not_fit_are_refused(vehicle, changed, links, long):
    """Too long and too short a track is refused, with what it is and what would fit."""
    t = vehicle.tracks
    with pytest.raises(TrackDoesNotFit) as refused:
        fit_idler(changed("tracks", links=[float(links)] * 2), LEFT)
    words = str(refused.value).split()
    given, low, high = [float(word) for word in words if re.fullmatch(r"\d+\.\d{3}", word)]
    assert given == pytest.approx(links * t.pitch, abs=1e-3)
    assert low < high and (given > high if long else given < low)
    assert low < t.links[LEFT] * t.pitch < high
    assert f"tensioners.travel of {vehicle.tensioners.travel:g} m" in str(refused.value)
    # the bounds are those that are accepted
    for length, fits in ((low + 2e-3, True), (high - 2e-3, True), (low - 0.02, False), (high + 0.02, False)):
        other = changed("tracks", pitch=length / t.links[LEFT])
        if fits:
            fit_idler(other, LEFT)
        else:
            with pytest.raises(TrackDoesNotFit):
                fit_idler(other, LEFT)


@pytest.mark.parametrize(
    ("section", "values", "words"),
    [
        ("hull", {"mass": 1e12}, ["tyres.radial_stiffness is", "deflect by", "road_wheels.radius, "]),
        ("tyres", {"radial_stiffness": 1e-300}, ["tyres.radial_stiffness is 1e-300 N/m", "road_wheels.radius, "]),
    ],
)
def test_wheels_that_sink_in_are_refused(vehicle, changed, section, values, words):
    """Rubber that gives by more than the wheels' radius leaves no line for a track."""
    with pytest.raises(TrackDoesNotFit) as refused:
        fit_idler(changed(section, **values), LEFT)
    assert all(word in str(refused.value) for word in words)
