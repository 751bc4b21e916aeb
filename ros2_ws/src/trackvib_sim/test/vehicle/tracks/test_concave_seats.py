"""Concave seats, friction of teeth and what touches them, on the M113."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.parameters import TeethParameters
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeWorkOffset, new_node_work
from trackvib_sim.vehicle.tracks.rims import CREEP, WheelLoadOffset
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket, build_sprockets
from trackvib_sim.vehicle.tracks.wheels import Hub
from trackvib_sim.vehicle.vehicle_file import read_vehicle

LINKS, FIRST = 60, 29
PLACES = st.tuples(st.floats(0.2, 0.28), st.floats(-0.6, 0.6))  # of a link's first pin: m from the hub, rad about it
TILTS = st.floats(-2.2, -0.9)  # rad, of the link to the radius
SPEEDS = st.floats(-2.0, 2.0)  # m/s
FAR = 10.0  # m


@pytest.fixture(scope="module")
def m113():
    """The M113."""
    return read_vehicle(find_vehicle("m113"))[0]


@pytest.fixture(scope="module")
def sprockets(m113):
    """Its sprockets' record, without guidance sideways."""
    names = {body.name: row for row, body in enumerate(build_body_table(m113))}
    return build_sprockets(m113, names)._replace(guide_stiffness=0.0, guide_damping=0.0)


def _touch(sprockets, places, speeds=((0.0, 0.0), (0.0, 0.0)), spin=0.0):
    """Loads of a sprocket at angle 0, and forces (2, 2) on the pins of one link at places (2, 2), x and z [m]."""
    work, load = new_node_work()[0], np.zeros(WheelLoadOffset.SIZE)
    cells = work.reshape(-1, STRIDE)
    cells[NodeWorkOffset.NEAR, : LINKS + 2] = FAR * np.arange(1, LINKS + 3)  # apart, so that no other link comes near
    pins = [FIRST, FIRST + 1]
    cells[[NodeWorkOffset.NEAR, NodeWorkOffset.NEAR + 2], FIRST : FIRST + 2] = places.T
    cells[[NodeWorkOffset.SPEED, NodeWorkOffset.SPEED + 2], FIRST : FIRST + 2] = np.transpose(speeds)
    add_sprocket(sprockets, Hub(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, spin, 0.0, 0.0), 0.0, FIRST, LINKS, work, load)
    return load, cells[[NodeWorkOffset.CONTACT, NodeWorkOffset.CONTACT + 2]][:, pins].T


def _link(m113, place, tilt):
    """Places (2, 2) of a link's pins."""
    radius, angle = place
    first = radius * np.array([np.cos(angle), np.sin(angle)])
    return np.array([first, first + m113.tracks.pitch * np.array([np.cos(angle + tilt), np.sin(angle + tilt)])])


@pytest.mark.property
@settings(max_examples=200)
@given(place=PLACES, tilt=TILTS)
def test_forces_are_the_gradient_of_what_is_stored(m113, sprockets, place, tilt):
    """Wherever a link's cylinders stand in the arcs, at their tips or between, and nowhere is there a jump."""
    places, step = _link(m113, place, tilt), 1e-8
    load, force = _touch(sprockets, places)
    assume(load[WheelLoadOffset.STORED] > 0.0)
    for pin in range(2):
        for axis in range(2):
            moved = np.zeros((2, 2))
            moved[pin, axis] = step
            ahead, behind = (_touch(sprockets, places + sign * moved)[0] for sign in (1.0, -1.0))
            slope = (ahead[WheelLoadOffset.STORED] - behind[WheelLoadOffset.STORED]) / (2.0 * step)
            # a kink of the potential within a step gives a force between those on either side
            assert -slope == pytest.approx(force[pin, axis], rel=1e-3, abs=3.0 * sprockets.stiffness * step + 2.0)
    assert_allclose(load[WheelLoadOffset.FORCE : WheelLoadOffset.FORCE + 3 : 2], -force.sum(0), atol=1e-6)


@pytest.mark.property
@settings(max_examples=100)
@given(place=PLACES, tilt=TILTS, speeds=st.tuples(SPEEDS, SPEEDS, SPEEDS, SPEEDS), spin=st.floats(-40.0, 40.0))
def test_what_friction_takes_becomes_heat(m113, sprockets, place, tilt, speeds, spin):
    """The power of all forces is lost by the link and sprocket, and never less than nothing."""
    places, speeds = _link(m113, place, tilt), np.reshape(speeds, (2, 2))
    load, force = _touch(sprockets, places, speeds, spin)
    still, at_rest = _touch(sprockets, places)
    assume(still[WheelLoadOffset.STORED] > 0.0)
    # the elastic part of the forces stores and gives back
    elastic = (at_rest * speeds).sum() + still[WheelLoadOffset.MOMENT + 1] * spin
    power = (force * speeds).sum() + load[WheelLoadOffset.MOMENT + 1] * spin
    assert load[WheelLoadOffset.DISSIPATION] == pytest.approx(elastic - power, rel=1e-6, abs=1e-3)
    assert load[WheelLoadOffset.DISSIPATION] >= -1e-9


@pytest.mark.analytic
def test_friction_is_coulombs_with_a_creep_speed(m113, sprockets):
    """A cylinder in the middle of a gap that slips at the creep speed is held by 0.71 of its limit."""
    single = sprockets._replace(contact=np.zeros(1), damping=0.0)
    depth, slip = 1e-4, 3.0 * CREEP
    place = np.array([[single.arc_centre - single.arc_radius - depth, 0.0], [FAR, FAR]])
    _, force = _touch(single, place, np.array([[0.0, slip], [0.0, 0.0]]))
    normal = single.stiffness * depth
    assert force[0, 0] == pytest.approx(normal, rel=1e-9)
    assert force[0, 1] == pytest.approx(-single.friction * normal * 3.0 / np.sqrt(10.0), rel=1e-9)


@pytest.mark.property
def test_half_an_arc_is_refused(m113):
    """An arc needs centre and radius, and must not hold the hub."""
    items = {name: {"value": value, "unit": _unit(name), "source": "assumed"}
             for name, value in m113.sprocket_teeth if value is not None}  # fmt: skip
    assert TeethParameters(**items)
    with pytest.raises(ValueError, match="arc_centre and arc_radius: must be given both or neither"):
        TeethParameters(**{name: item for name, item in items.items() if name != "arc_radius"})
    with pytest.raises(ValueError, match="arc_radius is 0.3 m, must be less than arc_centre"):
        TeethParameters(**items | {"arc_radius": items["arc_radius"] | {"value": 0.3}})


def _unit(name):
    units = {"teeth": "-", "pitch_excess": "-", "friction": "-", "flank_angle": "deg"}
    kinds = {"stiffness": "N/m", "damping": "N s/m"}
    return units.get(name) or kinds.get(name.rpartition("_")[2], "m")
