"""The stretch of road that patches form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from trackvib_sim.road.store import KEPT_BEHIND, RoadStore

SPACING = 0.05
WHOLE = np.random.default_rng(5).normal(size=(2, 2000))  # samples -1000 ... 999


def put(store, first, count):
    """Add samples of the whole road to a store."""
    store.add(first * SPACING, SPACING, *WHOLE[:, first + 1000 : first + 1000 + count])


@pytest.mark.property
@given(data=st.data())
def test_any_patches_without_gap_form_the_road(data):
    """Whatever the cut, the order and the overlaps of patches, the stretch is the road itself."""
    cuts = sorted(data.draw(st.sets(st.integers(-900, 890), max_size=8)))
    edges = [-1000, *cuts, 1000]
    patches = [
        (first, min(end + data.draw(st.integers(0, 30)), 1000) - first)
        for first, end in zip(edges, edges[1:], strict=False)
        if end - first >= 2
    ]
    store = RoadStore()
    for first, count in data.draw(st.permutations(patches)):
        put(store, first, count)
    rear, front = sorted(data.draw(st.tuples(st.floats(-44.0, 44.0), st.floats(-44.0, 44.0))))
    road = store.around(rear, front)
    assert road.first * SPACING <= rear
    assert front < (road.first + road.height.shape[1] - 1) * SPACING
    first = road.first + 1000
    assert_array_equal(road.height, WHOLE[:, first : first + road.height.shape[1]])


@pytest.mark.property
@given(rear=st.floats(-30.0, 30.0), length=st.floats(0.0, 15.0), hole=st.integers(-700, 700), width=st.integers(1, 9))
def test_a_gap_is_never_bridged(rear, length, hole, width):
    """Where a sample between rear and front is missing there is no road; elsewhere there is."""
    store = RoadStore()
    put(store, -1000, hole + 1000)
    put(store, hole + width, 1000 - hole - width)
    road = store.around(rear, rear + length)
    # samples hole ... hole + width - 1 are missing
    touches = rear + length >= (hole - 1) * SPACING and rear < (hole + width) * SPACING
    assert (road is None) == touches


@pytest.mark.property
def test_missing_road_comes_with_the_next_patch():
    """A store that could not serve a place serves it once the patch is there."""
    store = RoadStore()
    assert store.around(0.0, 1.0) is None
    put(store, 0, 20)
    assert store.around(0.0, 1.0) is None
    put(store, 20, 20)
    assert store.around(0.0, 1.0).height.shape == (2, 40)


@pytest.mark.property
def test_road_a_little_behind_is_still_there():
    """A vehicle that goes back to patches that are kept gets them at once."""
    store = RoadStore()
    for first in range(0, 400, 100):
        put(store, first, 100)
    assert store.around(11.0, 12.0).first == 200
    assert store.around(6.0, 12.0).first == 100


@pytest.mark.property
@pytest.mark.parametrize("way", [1, -1])
def test_road_far_behind_is_forgotten(way):
    """Along a long road, driven forwards or backwards, a store holds what is around the vehicle and kept behind it."""
    store = RoadStore()
    store.add(0.0, SPACING, *np.zeros((2, 100)))
    for k in range(way, way * 200, way):
        store.add(5.0 * k, SPACING, *np.zeros((2, 100)))
        road = store.around(5.0 * k + 2.5 - way * 2.5 - 0.1, 5.0 * k + 2.5 - way * 2.5 + 0.1)
        assert road.height.shape[1] * SPACING < KEPT_BEHIND + 20.0
    assert store.around(1.0, 2.0) is None


@pytest.mark.property
def test_road_at_hand_is_there_for_both_ways():
    """All road of a run, held before it begins, is kept on the side to which it goes."""
    for places in (range(0, 100, 5), range(0, -100, -5)):
        store = RoadStore()
        for k in range(-25, 25):
            store.add(5.0 * k, SPACING, *np.zeros((2, 100)))
        assert all(store.around(place - 3.0, place + 3.0) is not None for place in places)


@pytest.mark.property
@pytest.mark.parametrize(
    ("start", "spacing", "left", "right", "words"),
    [
        (0.0, 0.05, [0.0], [0.0], ("left has 1 samples and right 1", "at least 2")),
        (0.0, 0.05, [0.0, 1.0, 2.0], [0.0, 1.0], ("left has 3 samples and right 2", "equal numbers")),
        (0.0, 0.0, [0.0, 1.0], [0.0, 1.0], ("spacing is 0.0 m", "0.001 to 100.0 m")),
        (0.0, -0.1, [0.0, 1.0], [0.0, 1.0], ("spacing is -0.1 m", "0.001 to 100.0 m")),
        (0.0, float("nan"), [0.0, 1.0], [0.0, 1.0], ("spacing is nan m", "0.001 to 100.0 m")),
        (0.0, float("inf"), [0.0, 1.0], [0.0, 1.0], ("spacing is inf m", "0.001 to 100.0 m")),
        (0.0, 0.1, [0.0, 1.0], [0.0, 1.0], ("spacing is 0.1 m", "0.05 m as of the road before")),
        (0.0, 0.05, [0.0, float("nan")], [0.0, 1.0], ("not finite",)),
        (0.0, 0.05, [0.0, 1.0], [0.0, float("inf")], ("not finite",)),
        (0.02, 0.05, [0.0, 1.0], [0.0, 1.0], ("start is 0.02 m", "multiple of the spacing 0.05 m")),
        (float("nan"), 0.05, [0.0, 1.0], [0.0, 1.0], ("start is nan m", "multiple")),
        (float("inf"), 0.05, [0.0, 1.0], [0.0, 1.0], ("start is inf m", "multiple")),
    ],
)
def test_bad_patches_are_refused_and_leave_no_trace(start, spacing, left, right, words):
    """A patch that cannot be used is refused with item, value and what is accepted, and the road stays as it was."""
    store = RoadStore()
    put(store, -20, 60)
    before = store.around(-0.5, 0.5).height.copy()
    with pytest.raises(ValueError) as refused:
        store.add(start, spacing, left, right)
    for word in words:
        assert word in str(refused.value)
    assert_array_equal(store.around(-0.5, 0.5).height, before)


@pytest.mark.property
def test_refused_first_patch_does_not_fix_the_spacing():
    """A store whose first patch was refused takes any spacing afterwards."""
    store = RoadStore()
    with pytest.raises(ValueError, match="not finite"):
        store.add(0.0, 0.1, [0.0, np.nan], [0.0, 0.0])
    put(store, 0, 10)
    assert store.around(0.0, 0.2) is not None


@pytest.mark.property
@pytest.mark.parametrize("count", [2, 2000])
def test_a_patch_of_another_spacing_does_not_fix_it(count):
    """Whichever comes first, the road is the one that reaches the vehicle; from then on it is the only one."""
    for others_first in (True, False):
        store = RoadStore()
        for other in (others_first, not others_first):
            if other:
                store.add(-20.0, 0.01, np.zeros(count), np.zeros(count))
            else:
                put(store, -1000, 2000)
        assert store.around(0.5, 5.0).spacing == SPACING
        with pytest.raises(ValueError, match="spacing is 0.01 m, must be 0.05 m as of the road before"):
            store.add(-20.0, 0.01, np.zeros(count), np.zeros(count))


@pytest.mark.property
def test_a_flood_of_patches_is_bounded():
    """Road far ahead, which nobody will forget, is taken up to a limit; what is driven on stays."""
    store, many = RoadStore(), np.zeros(5_000_000)
    put(store, -1000, 2000)
    with pytest.raises(ValueError, match="samples are already held, 5000000 more exceed 20000000"):
        for k in range(1, 5):
            store.add(k * 1e6, SPACING, many, many)
    assert store.around(-1.0, 5.0).height.shape[1] == 2000
