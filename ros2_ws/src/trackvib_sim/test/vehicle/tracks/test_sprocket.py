"""The lone sprocket: chordal action on a strand, and its teeth as a potential."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.rui.sweeps.tree import rest_lanes
from trackvib_sim.vehicle.body_tree import REAR
from trackvib_sim.vehicle.tracks.nodes import (
    NodeOffset,
    NodeWorkOffset,
    add_links,
    move_nodes,
    new_node_work,
    new_nodes,
    see_from_hull,
)
from trackvib_sim.vehicle.tracks.rims import WheelLoadOffset
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket
from trackvib_sim.vehicle.tracks.wheels import Hub, find_outermost

from .momentum import shoes

DT = 1e-4
HEIGHTS = st.floats(-0.005, 0.06)  # of a pin over the pitch circle, m
ANGLES = st.floats(-0.5, 0.5)  # rad, somewhat more than two teeth
ANGLE = 0.1  # rad, of the sprocket
SEEDS = st.integers(0, 2**32 - 1)
FREE_PINS = {"pin_stiffness": 0.0, "sideways_stiffness": 0.0, "pin_damping": 0.0}


@pytest.fixture(scope="module")
def still(system, moved):
    """The motion of a hull at rest at the origin."""
    return moved(system.tree, rest_lanes(system.tree))


def _wheel(spin):
    return Hub(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, spin, 0.0, 0.0)


def _clear(system, teeth, pitch):
    """Sprockets of the track's own pitch whose teeth keep clear of a strand that comes in straight."""
    radius, angle = 0.5 * pitch / np.sin(np.pi / teeth), np.radians(30.0)
    return system.tracks.sprockets._replace(
        teeth=teeth,
        pitch_radius=radius,
        tip_radius=radius + 0.02,
        corner=0.005,
        backlash=2e-4,
        slope=np.tan(angle),
        cosine=np.cos(angle),
        sine=np.sin(angle),
        stiffness=8e7,
        damping=2e4,
    )


