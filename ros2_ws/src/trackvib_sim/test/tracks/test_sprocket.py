"""The lone sprocket: chordal action on a strand, and its teeth as a potential."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.rui.tree import rest_lanes
from trackvib_sim.vehicle.tracks.nodes import (
    CONTACT,
    DIRECTION,
    PLACE,
    TENSION,
    VELOCITY,
    add_links,
    move_nodes,
    new_node_work,
    new_nodes,
    see_from_hull,
)
from trackvib_sim.vehicle.tracks.sprockets import add_sprocket, find_rear
from trackvib_sim.vehicle.tracks.wheels import FORCE, HEAT, LOAD, MOMENT, STORED, Hub

from .momentum import shoes

DT = 1e-4


@pytest.fixture(scope="module")
def still(system, moved):
    """The motion of a hull at rest at the origin."""
    return moved(system.tree, rest_lanes(system.tree))


def _wheel(spin):
    return Hub(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, spin, 0.0, 0.0)


def _clear(system, teeth, pitch):
    """Sprockets of the track's own pitch whose teeth keep clear of a straight strand: it passes a gap of 20 mm at the tip."""
    radius, angle = 0.5 * pitch / np.sin(np.pi / teeth), np.radians(25.0)
    return system.tracks.sprockets._replace(
        teeth=teeth,
        pitch_radius=radius,
        tip_radius=radius + 0.04,
        backlash=1e-3,
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

    The track comes in on the lower strand, goes half round and out on the upper one. Both ends are held at the middle of
    the heights through which the strands move, under constant pull. It runs slowly, so that inertia does nothing.
    """
    pitch, strand, speed, pull = 0.115, 20, 0.5, np.array([1.9e4, 2e4])
    chain = system.tracks.chain._replace(links=2 * strand + teeth // 2 + 1, damping=3e4, pin_stiffness=0.0)
    chain = chain._replace(free_length=pitch - pull[1] / chain.stiffness, sideways_stiffness=0.0, pin_damping=0.0)
    wheel = _clear(system, teeth, pitch)
    state, work, load, ends = new_nodes(), new_node_work()[0], np.zeros(LOAD), [0, chain.links - 1]
    node, force = shoes(chain, state)[0], shoes(chain, work)
    x, angle = pitch * np.arange(1, strand + 1), 2.0 * np.pi / teeth * np.arange(teeth // 2 + 1)
    node[PLACE] = np.concatenate((x[::-1], -wheel.pitch_radius * np.sin(angle), x))
    node[PLACE + 2] = wheel.pitch_radius * np.concatenate((np.ones(strand), np.cos(angle), -np.ones(strand)))
    node[VELOCITY] = speed * np.concatenate((np.ones(strand), np.cos(angle), -np.ones(strand)))
    node[VELOCITY + 2, strand:-strand] = speed * np.sin(angle)
    height = 0.5 * wheel.pitch_radius * (1.0 + np.cos(np.pi / teeth))
    spin, rear, steps = speed / wheel.pitch_radius, strand + teeth // 4, round(3.0 * pitch / speed / DT)
    drawn, end_speed = np.zeros(steps), np.array([speed, -speed])
    for step in range(steps):
        see_from_hull(chain, state[0], still, work)
        add_links(chain, work)
        rear = find_rear(work, rear, chain.links)
        add_sprocket(wheel, _wheel(spin), spin * DT * step, rear, chain.links, work, load)
        tension = force[TENSION, [0, -2]] * np.abs(force[DIRECTION, [0, -2]])
        end = node[PLACE, ends].copy()
        move_nodes(chain, state[0], still, np.zeros(3), work, DT)
        end_speed += DT / chain.shoe_mass * (pull - tension)
        node[PLACE, ends], node[PLACE + 2, ends] = end + DT * end_speed, (height, -height)
        node[VELOCITY : VELOCITY + 3, ends] = end_speed, (0.0, 0.0), (0.0, 0.0)
        if step % 500 == 0: print(step, rear, np.round(np.hypot(node[0],node[2])[rear-7:rear+6]/wheel.pitch_radius-1,4), np.round(force[CONTACT+2,rear-7:rear+6]), force[TENSION,5],force[TENSION,-5])
        drawn[step] = -end_speed[1]
    np.save(f"/tmp/d_try/drawn{teeth}.npy", drawn)
    print(drawn[-2000:].max()/speed, drawn[-2000:].min()/speed, np.cos(np.pi/teeth))
