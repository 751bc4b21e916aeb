"""Patches of road from a bag come back as they came."""

import numpy as np
import pytest
from trackvib_sim.bags.road_patches import RoadPatches

pytestmark = pytest.mark.property


def test_patches_come_back_in_their_order():
    """To the bit, whatever the lengths of their sides, and again after more have come."""
    random = np.random.default_rng(1)
    given = [(k, 0.05, random.normal(size=left), random.normal(size=right))
             for k, (left, right) in enumerate([(20, 20), (0, 0), (3, 5), (200, 200)])]  # fmt: skip
    patches = RoadPatches()
    assert len(patches) == 0 and list(patches) == []
    for count, patch in enumerate(given, 1):
        patches.add(*patch)
        assert len(patches) == count
        for (start, spacing, *heights), found in zip(given, patches, strict=False):
            assert found[:2] == (start, spacing)
            assert all(np.array_equal(*sides) for sides in zip(heights, found[2:], strict=True))


def test_a_road_of_no_samples_is_empty():
    """Nothing is mapped where no height has come."""
    patches = RoadPatches()
    patches.add(0.0, 0.05, np.empty(0), np.empty(0))
    ((start, spacing, left, right),) = patches
    assert (start, spacing, len(left), len(right)) == (0.0, 0.05, 0, 0)
