"""Pairs of samples of two sensors whose stamps are not the same."""

import numpy as np
import pytest
from mr_mount_controller.node_base.cdr import leading_stamp
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.playing import OpenBag
from trackvib_sim.bags.samples import nearest, paired_samples

from .foreign_bags import TOPICS, imus, stamps, write_foreign

pytestmark = pytest.mark.property
PERIOD = 1_000_000  # ns
EVEN = np.arange(10) * PERIOD


def pairs(first, second):
    return nearest(np.asarray(first), np.asarray(second)).T.tolist()


@pytest.mark.parametrize("offset", [0, 400_000, -400_000])
def test_an_offset_up_to_half_a_period(offset):
    """Every sample has its partner, the one of the same number."""
    assert pairs(EVEN, EVEN + offset) == [[k, k] for k in range(10)]


def test_lost_samples_have_no_partner():
    """And take nobody else's."""
    assert pairs(np.delete(EVEN, 3), np.delete(EVEN, 7) + 300_000) == [
        [0, 0], [1, 1], [2, 2], [3, 4], [4, 5], [5, 6], [7, 7], [8, 8]
    ]  # fmt: skip


def test_half_the_rate_and_none():
    """Each message is in one pair at most; of what never comes near there is none."""
    assert pairs(EVEN, EVEN[::2] + 100_000) == [[2 * k, k] for k in range(5)]
    assert pairs(EVEN, EVEN + 100 * PERIOD) == pairs(EVEN, []) == pairs([1], EVEN) == []


def test_messages_get_the_stamp_of_the_chassis(tmp_path):
    """Nothing else of them changes; the order in the file does not matter, of repeated stamps the first counts."""
    chassis, powertrain = stamps(200, 499.98), stamps(200, 499.98) + 400_000
    mixed = np.concatenate((powertrain[100:], powertrain[:100], powertrain[:1]))
    write_foreign(tmp_path / "bag_0.mcap", dict(zip(TOPICS, (chassis, mixed), strict=True)))
    with OpenBag(tmp_path, whole=False) as bag:
        samples = paired_samples(bag, *TOPICS)
        found = list(samples.messages)
    assert set(samples.apart.tolist()) == {400_000}
    assert [stamp for stamp, *_ in found] == samples.stamp.tolist() == chassis.tolist()
    for (stamp, first, second), old in zip(found, imus(powertrain.tolist()), strict=True):
        assert leading_stamp(first) == leading_stamp(second) == stamp
        assert (second[:4], second[12:]) == (old[:4], old[12:])


def test_drivers_may_swap_and_repeat_stamps(tmp_path):
    """That is no second run; the bag of two runs is one, though its times are those of its stamps."""
    stamp = stamps(200)
    driver = stamp.copy()
    driver[[50, 51]], driver[100] = driver[[51, 50]], driver[99]
    for name, both, samples in (("driver", driver, 199), ("two runs", np.concatenate((stamp, stamp)), None)):
        write_foreign(tmp_path / name / "bag_0.mcap", dict.fromkeys(TOPICS, both))
        with OpenBag(tmp_path / name) as bag:
            if samples:
                assert len(paired_samples(bag, *TOPICS).stamp) == samples
            else:
                with pytest.raises(BagError, match="more than one run: after t = .* /chassis/imu starts again"):
                    paired_samples(bag, *TOPICS)
