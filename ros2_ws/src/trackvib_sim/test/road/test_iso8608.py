"""Random roads of ISO 8608: the standard's numbers, statistics of the profile, and its reproducibility."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy import signal
from trackvib_sim.road.classes import CLASSES
from trackvib_sim.road.iso8608 import SPACING, Exponential, Iso8608Road, Isotropic, roughness_of

LENGTH = 20_000  # samples, 1 km
SEEDS = range(5)
OCTAVES = [(0.03 * 2.0**k, 0.06 * 2.0**k) for k in range(6)]  # 1/m, up to 1.92


COHERENCES = [Isotropic(), Isotropic(1.0), Exponential(1.4)]


@cache
def spectra(coherence=COHERENCES[0]):
    """Frequencies and the averaged PSDs of left and right and their cross PSD, class C, over all seeds."""
    parts = []
    for seed in SEEDS:
        left, right = Iso8608Road("C", seed, -10.0, 1.0, coherence).heights(0, LENGTH)
        options = {"fs": 1.0 / SPACING, "nperseg": 4000}  # 200 m: bins of 0.005 1/m
        frequency, ll = signal.welch(left, **options)
        parts.append((ll, signal.welch(right, **options)[1], signal.csd(left, right, **options)[1]))
    return frequency, *np.mean(parts, axis=0)


def spread(low, high):
    """Standard deviation of a band's mean PSD, relative: a band B of a random signal of length L has 2 B L numbers.

    A mean of squares of n normal numbers has sqrt(2 / n).
    """
    return 1.0 / np.sqrt((high - low) * LENGTH * SPACING * len(SEEDS))


@pytest.mark.literature
def test_class_means_are_the_standards():
    """At 0.1 1/m the geometric means are 16, 64, 256 ... 1e-6 m^3, and the PSD falls with the square of n."""
    means = [16e-6, 64e-6, 256e-6, 1024e-6, 4096e-6, 16384e-6, 65536e-6, 262144e-6]
    assert [float(roughness_of(c).psd(0.1)) for c in CLASSES] == pytest.approx(means, rel=1e-14)
    assert "".join(CLASSES) == "ABCDEFGH"
    assert roughness_of("D").psd(1.0) == pytest.approx(roughness_of("D").psd(0.1) / 100.0, rel=1e-14)


@pytest.mark.slow(reason="sums the power of long roads")
@pytest.mark.analytic
@pytest.mark.parametrize(("low", "high"), OCTAVES)
def test_octaves_have_the_power_of_the_class(low, high):
    """In every octave the profiles' power over 5 km is that of the class, left and right.

    Bound: four standard deviations of the estimate (29 % in the lowest octave, 6 % in the highest), and 5 % for the
    window's leakage down the slope of the spectrum.
    """
    frequency, ll, rr, _ = spectra()
    band = (frequency >= low) & (frequency < high)
    expected = roughness_of("C").psd(frequency[band]).mean()
    for side in (ll, rr):
        assert side[band].mean() == pytest.approx(expected, rel=4.0 * spread(low, high) + 0.05)


@pytest.mark.slow(reason="averages long roads")
@pytest.mark.analytic
@pytest.mark.parametrize("coherence", COHERENCES, ids=str)
@pytest.mark.parametrize(("low", "high"), OCTAVES)
def test_left_and_right_are_coherent_as_stated(low, high, coherence):
    """In every octave the cross spectrum over the power is as stated, real.

    Bound: four standard deviations of a cross spectrum of signals of equal power, and 5 % for leakage.
    """
    frequency, ll, rr, lr = spectra(coherence)
    band = (frequency >= low) & (frequency < high)
    weight = roughness_of("C").psd(frequency[band])
    expected = np.sum(weight * coherence(frequency[band])) / np.sum(weight)
    got = lr[band].sum() / np.sqrt(ll[band].sum() * rr[band].sum())
    bound = 4.0 * spread(low, high) + 0.05
    assert got.real == pytest.approx(expected, abs=bound)
    assert got.imag == pytest.approx(0.0, abs=bound)


@pytest.mark.literature
def test_isotropic_coherence_is_that_of_a_surface():
    """x K1(x) at x = 1 and 2 as tabulated (Abramowitz and Stegun, table 9.8), 1 on one line, 0 far away."""
    distance = 2.8
    found = Isotropic(distance)(np.array([1.0, 2.0]) / (2.0 * np.pi * distance))
    assert_allclose(found, [0.60190723, 2.0 * 0.13986588], rtol=1e-7)
    assert Isotropic(0.0)(np.geomspace(0.01, 10.0, 5)).tolist() == [1.0] * 5
    assert Isotropic(100.0)(1.0) < 1e-200


@pytest.mark.property
@settings(max_examples=20)
@given(
    seed=st.integers(0, 2**31 - 1),
    first=st.integers(-2000, 200_000),
    cuts=st.lists(st.integers(1, 60), min_size=1, max_size=6),
)
def test_heights_do_not_depend_on_the_cut(seed, first, cuts):
    """However a stretch is cut into patches, every sample is the same to the last bit."""
    road = Iso8608Road("E", seed, 8.0, 8.0)
    whole, start, pieces = road.heights(first, sum(cuts)), first, []
    for count in cuts:
        pieces.append(Iso8608Road("E", seed, 8.0, 8.0).heights(start, count))
        start += count
    assert_array_equal(whole.view(np.uint64), np.concatenate(pieces, axis=1).view(np.uint64))


@pytest.mark.property
def test_seed_makes_the_road():
    """The same seed gives the same road, another seed another one, and the sides differ."""
    one, again, other = (Iso8608Road("B", seed, 0.0, 1.0).heights(1000, 500) for seed in (1, 1, 2))
    assert_array_equal(one, again)
    assert np.abs(one - other).max() > 1e-3
    assert np.abs(one[0] - one[1]).max() > 1e-4


@pytest.mark.analytic
def test_classes_differ_by_a_factor_of_two():
    """With one seed, each class is the one before with its heights doubled."""
    roads = [Iso8608Road(c, 7, 0.0, 1.0).heights(1000, 200) for c in CLASSES]
    for smooth, rough in zip(roads, roads[1:], strict=False):
        assert np.abs(rough - 2.0 * smooth).max() < 1e-12 * np.abs(rough).max()


@pytest.mark.analytic
def test_road_starts_level_and_fades_in():
    """Level up to level_until, a raised-cosine share of the full road over the fade, all of it beyond."""
    full = Iso8608Road("E", 3, -1000.0, 1.0).heights(0, 600)
    faded = Iso8608Road("E", 3, 8.0, 8.0).heights(0, 600)
    distance = SPACING * np.arange(600)
    share = 0.5 - 0.5 * np.cos(np.pi * np.clip((distance - 8.0) / 8.0, 0.0, 1.0))
    assert not faded[:, distance <= 8.0].any()
    assert_array_equal(faded[:, distance >= 16.0], full[:, distance >= 16.0])
    assert np.abs(faded - share * full).max() < 1e-15


@pytest.mark.property
def test_road_has_no_short_period():
    """A road does not come back after a kilometre, the reciprocal of no step of its frequencies."""
    road = Iso8608Road("E", 1, -10.0, 1.0)
    near, far = road.heights(0, 2000)[0], road.heights(20_000, 2000)[0]
    assert abs(np.corrcoef(near - near.mean(), far - far.mean())[0, 1]) < 0.9


@pytest.mark.analytic
@pytest.mark.parametrize("first", [1000, 20_000_000, 2_000_000_000])
def test_heights_are_the_sum_of_their_harmonics(first):
    """As numpy sums cosines with phases, near the start and 100 000 km away.

    Bound: the rounding of the sum, and that of angles of so many radians, which moves the profile along its slope.
    """
    road = Iso8608Road("E", 5, -1000.0, 1.0)
    frequency, parts = road._harmonics
    heights, distance = road.heights(first, 50), road.spacing * np.arange(first, first + 50)
    for side, (cosine, sine) in zip(heights, parts, strict=True):
        angle = np.multiply.outer(distance, frequency) + np.arctan2(sine, cosine)
        rounding = 4.0 * np.finfo(float).eps * (1.0 + np.abs(angle).max())
        expected = np.cos(angle) @ np.hypot(cosine, sine)
        assert np.abs(side - expected).max() < rounding * np.hypot(cosine, sine).sum()
