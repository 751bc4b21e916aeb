"""Shoes on the ground: what a road may do to a shoe, and what not."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from trackvib_sim.road.store import Road
from trackvib_sim.vehicle.drive.path import new_path
from trackvib_sim.vehicle.tracks.ground import add_ground, find_on_path, road_height
from trackvib_sim.vehicle.tracks.nodes import NodeOffset, NodeWorkOffset, new_node_work, new_nodes

from .momentum import shoes

SEEDS = st.integers(0, 2**32 - 1)
SPACING, DT = 0.05, 1e-4


@pytest.fixture(scope="module")
def shoe(system):
    """A function that returns the state and the work of one shoe: views (quantities, 1) and the cells behind them."""

    def make(place, velocity=(0.0, 0.0, 0.0)):
        chain = system.tracks.chain._replace(links=np.array([1, 1]))
        state, work = new_nodes()[0], new_node_work()[0]
        node = shoes(chain, state)
        node[NodeOffset.PLACE : NodeOffset.PLACE + 3, 0], node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 3, 0] = (
            place,
            velocity,
        )
        return state, work, node[:, 0], shoes(chain, work)[NodeWorkOffset.GROUND : NodeWorkOffset.GROUND + 3, 0]

    return make


def _press(ground, road, state, work):
    find_on_path(new_path(), state, 1, 2, work)
    return add_ground(ground, state, road.height[0], road.first, road.spacing, 1, 2, work, DT)


def _rough(seed, size=0.05):
    return Road(-20, SPACING, size * np.random.default_rng(seed).normal(size=(2, 41)))


@pytest.mark.property
@given(seed=SEEDS)
@example(seed=32159685)  # a lightly loaded shoe with much shear
def test_ground_pushes_and_shears_within_friction(system, shoe, seed):
    """Whatever place and speed: the normal force is no pull, friction at most its share of it, heat never negative."""
    random, road, ground = np.random.default_rng(seed), _rough(seed), system.tracks.ground
    x = random.uniform(-0.9, 0.9)
    height = road_height(road, 0, x)
    slope = (road_height(road, 0, x + 1e-6) - road_height(road, 0, x - 1e-6)) / 2e-6
    along = np.array([1.0, 0.0, slope]) / np.hypot(1.0, slope)
    up = np.array([-slope, 0.0, 1.0]) / np.hypot(1.0, slope)
    depth = random.uniform(-0.01, 0.03)
    state, work, node, force = shoe((x, 1.4, height - depth), 2.0 * random.normal(size=3))
    # what a shoe may bring along from the step before
    limit = ground.friction * ground.stiffness * 0.03 / ground.shear_stiffness
    node[NodeOffset.SHEAR : NodeOffset.SHEAR + 2] = limit / 2.0 * random.uniform(-1.0, 1.0, 2) if depth > 0.0 else 0.0
    dissipation, stored, touching = _press(ground, road, state, work)
    normal, shear = force @ up, np.hypot(force @ along, force[1])
    assert touching == (depth > 0.0)
    assert normal >= -1e-9 and (depth > 0.0 or not force.any())
    assert shear <= ground.friction * normal * (1.0 + 1e-9) + 1e-6
    assert dissipation >= -1e-6 * (1.0 + np.abs(force).max()) and stored >= 0.0
    if normal == 0.0:
        # without load the shoe lets its shear go, but for what the damper of the soil gives back
        assert np.abs(force).max() < 1e-6


@pytest.mark.analytic
def test_shoe_stands_on_its_spring_and_slides_at_its_limit(system, shoe):
    """At rest at a depth d a shoe is pushed by k d; dragged along it is held by k_s s + c_s v, up to mu k d."""
    ground, depth, speed = system.tracks.ground, 0.002, 0.3
    road = Road(-20, SPACING, np.zeros((2, 41)))
    state, work, node, force = shoe((0.1, 1.4, -depth))
    _, stored, _ = _press(ground, road, state, work)
    assert_allclose(force, (0.0, 0.0, ground.stiffness * depth), rtol=1e-12)
    assert stored == pytest.approx(0.5 * ground.stiffness * depth**2)
    node[NodeOffset.VELOCITY] = speed
    limit, slid = ground.friction * ground.stiffness * depth, 0.0
    for _ in range(round(4.0 * limit / ground.shear_stiffness / (speed * DT))):
        dissipation, stored, _ = _press(ground, road, state, work)
        slid += speed * DT
        held = min(ground.shear_stiffness * slid + ground.shear_damping * speed, limit)
        assert_allclose(force, (-held, 0.0, ground.stiffness * depth), rtol=1e-9, atol=1e-9)
    assert slid * ground.shear_stiffness > 2.0 * limit
    # all the power of the sliding shoe turns into heat
    assert dissipation == pytest.approx(limit * speed, rel=1e-9)
    node[NodeOffset.PLACE + 2] = 0.001
    dissipation, stored, touching = _press(ground, road, state, work)
    assert not force.any() and stored == 0.0 and touching == 0.0
    left = limit / ground.shear_stiffness  # the soil itself does not move any more while the shoe slides
    assert dissipation * DT == pytest.approx(0.5 * ground.shear_stiffness * left**2, rel=1e-9)


@pytest.mark.analytic
@given(seed=SEEDS)
def test_ground_without_springs_is_viscous_up_to_friction(system, shoe, seed):
    """Against the motion by c_s v, up to mu k d; all of that power is heat, and no shear is kept."""
    random, depth = np.random.default_rng(seed), 0.002
    ground = system.tracks.ground._replace(shear_stiffness=0.0)
    road, limit = Road(-20, SPACING, np.zeros((2, 41))), ground.friction * ground.stiffness * depth
    state, work, node, force = shoe((0.1, 1.4, -depth))
    for _ in range(5):
        # from creeping to sliding, to and fro
        velocity = 10.0 ** random.uniform(-3.0, 1.0) * limit / ground.shear_damping * random.uniform(-1.0, 1.0, 2)
        node[NodeOffset.VELOCITY : NodeOffset.VELOCITY + 2] = velocity
        dissipation, stored, _ = _press(ground, road, state, work)
        viscous = ground.shear_damping * velocity
        held = viscous * min(1.0, limit / np.hypot(*viscous))
        assert_allclose(force[:2], -held, rtol=1e-9)
        assert dissipation == pytest.approx(held @ velocity, rel=1e-9)
        assert stored == pytest.approx(0.5 * ground.stiffness * depth**2)
        assert not node[NodeOffset.SHEAR : NodeOffset.SHEAR + 2].any()


@pytest.mark.property
@settings(max_examples=30)
@given(seed=SEEDS)
def test_shoe_sees_the_road_between_its_samples(system, shoe, seed):
    """The depth is that under the straight line between two samples: it has no steps where they meet."""
    road, ground = _rough(seed, size=0.005), system.tracks.ground
    place = np.linspace(-0.9, 0.9, 181)
    expected = np.interp(place, SPACING * np.arange(-20, 21), road.height[0])
    push = np.zeros(len(place))
    for i, x in enumerate(place):
        assert road_height(road, 0, x) == pytest.approx(expected[i], abs=1e-12)
        state, work, _, force = shoe((x, 0.0, expected[i] - 0.003))
        _press(ground, road, state, work)
        push[i] = np.linalg.norm(force)
    slope = np.abs(np.diff(road.height[0])).max() / SPACING
    assert_allclose(push, ground.stiffness * 0.003, rtol=0.5 * slope**2 + 1e-6)
