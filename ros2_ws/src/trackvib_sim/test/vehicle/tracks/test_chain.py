"""The chain of links by itself, between two fixed pins and free: against closed forms."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from trackvib_sim.rui.sweeps.tree import rest_lanes
from trackvib_sim.vehicle.tracks.nodes import (
    NodeOffset,
    NodeWorkOffset,
    add_links,
    move_nodes,
    new_node_work,
    new_nodes,
    see_from_hull,
)

from .momentum import shoes

pytestmark = pytest.mark.analytic

STRAND = 40  # links; the chain is closed, so two strands lie between the fixed pins
FREE_PINS = {"pin_stiffness": 0.0, "sideways_stiffness": 0.0, "pin_damping": 0.0}
DT = 1e-4


@pytest.fixture(scope="module")
def still(system, moved):
    """The motion of a hull at rest at the origin."""
    return moved(system.tree, rest_lanes(system.tree))


@pytest.fixture(scope="module")
def evaluated(still):
    """A function that returns the work cells (quantities, links) of a chain in a state, and the heat and energy."""

    def evaluate(chain, state):
        work = new_node_work()
        see_from_hull(chain, chain.links[0], state[0], still, work[0])
        return shoes(chain, work)[0], *add_links(chain, 0, work[0])

    return evaluate


@pytest.fixture(scope="module")
def swung(still):
    """A function that moves a chain on for some steps under `gravity`, its first and its middle pin held."""

    def move(chain, state, gravity, steps, damping=0.0):
        work, node = new_node_work()[0], shoes(chain, state)[0]
        held = [0, chain.links[0] // 2]
        place = node[NodeOffset.PLACE : NodeOffset.PLACE + 3, held].copy()
        for _ in range(steps):
            see_from_hull(chain, chain.links[0], state[0], still, work)
            add_links(chain, 0, work)
            move_nodes(chain, chain.links[0], state[0], still, np.array(gravity), work, DT)
            node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3] *= 1.0 - damping * DT
            (
                node[NodeOffset.PLACE : NodeOffset.PLACE + 3, held],
                node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3, held],
            ) = place, 0.0

    return move


def test_chain_hangs_as_a_catenary(system, evaluated, swung):
    """Set free as triangles, both strands come to rest in z = a cosh(x / a) with the tension w z.

    A chain of m links differs from the line by terms of 1 / m^2; 0.06 % in sag and in tension are measured.
    """
    chain = system.tracks.chain._replace(links=np.full(2, 2 * STRAND), **FREE_PINS)
    state, span, length = new_nodes(), 3.6, STRAND * chain.free_length[0]
    along = np.abs(np.arange(2 * STRAND) - STRAND) / STRAND
    node = shoes(chain, state)[0]
    node[NodeOffset.PLACE] = span * (along - 0.5)
    node[NodeOffset.PLACE + 2] = -np.sqrt(length**2 - span**2) * np.minimum(along, 1.0 - along)
    swung(chain, state, (0.0, 0.0, -9.81), 30_000, damping=8.0)
    assert np.abs(node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3]).max() < 1e-3
    a = brentq(lambda a: 2.0 * a * np.sinh(0.5 * span / a) - length, 0.3, 30.0)
    line = a * (np.cosh(node[NodeOffset.PLACE] / a) - np.cosh(0.5 * span / a))
    sag = a * (np.cosh(0.5 * span / a) - 1.0)
    assert sag > 1.0
    assert_allclose(node[NodeOffset.PLACE + 2], line, rtol=0, atol=1e-3 * sag)
    assert_allclose(node[NodeOffset.PLACE + 1], 0.0, atol=1e-12)
    work, dissipation, _ = evaluated(chain, state)
    middle = 0.5 * (node[NodeOffset.PLACE] + np.roll(node[NodeOffset.PLACE], -1))
    weight = chain.shoe_mass * 9.81 / chain.free_length[0]
    assert_allclose(work[NodeWorkOffset.TENSION], weight * a * np.cosh(middle / a), rtol=1e-3)
    assert dissipation < 1e-6


@pytest.mark.parametrize("mode", [1, 2, 5])
@pytest.mark.parametrize("axis", [1, 2], ids=["sideways", "up"])
def test_taut_chain_swings_at_its_natural_frequency(system, swung, axis, mode):
    """Beads on a string under tension T swing with w = 2 sqrt(T / (m p)) sin(k pi / (2 n)).

    Half a period turns them over.
    """
    chain = system.tracks.chain._replace(links=np.full(2, 2 * STRAND), **FREE_PINS)
    tension = 2e4
    pitch = chain.free_length[0] + tension / chain.stiffness
    state, place = new_nodes(), np.abs(np.arange(2 * STRAND) - STRAND)
    node, shape = shoes(chain, state)[0], 1e-4 * np.sin(mode * np.pi * place / STRAND)
    node[NodeOffset.PLACE], node[NodeOffset.PLACE + axis] = pitch * place, shape
    rate = 2.0 * np.sqrt(tension / (chain.shoe_mass * pitch)) * np.sin(0.5 * mode * np.pi / STRAND)
    steps = round(np.pi / rate / DT)
    swung(chain, state, (0.0, 0.0, 0.0), steps)
    # at the turning point, a phase that is wrong by half a step changes the place in second order only
    assert_allclose(node[NodeOffset.PLACE + axis], -shape, rtol=0, atol=1e-4 * (rate * DT) ** 2)


def _ring(chain, plane):
    """The state of a chain without tension laid as a regular polygon, and the angle between its links."""
    state, angle = new_nodes(), 2.0 * np.pi * np.arange(chain.links[0]) / chain.links[0]
    radius = 0.5 * chain.free_length[0] / np.sin(np.pi / chain.links[0])
    node = shoes(chain, state)[0]
    node[NodeOffset.PLACE + plane[0]], node[NodeOffset.PLACE + plane[1]] = (
        radius * np.cos(angle),
        radius * np.sin(angle),
    )
    return state, 2.0 * np.pi / chain.links[0]


@pytest.mark.parametrize(("plane", "stiffness"), [((0, 2), "pin_stiffness"), ((0, 1), "sideways_stiffness")])
def test_pins_resist_bending(system, evaluated, plane, stiffness):
    """In a ring every pin has the moment k sin(angle) about the ring's axis, and they hold each other in balance."""
    chain = system.tracks.chain
    state, angle = _ring(chain, plane)
    work, _, stored = evaluated(chain, state)
    axis = 3 - sum(plane)
    assert_allclose(
        np.abs(work[NodeWorkOffset.PIN_MOMENT + axis]), getattr(chain, stiffness) * np.sin(angle), rtol=1e-9
    )
    # in balance: no link passes a force on but what rounding makes of T / k
    assert np.abs(work[NodeWorkOffset.LINK_FORCE : NodeWorkOffset.LINK_FORCE + 3]).max() < 1e-4
    assert stored == pytest.approx(0.5 * chain.links[0] * getattr(chain, stiffness) * np.sin(angle) ** 2, rel=1e-6)


def test_turning_ring_meets_only_the_bearings_of_its_pins(system, evaluated):
    """A ring that turns as a rigid body has no heat; one that is drawn out at a rate e has n c (e p)^2 in its links."""
    chain, rate = system.tracks.chain, 3.0
    state, _ = _ring(chain, (0, 2))
    node = shoes(chain, state)[0]
    node[NodeOffset.VELOCITY], node[NodeOffset.VELOCITY + 2] = (
        rate * node[NodeOffset.PLACE + 2],
        -rate * node[NodeOffset.PLACE],
    )
    work, dissipation, _ = evaluated(chain, state)
    assert dissipation < 1e-9
    assert_allclose(
        np.linalg.norm(work[NodeWorkOffset.DIRECTION : NodeWorkOffset.DIRECTION + 3], axis=0), 1.0, rtol=1e-12
    )
    node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3] = rate * node[NodeOffset.PLACE : NodeOffset.PLACE + 3]
    _, dissipation, _ = evaluated(chain, state)
    assert dissipation == pytest.approx(chain.links[0] * chain.damping * (rate * chain.free_length[0]) ** 2, rel=1e-9)
