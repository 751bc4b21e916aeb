"""Guides hold shoes sideways, and give nothing to a shoe that comes in beside its wheel's middle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.data import find_vehicle
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.tracks.guides import REACH
from trackvib_sim.vehicle.tracks.nodes import NodeWorkOffset, close_chain, new_node_work
from trackvib_sim.vehicle.tracks.rims import WheelLoadOffset, new_contacts, press_contacts, take_contacts
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket
from trackvib_sim.vehicle.tracks.wheels import Hub, list_contacts
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .momentum import shoes

pytestmark = pytest.mark.property

LINKS = 40
FORCE, STORED = slice(WheelLoadOffset.FORCE, WheelLoadOffset.FORCE + 3), WheelLoadOffset.STORED
ANGLE = np.pi / 2.0  # rad, of a sprocket with a gap downwards


@pytest.fixture(scope="module", params=["tao2025", "m113"])
def tracks(request):
    """Tracks of a vehicle: teeth with straight flanks that touch pins, and arcs that touch cylinders."""
    return build_system(read_vehicle(find_vehicle(request.param))[0], Operation(10.0, 0.0, False), 1e-4).tracks


@pytest.fixture(scope="module", params=["wheel", "sprocket"])
def touched(request, tracks):
    """A function of a hub's place (3,) that returns what a straight track does to it, and its height at a touch [m]."""
    work, middle, contacts = new_node_work()[0], LINKS // 2, new_contacts(1)
    node = shoes(tracks.chain._replace(links=np.full(2, LINKS)), work)
    node[NodeWorkOffset.NEAR] = tracks.chain.free_length[0] * (np.arange(1, LINKS + 1) - middle)
    close_chain(work, NodeWorkOffset.NEAR, 6, LINKS)

    def touch(place):
        load, hub = np.zeros(WheelLoadOffset.SIZE), Hub(*place, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if request.param == "wheel":
            count = list_contacts(tracks.wheels, 0, 0, hub, middle, LINKS, work, contacts, 0)
            press_contacts(contacts, count)
            take_contacts(contacts, 0, count, LINKS, work, load)
        else:
            add_sprocket(tracks.sprockets, hub, ANGLE, middle, LINKS, work, load)
        return load

    return touch, tracks.wheels.radius[0, 0] if request.param == "wheel" else tracks.sprockets.pitch_radius


def test_a_wheel_pressed_on_a_track_beside_it_and_lifted_gives_nothing(touched):
    """Lowered 20 mm beside its track, pushed back and lifted, a wheel or sprocket has neither lost nor gained work."""
    touch, height = touched
    beside, above, low = 0.02, height + 2.0 * REACH, height - 0.002
    corners = np.array(
        [(0.0, 0.0, above), (0.0, beside, above), (0.0, beside, low), (0.0, 0.0, low), (0.0, 0.0, above)]
    )
    work = 0.0
    for start, end in zip(corners, corners[1:], strict=False):
        way = np.linspace(start, end, 2001)
        force = np.array([touch(place)[FORCE] for place in 0.5 * (way[1:] + way[:-1])])
        work += (force * np.diff(way, axis=0)).sum()
    held = touch(corners[2])[STORED] - touch(corners[3])[STORED]
    assert held > 50.0  # J: what each round would give if the guide came and went with the touch
    assert work == pytest.approx(0.0, abs=1e-3 * held)


@given(ahead=st.floats(0.0, 0.04), beside=st.floats(-0.02, 0.02), above=st.floats(0.001, 2.0 * REACH))
def test_forces_of_a_guide_are_the_gradient_of_what_it_stores(touched, ahead, beside, above):
    """Before the rim touches as well, along each axis."""
    touch, height = touched
    place, step = np.array([ahead, beside, height + above]), 1e-7
    force = touch(place)[FORCE]
    for axis, moved in enumerate(step * np.eye(3)):
        slope = (touch(place + moved)[STORED] - touch(place - moved)[STORED]) / (2.0 * step)
        assert force[axis] == pytest.approx(-slope, rel=1e-3, abs=100.0)
