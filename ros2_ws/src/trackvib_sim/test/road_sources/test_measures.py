"""What a road is like: classes found again, the roughness index against its definition."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.road.classes import CLASSES
from trackvib_sim.road.iso8608 import Iso8608Road, Roughness
from trackvib_sim.road_sources.measures import measures, psd, roughness_index

SPACING = 0.05


@pytest.mark.slow(reason="superposes long roads")
@pytest.mark.analytic
@pytest.mark.parametrize("road_class", CLASSES)
def test_a_class_is_found_again(road_class):
    """Of 2 km: the class, its level to a factor of 1.5, its waviness to 0.15."""
    left, right = Iso8608Road(road_class, 3, -10.0, 1.0).heights(0, 40_000)
    for side in (left, right):
        found = measures(side, SPACING)
        assert found.road_class == road_class
        assert found.waviness == pytest.approx(2.0, abs=0.15)


@pytest.mark.slow(reason="superposes long roads")
@pytest.mark.analytic
@pytest.mark.parametrize("waviness", [1.5, 2.0, 2.5, 3.0])
def test_a_roughness_of_ones_own_is_found_again(waviness):
    """PSD of a synthesised road of any waviness along its line: level to 30 %, waviness to 0.15."""
    given = Roughness(1e-4, waviness)
    left, _ = Iso8608Road(given, 5, -10.0, 1.0).heights(0, 40_000)
    found = measures(left, SPACING)
    assert found.waviness == pytest.approx(waviness, abs=0.15)
    frequency, density = psd(left, SPACING)
    inside = (frequency > 0.05) & (frequency < 1.5)
    assert np.mean(density[inside] / given.psd(frequency[inside])) == pytest.approx(1.0, abs=0.1)


@pytest.mark.slow(reason="long roads")
@pytest.mark.literature
def test_roughness_index_by_its_gain():
    """A sine of slope amplitude 1e-3 has 1e-3 times the golden car's gain: 1.5 near 15 m, by its equations of motion.

    [Sayers1995] draws the gain; here it is solved in the frequency domain, for waves of 2 to 40 m.
    """
    k1, k2, c, mu, v = 653.0, 63.3, 6.0, 0.15, 80.0 / 3.6
    for length in (2.0, 5.0, 15.0, 40.0):
        w = 2.0 * np.pi * v / length
        matrix = np.array([[-(w**2) + 1j * w * c + k2, -1j * w * c - k2],
                           [-1j * w * c - k2, -mu * w**2 + 1j * w * c + k1 + k2]])  # fmt: skip
        sprung, unsprung = np.linalg.solve(matrix, [0.0, k1])
        gain = abs(sprung - unsprung)
        wave = 1e-3 * length / (2.0 * np.pi) * np.sin(2.0 * np.pi * np.arange(0.0, 2000.0, SPACING) / length)
        averaged = np.sinc(0.25 / length)  # by the tyre's contact
        assert roughness_index(wave, SPACING) == pytest.approx(gain * averaged * 2.0 / np.pi, rel=0.02)


@pytest.mark.property
def test_short_and_level_roads_have_what_they_have():
    """No index of ten metres, no class of a level road, no index but zero there."""
    assert np.isnan(roughness_index(np.zeros(200), SPACING))
    found = measures(np.zeros(4000), SPACING)
    assert (found.rms, found.iri, found.road_class) == (0.0, 0.0, "") and np.isnan(found.level)
    assert_allclose(measures(np.full(4000, 3.0), SPACING).rms, 0.0, atol=1e-12)