@pytest.mark.analytic
@pytest.mark.parametrize("teeth", [12, 16])
def test_strand_has_the_chordal_speed_ripple(system, still, teeth):
    """A sprocket at constant rate draws in a straight strand at speeds from v cos(pi / z) to v.

    The track comes in on the lower strand, goes half round and out on the upper one. Both ends are held at the middle
    of the heights through which the strands move, under constant pull. It runs slowly, so that inertia does nothing.
    """
    pitch, strand, speed, pull = 0.115, 16, 0.25, np.array([1.95e4, 2e4])
    links = 2 * strand + teeth // 2 + 1
    chain = system.tracks.chain._replace(links=np.full(2, links), shoe_mass=15.7, stiffness=2e8, damping=3e4)
    chain = chain._replace(free_length=np.full(2, pitch - pull[1] / chain.stiffness), **FREE_PINS)
    wheel = _clear(system, teeth, pitch)
    state, work, load, ends = new_nodes(), new_node_work()[0], np.zeros(WheelLoadOffset.SIZE), [0, links - 1]
    node, force = shoes(chain, state)[0], shoes(chain, work)
    x, angle = pitch * np.arange(1, strand + 1), 2.0 * np.pi / teeth * np.arange(teeth // 2 + 1)
    node[NodeOffset.PLACE] = np.concatenate((x[::-1], -wheel.pitch_radius * np.sin(angle), x))
    node[NodeOffset.PLACE + 2] = wheel.pitch_radius * np.concatenate((np.ones(strand), np.cos(angle), -np.ones(strand)))
    node[NodeOffset.VELOCITY] = speed * np.concatenate((np.ones(strand), np.cos(angle), -np.ones(strand)))
    node[NodeOffset.VELOCITY + 2, strand:-strand] = speed * np.sin(angle)
    height = 0.5 * wheel.pitch_radius * (1.0 + np.cos(np.pi / teeth))
    per_pitch = round(2.0 * np.pi * wheel.pitch_radius / (teeth * speed * DT))
    spin, ahead = speed / wheel.pitch_radius, wheel.backlash / wheel.pitch_radius
    rear, steps = strand + teeth // 4 + 1, 3 * per_pitch
    drawn, end_speed = np.zeros(steps), np.array([speed, -speed])
    for step in range(steps):
        see_from_hull(chain, links, state[0], still, work)
        add_links(chain, 0, work)
        rear = find_outermost(REAR, work, rear, links)
        add_sprocket(wheel, _wheel(spin), ahead + spin * DT * step, rear, links, work, load)
        tension = force[NodeWorkOffset.TENSION, [0, -2]] * np.abs(force[NodeWorkOffset.DIRECTION, [0, -2]])
        end = node[NodeOffset.PLACE, ends].copy()
        move_nodes(chain, links, state[0], still, np.zeros(3), work, DT)
        air = 200.0 * DT * (node[NodeOffset.PLACE] > pitch)
        node[NodeOffset.VELOCITY] += air * (np.sign(node[NodeOffset.PLACE + 2]) * speed - node[NodeOffset.VELOCITY])
        node[NodeOffset.VELOCITY + 2] -= air * node[NodeOffset.VELOCITY + 2]
        end_speed += DT / chain.shoe_mass * (pull - tension)
        node[NodeOffset.PLACE, ends], node[NodeOffset.PLACE + 2, ends] = end + DT * end_speed, (height, -height)
        node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3, ends] = end_speed, (0.0, 0.0), (0.0, 0.0)
        drawn[step] = -end_speed[1]
    # uniform rotation: each tooth draws in one pitch
    assert drawn[-2 * per_pitch :].mean() == pytest.approx(pitch / (per_pitch * DT), rel=1e-3)
    place = (np.arange(steps) / per_pitch + 0.5) % 1.0 - 0.5
    ripple, settled = 1.0 - np.cos(np.pi / teeth), np.arange(steps) > per_pitch
    expected = speed * np.cos(2.0 * np.pi / teeth * place)
    alone = settled & (np.abs(place) < 0.3)  # beyond, the next tooth takes over
    assert_allclose(drawn[alone], expected[alone], rtol=0, atol=0.02 * ripple * speed)
    lowest = np.sort(drawn[settled])[: per_pitch // 10].mean()
    assert lowest == pytest.approx(speed * np.cos(np.pi / teeth), abs=0.1 * ripple * speed)


@pytest.fixture(scope="module")
def toothed(system):
    """A function that returns the loads of a sprocket from one pin at (x, z) with velocity (vx, vz)."""

    def touch(wheel, place, velocity=(0.0, 0.0), spin=0.0):
        links, work, load = 60, new_node_work()[0], np.zeros(WheelLoadOffset.SIZE)
        node = shoes(system.tracks.chain._replace(links=np.full(2, links)), work)
        node[NodeWorkOffset.NEAR] = 10.0
        node[[NodeWorkOffset.NEAR, NodeWorkOffset.NEAR + 2, NodeWorkOffset.SPEED, NodeWorkOffset.SPEED + 2], 29] = (
            *place,
            *velocity,
        )
        add_sprocket(wheel, _wheel(spin), ANGLE, 30, links, work, load)
        assert_allclose(
            node[[NodeWorkOffset.CONTACT, NodeWorkOffset.CONTACT + 2], 29],
            -load[[WheelLoadOffset.FORCE, WheelLoadOffset.FORCE + 2]],
            rtol=1e-12,
        )
        return load

    return touch


def _polar(distance, angle):
    return np.array([distance * np.cos(angle), distance * np.sin(angle)])


@pytest.mark.slow(reason="many paths of a pin, step by step")
@pytest.mark.property
@settings(max_examples=60)
@given(seed=SEEDS)
def test_teeth_are_a_potential(system, toothed, seed):
    """Wherever a pin is led, over tips, down flanks, along the seat, the teeth do the work that their energy says."""
    wheel, random = system.tracks.sprockets, np.random.default_rng(seed)
    # about the surface of a tooth and within it
    above, deep = random.uniform(-0.003, 1.1 * (wheel.tip_radius - wheel.pitch_radius)), random.uniform(-0.005, 0.03)
    way = wheel.backlash + wheel.slope * max(above, 0.0) + deep / wheel.cosine
    distance = wheel.pitch_radius + above
    first = _polar(distance, -ANGLE - random.choice((-1.0, 1.0)) * way / distance)
    steps, step = 200, random.uniform(-2e-5, 2e-5, 2)
    line = first + np.arange(2 * steps + 1)[:, None] * (0.5 * step)
    loads = np.array([toothed(wheel, place) for place in line])
    force = loads[:, [WheelLoadOffset.FORCE, WheelLoadOffset.FORCE + 2]]
    energy = loads[::2, WheelLoadOffset.STORED]
    below_corner = above < wheel.tip_radius - wheel.corner - wheel.pitch_radius
    assert deep < 1e-3 or not below_corner or energy[0] > 0.0
    # the reaction on the sprocket does the work; where the force turns within a step it is wrong by its own size
    work, largest = force[1::2] @ step, np.abs(force).max() * np.linalg.norm(step)
    assert np.abs(np.diff(energy) - work).max() <= 2.0 * largest + 1e-6
    assert abs(energy[-1] - energy[0] - work.sum()) <= 1e-3 * energy.max() + 5.0 * largest + 1e-6


@pytest.mark.property
@given(
    height=HEIGHTS,
    angle=ANGLES,
    velocity=st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0)),
    spin=st.floats(-50.0, 50.0),
)
def test_teeth_only_push_and_only_take_energy(system, toothed, height, angle, velocity, spin):
    """Damping never makes a contact a source: heat is the power that energy does not account for."""
    wheel = system.tracks.sprockets
    place = _polar(wheel.pitch_radius + height, angle)
    load = toothed(wheel, place, velocity, spin)
    assert load[WheelLoadOffset.DISSIPATION] >= 0.0
    assume(abs(height) > 1e-6)  # where flanks begin the force turns, and a difference over both sides means nothing
    # power taken from pin and sprocket against the energy's rate, by a central difference over the relative motion
    turned = spin * np.array([place[1], -place[0]])
    relative, dt = np.array(velocity) - turned, 1e-8
    before, after = (toothed(wheel, place + sign * dt * relative)[WheelLoadOffset.STORED] for sign in (-1.0, 1.0))
    taken = load[[WheelLoadOffset.FORCE, WheelLoadOffset.FORCE + 2]] @ relative
    rate = (after - before) / (2.0 * dt)
    assume(
        abs(toothed(wheel, place)[[WheelLoadOffset.FORCE, WheelLoadOffset.FORCE + 2]] @ relative - rate)
        < 1e-3 * abs(rate) + 1.0
    )  # not in a corner
    assert taken == pytest.approx(load[WheelLoadOffset.DISSIPATION] + rate, rel=1e-3, abs=1.0)
