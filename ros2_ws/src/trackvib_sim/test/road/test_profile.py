"""Profiles: what is refused, what is taken as it is, what is resampled, reversed, repeated."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from trackvib_sim.road.profile import FINEST, Profile, ProfileError, ProfileRoad, checked

EVEN = np.arange(0.0, 10.0, 0.05)
RANDOM = np.random.default_rng(1).normal(scale=0.01, size=(2, len(EVEN)))
WAVES = Profile(EVEN, RANDOM - RANDOM[:, :1])


@pytest.mark.property
@given(first=st.integers(-500, 500), start=st.integers(-100, 100))
def test_even_samples_are_taken_as_they_are(first, start):
    """To the last bit where the profile is; level at its ends' heights elsewhere."""
    road = ProfileRoad(WAVES, start=0.05 * start)
    assert road.even and road.spacing == 0.05
    heights, index = road.heights(first, 40), np.arange(first, first + 40) - start
    assert_array_equal(heights, WAVES.heights[:, np.clip(index, 0, len(EVEN) - 1)])
    assert (road.begins, road.ends) == (0.05 * start, pytest.approx(0.05 * start + 9.95))


@pytest.mark.analytic
def test_uneven_samples_are_interpolated():
    """A straight slope stays one, at the least distance between the samples."""
    distance = np.cumsum([0.0, 0.3, 0.1, 0.5, 0.2, 0.4])
    road = ProfileRoad(checked(distance, np.stack((0.1 * distance, -0.2 * distance)), "slope"))
    assert not road.even and road.spacing == pytest.approx(0.1)
    place = road.spacing * np.arange(15)
    assert_allclose(road.heights(0, 15), [0.1 * place, -0.2 * place], atol=1e-12)


@pytest.mark.property
@given(count=st.integers(3, 20_000), odd=st.integers(1, 10_000), shift=st.floats(0.01, 0.9))
def test_one_sample_off_its_place_is_uneven(count, odd, shift):
    """However long the profile is; the other samples are where they were."""
    distance = 0.05 * np.arange(count)
    distance[1 + odd % (count - 2)] += 0.05 * shift
    road = ProfileRoad(checked(distance, np.zeros((2, count)), "mine"))
    assert not road.even and road.spacing == pytest.approx(0.05 * (1.0 - shift))


@pytest.mark.property
def test_a_wall_is_ground():
    """A face of 1 m over a millimetre, as a vehicle may climb it; the same as a step of that height."""
    distance = 1e-3 * np.arange(4000)
    heights = np.tile(np.where(distance > 2.0, 1.0, 0.0), (2, 1))
    assert_array_equal(checked(distance, heights, "wall").heights, heights)


@pytest.mark.analytic
def test_samples_closer_than_a_millimetre_are_thinned():
    """No road has finer samples than its patches may have."""
    distance = np.arange(0.0, 1.0, 1e-4)
    road = ProfileRoad(checked(distance, np.zeros((2, len(distance))), "fine"))
    assert road.spacing == FINEST


@pytest.mark.analytic
def test_reversed_it_begins_with_its_end():
    """Left stays left; each side begins at height zero."""
    road = ProfileRoad(WAVES, reverse=True)
    assert_allclose(road.heights(0, len(EVEN)), WAVES.heights[:, ::-1] - WAVES.heights[:, -1:], atol=1e-15)


@pytest.mark.analytic
def test_repeated_it_has_no_joint():
    """A slope with waves goes on without end as waves alone, the last sample being the first of the next round."""
    slope = Profile(EVEN, WAVES.heights + 0.1 * EVEN)
    road, period = ProfileRoad(slope, repeat=True), len(EVEN) - 1
    assert road.ends == np.inf
    assert_array_equal(road.heights(0, period), road.heights(7 * period, period))
    assert_array_equal(road.heights(-period, period), road.heights(0, period))
    assert_allclose(road.heights(period, 1), 0.0, atol=1e-12)


@pytest.mark.property
@pytest.mark.parametrize(
    ("distance", "heights", "words"),
    [
        ([0.0], [[0.0]] * 2, "1 samples, accepted: 2 to"),
        ([0.0, 1.0], [[0.0, np.nan], [0.0, 0.0]], "left height of sample 2 is nan"),
        ([0.0, np.inf], [[0.0, 0.0]] * 2, "distance of sample 2 is inf"),
        ([0.0, 0.5, 0.4], [[0.0] * 3] * 2, "distance goes from 0.5 to 0.4 m at sample 3, must rise"),
        ([0.0, 0.5, 0.5], [[0.0] * 3] * 2, "from 0.5 to 0.5 m at sample 3"),
        ([0.0, 0.5, 3.0], [[0.0] * 3] * 2, "a gap of 2.5 m from 0.5 m on, accepted: up to 1 m"),
        ([0.0, 0.5], [[0.0, 0.0], [0.0, 2000.0]], "right is 2000 m high"),
        (
            0.05 * np.arange(40),
            np.tile([0.0, 0.3], (2, 20)),
            "left goes up and down by 6 m per metre.*is the unit right",
        ),
        (
            np.append(np.arange(30_000.0), 29_999.001),
            np.zeros((2, 30_001)),
            "are 29999002 samples at the least distance",
        ),
        ([0.0, 1e-9], [[0.0, 0.0]] * 2, "are 1 samples at the least distance"),
        ([-1e308, 1e308], [[0.0, 0.0]] * 2, "a gap of inf m"),
        ([0.0, 0.1], [[0.0, 50.0], [0.0, 0.0]], "left rises by 50 m from 0 m on over 0.1 m.*is the unit right?"),
    ],
)
def test_what_cannot_be_driven_on_is_refused(distance, heights, words):
    """With the item, its value and what is accepted."""
    with pytest.raises(ProfileError, match=f"^mine: .*{words}"):
        checked(distance, heights, "mine")
