"""Stretches between gaps, from stamps alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trackvib_sim.analysis.segments import common_segments
from trackvib_sim.analysis.stamp_numbers import Gap
from trackvib_sim.analysis.stamps import timing

MS = 1_000_000  # ns


def stamps(*ranges):
    """Return stamps [ns] of ranges of milliseconds."""
    return np.concatenate([np.arange(*each) for each in ranges]) * MS


def common_of(chassis, powertrain, settle=2.0):
    """Return the segments of two sensors as (first stamp [ms], size, first that counts [ms])."""
    breaks = [timing(stamp, 0)[1] for stamp in (chassis, powertrain)]
    found = common_segments((chassis, powertrain), breaks, 1.0 * MS, 0, settle, 2.0, 1.0)
    for a, b, size, _ in found:
        np.testing.assert_array_equal(chassis[a : a + size], powertrain[b : b + size])
        assert (np.diff(chassis[a : a + size]) == MS).all()
    return [(chassis[a] // MS, size, chassis[a + measured] // MS) for a, _, size, measured in found]


@pytest.mark.property
def test_sound_stamps_are_one_segment():
    """From one period after the start; the first that counts is beyond the settling time."""
    sound = stamps((1, 10_001))
    found, breaks = timing(sound, 0)
    assert found.sound and not breaks.size
    assert (found.samples, found.period, found.first, found.last) == (10_000, 0.001, 0.001, 10.0)
    assert common_of(sound, sound) == [(1, 10_000, 2001)]
    assert common_of(sound, sound, 3.7) == [(1, 10_000, 3701)]


@pytest.mark.property
def test_gaps_repeated_and_backward_stamps_are_found():
    """Each with its place, length and what is missing; all of them end a segment."""
    stamp = stamps((1, 5001), (5011, 9001), (9000, 13_001), (12_500, 17_001))
    found, _ = timing(stamp, 0)
    assert not found.sound
    assert found.gaps == (Gap(5.0, 0.011, 10),)
    assert (found.gap_count, found.missing, found.repeated, found.backward) == (1, 10, 1, 1)
    # of what comes after a step back in time nothing counts: it may be another run
    assert common_of(stamp, stamp) == [(1, 5000, 2001), (5011, 3990, 7011)]


@pytest.mark.property
@given(
    lost=st.tuples(*[st.sets(st.integers(1, 30_000), max_size=6)] * 2),
    first=st.tuples(*[st.integers(1, 500)] * 2),
)
@settings(max_examples=40)
def test_stretches_are_what_both_sensors_have(lost, first):
    """Every segment holds the same instants of both, none is too short, and no long enough one is missed."""
    chassis, powertrain = (
        np.setdiff1d(np.arange(begin, 30_001), list(gone)) * MS for begin, gone in zip(first, lost, strict=True)
    )
    found = common_of(chassis, powertrain)
    edges = np.sort([max(first) - 1, 30_001, *(k for k in lost[0] | lost[1] if k >= max(first))])
    expected = []
    for before, after in zip(edges[:-1], edges[1:], strict=True):
        begin, size = before + 1, after - before - 1
        counts = max(begin + 2000, 2001)
        if after - counts >= 1000:
            expected.append((begin, size, counts))
    assert found == expected


@pytest.mark.property
def test_jitter_is_no_gap():
    """Steps within half a period of the period belong together."""
    jitter = np.random.default_rng(1).integers(-MS // 5, MS // 5, 10_000)
    found, breaks = timing(stamps((1, 10_001)) + jitter, 0)
    assert found.sound and not breaks.size and found.period == pytest.approx(0.001, rel=0.01)
