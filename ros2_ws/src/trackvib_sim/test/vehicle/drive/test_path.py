"""The path in the plane: arcs of the wanted curvature, and which of its points is nearest."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trackvib_sim.vehicle.drive.path import (
    SAMPLES,
    SPACING,
    follow_path,
    new_path,
    path_distance,
    path_heading,
    path_is_left,
    path_point,
)
from trackvib_sim.vehicle.drive.schedule import Schedule, new_wanted


def laid(at, curvature, length):
    """A path of some length [m] with a curvature over distance."""
    at = np.array(at, dtype=float)
    schedule = Schedule(True, at, np.ones(len(at)), np.array(curvature, dtype=float), np.zeros(len(at)))
    path = new_path()
    follow_path(path, schedule, new_wanted(schedule), 0.0, 0.0, length)
    return path


@pytest.mark.analytic
@pytest.mark.parametrize("radius", [-20.0, 10.0, 30.0])
def test_constant_curvature_makes_a_circle(radius):
    """After the curvature has grown, all points lie on one circle, and a whole turn leads back to where it began."""
    path = laid([0.0], [1.0 / radius], 10.0 + 2.0 * np.pi * abs(radius))
    begin = path_point(path, 8.0)
    centre = np.array(begin[:2]) + radius * np.array([-begin[3], begin[2]])
    for distance in np.linspace(8.0, 8.0 + 2.0 * np.pi * abs(radius), 50):
        x, y, tx, ty, curvature = path_point(path, distance)
        assert np.hypot(x - centre[0], y - centre[1]) == pytest.approx(abs(radius), abs=2e-6)
        assert np.hypot(tx, ty) == pytest.approx(1.0) and curvature == pytest.approx(1.0 / radius)
    np.testing.assert_allclose(path_point(path, 8.0 + 2.0 * np.pi * abs(radius))[:2], begin[:2], atol=1e-4)


@pytest.mark.analytic
def test_a_path_is_continuous_in_place_and_direction():
    """From one arc to the next, also where curvature changes fastest, to a micrometre and a microradian."""
    path = laid([0.0, 5.0, 5.1, 20.0], [0.0, 0.0, 0.1, -0.1], 40.0)
    for k in range(1, 190):
        before, behind = (np.array(path_point(path, k * SPACING + side)) for side in (-1e-9, 1e-9))
        np.testing.assert_allclose(before[:4], behind[:4], atol=1e-6)


@pytest.mark.property
@given(along=st.floats(1.0, 38.0), left=st.floats(-3.0, 3.0), off=st.floats(-1.0, 1.0))
@settings(max_examples=200)
def test_the_nearest_point_is_found(along, left, off):
    """A place beside the path, given by distance and offset, is found again from a guess a metre away."""
    path = laid([0.0, 5.0, 12.0, 30.0], [0.0, 0.05, -0.08, 0.1], 40.0)
    x, y, tx, ty, _ = path_point(path, along)
    found = path_distance(path, x - left * ty, y + left * tx, along + off)
    assert found == pytest.approx(along, abs=2e-6)


@pytest.mark.property
def test_straight_on_the_distance_is_x_to_the_last_bit():
    """Whatever the guess; heading and curvature are zero."""
    path = laid([0.0], [0.0], 30.0)
    for x in (-3.7, 0.1, 12.345678901234567):
        assert path_distance(path, x, 5.0, 99.0) == x
    assert path_heading(path) == (0.0, 0.0) and not path.curved[0]


@pytest.mark.property
def test_what_is_left_behind_is_forgotten():
    """A long way on, the latest 200 m are kept; whoever goes back further has left the path, as has one far beside."""
    schedule = Schedule(True, np.zeros(1), np.ones(1), np.full(1, 0.001), np.zeros(1))
    path, wanted = new_path(), new_wanted(schedule)
    for distance in np.arange(0.0, 500.0, 2.0):
        x, y, *_ = path_point(path, distance)
        follow_path(path, schedule, wanted, x, y, 5.0)
        assert path.distance[0] == pytest.approx(distance, abs=1e-6) and abs(path.offset[0]) < 1e-6
    assert not path_is_left(path, 5.0)
    path.distance[0] -= SAMPLES * SPACING
    assert path_is_left(path, 5.0)
    path.distance[0] += SAMPLES * SPACING
    path.offset[0] = -3.1
    assert path_is_left(path, 5.0)
