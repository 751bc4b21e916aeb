"""A rim on the polygon of links: forces without steps, that only push, and friction within its limit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.vehicle.tracks.nodes import NodeWorkOffset, close_chain, new_node_work
from trackvib_sim.vehicle.tracks.rims import WheelLoadOffset, new_contacts, press_contacts, take_contacts
from trackvib_sim.vehicle.tracks.wheels import LOWER_RUN, Hub, find_link, list_contacts

from .momentum import shoes

pytestmark = pytest.mark.property

LINKS, PITCH = 40, 0.115
SPEEDS = st.floats(-3.0, 3.0)
BENDS = st.lists(st.floats(-0.06, 0.06), min_size=LINKS, max_size=LINKS)  # from link to link, rad


def _polygon(system, bends):
    """Work cells of a chain along x through the origin whose links turn upwards by `bends`, at rest."""
    chain, work = system.tracks.chain._replace(links=np.full(2, LINKS)), new_node_work()[0]
    node, slope = shoes(chain, work), np.cumsum(bends)
    slope -= slope[LINKS // 2]
    link = PITCH * np.stack((np.cos(slope), np.sin(slope)))
    place = np.cumsum(link, axis=1) - link
    node[NodeWorkOffset.NEAR], node[NodeWorkOffset.NEAR + 2] = place - place[:, LINKS // 2, None]
    close_chain(work, NodeWorkOffset.NEAR, 6, LINKS)
    return work, node


def _touch(system, work, hub):
    """What the chain does to the front left road wheel at a hub."""
    load, link, contacts = np.zeros(WheelLoadOffset.SIZE), LINKS // 2, new_contacts(1)
    for _ in range(LINKS):
        link = find_link(LOWER_RUN, hub.x, work, link, LINKS)
    count = list_contacts(system.tracks.wheels, 0, 0, hub, link, LINKS, work, contacts, 0)
    press_contacts(contacts, count)
    take_contacts(contacts, 0, count, LINKS, work, load)
    return load


def _hub(x, z, vx=0.0, vy=0.0, vz=0.0, spin=0.0):
    return Hub(x, 0.0, z, vx, vy, vz, spin, 0.0, 0.0)


@pytest.mark.slow(reason="many polygons, step by step")
@settings(max_examples=30)
@given(bends=BENDS, depth=st.floats(0.0, 0.02))
def test_rolling_over_the_polygon_has_no_steps(system, bends, depth):
    """Led along level ground over links that bend to and from it, a rim feels a force that changes steadily.

    A step of d changes the depth of no contact by more than d, and turns the force by no more than d over the pitch.
    """
    work, _ = _polygon(system, bends)
    radius, stiffness = system.tracks.wheels.radius[0, 0], system.tracks.wheels.stiffness[0, 0]
    step, load = 2e-4, []
    for x in np.arange(-1.5 * PITCH, 1.5 * PITCH, step):
        load.append(_touch(system, work, _hub(x, radius - depth)))
    load = np.array(load)
    largest = np.abs(load[:, WheelLoadOffset.FORCE : WheelLoadOffset.FORCE + 3]).max()
    assert depth < 1e-3 or largest > 0.0
    bound = 2.0 * stiffness * step + 4.0 * largest * step / PITCH
    assert np.abs(np.diff(load[:, WheelLoadOffset.FORCE : WheelLoadOffset.FORCE + 3], axis=0)).max() <= bound
    assert (
        np.abs(np.diff(load[:, WheelLoadOffset.MOMENT : WheelLoadOffset.MOMENT + 3], axis=0)).max()
        <= 2.0 * radius * bound
    )
    assert np.abs(np.diff(load[:, WheelLoadOffset.STORED])).max() <= 2.0 * largest * step


@settings(max_examples=30)
@given(bends=BENDS, depth=st.floats(0.001, 0.02))
def test_rim_is_a_potential(system, bends, depth):
    """Between any two places the frictionless rim does the work that its energy says."""
    work, _ = _polygon(system, bends)
    wheels = system.tracks.wheels
    smooth = wheels._replace(friction=0.0 * wheels.friction)
    system = system._replace(tracks=system.tracks._replace(wheels=smooth))
    radius = system.tracks.wheels.radius[0, 0]
    x = np.linspace(-PITCH, PITCH, 801)
    load = np.array([_touch(system, work, _hub(at, radius - depth)) for at in x])
    done = np.sum(load[1::2, WheelLoadOffset.FORCE]) * (x[2] - x[0])
    scale = np.abs(load[:, WheelLoadOffset.FORCE + 2]).max() * PITCH
    assert load[0, WheelLoadOffset.STORED] - load[-1, WheelLoadOffset.STORED] == pytest.approx(done, abs=1e-4 * scale)


@given(x=st.floats(-0.1, 0.1), depth=st.floats(0.0, 0.03), vx=SPEEDS, vy=SPEEDS, vz=SPEEDS, spin=st.floats(-60.0, 60.0))
def test_rim_only_pushes_and_slips_within_friction(system, x, depth, vx, vy, vz, spin):
    """On straight links the normal force is no pull, friction no more than its share of it, heat never negative."""
    work, node = _polygon(system, np.zeros(LINKS))
    radius, friction = system.tracks.wheels.radius[0, 0], system.tracks.wheels.friction[0, 0]
    hub = _hub(x, radius - depth, vx, vy, vz, spin)
    load = _touch(system, work, hub)
    normal = load[WheelLoadOffset.FORCE + 2]
    assert normal >= 0.0
    assert abs(load[WheelLoadOffset.FORCE]) <= friction * normal * (1.0 + 1e-9)
    # against slip
    assert load[WheelLoadOffset.FORCE] * (hub.vx - spin * (radius - depth)) <= 1e-9 * normal
    assert load[WheelLoadOffset.DISSIPATION] >= 0.0
    # the nodes have the opposite, at the place of the contact
    on_nodes = node[NodeWorkOffset.CONTACT : NodeWorkOffset.CONTACT + 3].sum(axis=1)
    assert_allclose(
        on_nodes, -load[WheelLoadOffset.FORCE : WheelLoadOffset.FORCE + 3], rtol=0, atol=1e-9 * (1.0 + normal)
    )
    if normal > 1.0:
        assert node[NodeWorkOffset.NEAR] @ node[NodeWorkOffset.CONTACT + 2] / on_nodes[2] == pytest.approx(x, abs=1e-6)


@pytest.mark.analytic
def test_rim_in_the_corner_of_two_links_is_pressed_by_one_rim(system):
    """Where links turn up round a wheel, one link takes over from the other: the sum is never that of two rims."""
    wheels, depth, bend = system.tracks.wheels, 0.011, 0.02  # as under a loaded wheel on soft ground
    bends = np.zeros(LINKS)
    bends[LINKS // 2] = bend
    work, _ = _polygon(system, bends)
    for x in np.linspace(-0.01, 0.01, 101):
        normal = _touch(system, work, _hub(x, wheels.radius[0, 0] - depth))[WheelLoadOffset.FORCE + 2]
        # of the deeper of both links; the other adds what its share of the bend is worth, radius bend^2 / 2
        deepest = depth + max(0.0, -bend * x)
        assert 0.999 * deepest <= normal / wheels.stiffness[0, 0] <= deepest + wheels.radius[0, 0] * bend**2
