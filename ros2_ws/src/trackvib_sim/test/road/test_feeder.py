"""Patches handed out ahead of the vehicle."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from trackvib_sim.road.feeder import BEHIND, LENGTH, RoadFeeder
from trackvib_sim.road.iso8608 import SPACING, Iso8608Road
from trackvib_sim.road.store import RoadStore

REACH = 3.2  # m before and behind that a vehicle asks for
STEPS = st.lists(st.floats(0.0, 30.0), min_size=1, max_size=12)


@pytest.fixture(scope="module")
def road():
    """A rough road."""
    return Iso8608Road("E", 1, 8.0, 8.0)


@pytest.mark.property
@given(start=st.floats(-100.0, 1000.0), steps=STEPS, horizon=st.floats(10.0, 60.0))
def test_vehicle_always_has_the_road_around_it(level, start, steps, horizon):
    """Wherever a vehicle goes forward, what it was fed reaches around it and ahead to the horizon, no patch twice."""
    feeder, store, starts, distance = RoadFeeder(level, horizon), RoadStore(), [], start
    for step in steps:
        distance += step
        for first, spacing, heights in feeder.patches(distance):
            store.add(first, spacing, *heights)
            starts.append(first)
        assert store.around(distance - REACH, distance + horizon - 2 * SPACING) is not None
    assert len(set(starts)) == len(starts)
    assert starts == sorted(starts)


@pytest.mark.property
@pytest.mark.parametrize("spacing", [SPACING, 0.01, 0.3])
def test_patches_are_the_road(spacing):
    """Patches follow each other without gap from BEHIND the vehicle, and hold the road's own samples."""
    road = Iso8608Road("E", 1, 8.0, 8.0, spacing=spacing)
    patches, patch = list(RoadFeeder(road, 50.0).patches(12.0)), round(LENGTH / spacing)
    assert patches[0][0] <= 12.0 - BEHIND < patches[1][0]
    assert patches[-1][0] < 62.0 <= patches[-1][0] + patch * spacing
    for k, (start, told, heights) in enumerate(patches):
        first = round(patches[0][0] / spacing) + k * patch
        assert told == spacing and start == pytest.approx(first * spacing, abs=1e-9)
        assert_array_equal(heights, road.heights(first, patch))


@pytest.mark.property
def test_nothing_new_while_the_vehicle_stands(level):
    """Asked again at the same place, a feeder has nothing more to give."""
    feeder = RoadFeeder(level, 50.0)
    assert len(list(feeder.patches(0.0))) > 0
    assert list(feeder.patches(0.0)) == []


@pytest.mark.property
@given(far=st.floats(0.0, 300.0), away=st.one_of(st.floats(-500.0, -15.0), st.floats(75.0, 500.0)))
def test_vehicle_that_jumps_is_fed_anew(level, far, away):
    """After a jump back or beyond the horizon, a fresh store gets all that it needs around the new place.

    15 m back are the patches that a vehicle may go back, rounded up; 75 m are horizon and road behind, rounded up.
    """
    feeder, store = RoadFeeder(level, 50.0), RoadStore()
    for part in range(11):
        list(feeder.patches(0.1 * part * far))
    for first, spacing, heights in feeder.patches(far + away):
        store.add(first, spacing, *heights)
    assert store.around(far + away - REACH, far + away + REACH) is not None


@pytest.mark.property
@given(back=st.floats(0.0, 10.0))
def test_vehicle_that_rolls_back_a_little_has_its_road(level, back):
    """Ten metres back from the furthest place, the road is still there without being fed twice."""
    feeder, store = RoadFeeder(level, 50.0), RoadStore()
    for distance in (0.0, 40.0, 80.0, 80.0 - back):
        patches = list(feeder.patches(distance))
        for first, spacing, heights in patches:
            store.add(first, spacing, *heights)
        assert store.around(distance - REACH, distance + REACH) is not None
    assert patches == []
