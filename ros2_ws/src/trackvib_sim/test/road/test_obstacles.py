"""Obstacles: their shapes by hand, on one side or both, on any road."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.road.obstacles import HalfRound, LevelRoad, ObstacleRoad, Pothole, Sine, Step, Trapezoid, VRamp

SHAPES = [
    (HalfRound(shape="half_round", at=10.0, radius=0.2), {0.0: 0.0, 0.1: np.sqrt(0.03), 0.2: 0.2, 0.4: 0.0}),
    (Step(shape="step", at=10.0, height=0.3, length=0.3), {-0.01: 0.0, 0.01: 0.3, 0.29: 0.3, 0.31: 0.0}),
    (VRamp(shape="v_ramp", at=10.0, height=0.2, length=2.0), {0.5: 0.1, 1.0: 0.2, 1.5: 0.1}),
    (Trapezoid(shape="trapezoid", at=10.0, height=0.2, length=3.0, ramp=1.0), {0.5: 0.1, 1.0: 0.2, 2.75: 0.05}),
    (Sine(shape="sine", at=10.0, height=0.1, wavelength=2.0, count=3), {1.0: 0.1, 0.5: 0.05, 5.0: 0.1, 7.0: 0.0}),
    (Pothole(shape="pothole", at=10.0, depth=0.2, length=1.0, ramp=0.2), {0.1: -0.1, 0.5: -0.2, 0.95: -0.05}),
]  # fmt: skip


@pytest.mark.analytic
@pytest.mark.parametrize(("obstacle", "heights"), SHAPES, ids=lambda each: getattr(each, "shape", None))
def test_shapes_by_hand(obstacle, heights):
    """Heights at some places from the beginning; nothing before and behind."""
    found = obstacle.heights(10.0 + np.array(list(heights)))
    assert_allclose(found, list(heights.values()), atol=1e-9)
    assert not obstacle.heights(np.array([0.0, 9.99, 10.01 + obstacle.end, 100.0])).any()


@pytest.mark.property
@pytest.mark.parametrize("obstacle", [shape for shape, _ in SHAPES], ids=lambda each: each.shape)
@given(side=st.sampled_from(["both", "left", "right"]), first=st.integers(800, 1300))
def test_they_stand_on_the_ground_of_their_side(obstacle, side, first):
    """The other side is the ground's to the last bit; patches fit together."""
    ground = Iso8608Road("C", 2, 0.0, 1.0)
    road = ObstacleRoad(ground, (obstacle.model_copy(update={"side": side}),))
    place, added = 0.05 * np.arange(first, first + 60), road.heights(first, 60) - ground.heights(first, 60)
    assert road.spacing == 0.05
    for row, name in enumerate(("left", "right")):
        assert_allclose(added[row], obstacle.heights(place) if side in ("both", name) else 0.0, atol=1e-12)
    assert_array_equal(road.heights(first, 60)[:, 20:], road.heights(first + 20, 40))


@pytest.mark.analytic
def test_overlapping_heights_add_up():
    """A step on a step."""
    step = Step(shape="step", at=1.0, height=0.1, length=1.0)
    road = ObstacleRoad(LevelRoad(0.01), (step, step))
    assert_allclose(road.heights(150, 1), 0.2)
    assert road.ends == pytest.approx(2.0) and road.begins == 0.0
