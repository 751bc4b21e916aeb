"""What a report keeps of a recording: every peak, every gap, the right power, and little of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.report.report_data import COLUMNS, build_report_data, spectrogram
from trackvib_sim.analysis.report.thinning import MOST, thinned

from ..made_recordings import made_recording

RATE = 1000.0  # Hz


@pytest.mark.property
@given(seed=st.integers(0, 10**6), size=st.integers(1, 3000), most=st.integers(4, 500))
def test_line_has_the_peaks_of_its_samples(seed, size, most):
    """About so many points, all of them samples in their order, the greatest and the least of all among them."""
    time, values = np.arange(size) / RATE, np.random.default_rng(seed).normal(size=size)
    line_time, line = thinned(time, values, 2.0 / RATE, most)
    assert len(line) <= most + 4
    assert np.all(np.diff(line_time) > 0.0)
    assert line == pytest.approx(values[np.round(line_time * RATE).astype(int)], rel=1e-6)
    assert line.max() == np.float32(values.max()) and line.min() == np.float32(values.min())
    assert (line_time[0], line_time[-1]) == pytest.approx((time[0], time[-1]))


@pytest.mark.property
@pytest.mark.parametrize("most", [100, 5000])
def test_line_is_broken_where_samples_are_missing(most):
    """Once a gap, thinned or not."""
    kept = np.ones(2000, dtype=bool)
    kept[500:700] = kept[1500] = False
    time = np.flatnonzero(kept) / RATE
    line_time, line = thinned(time, np.sin(time), 1.5 / RATE, most)
    broken = np.flatnonzero(np.isnan(line))
    assert np.array_equal(broken, np.flatnonzero(np.isnan(line_time))) and len(broken) == 2
    for place, gap in zip(broken, ((0.499, 0.7), (1.499, 1.501)), strict=True):
        assert line_time[place - 1] <= gap[0] + 1e-6 and line_time[place + 1] >= gap[1] - 1e-6


@pytest.mark.analytic
def test_spectrogram_has_the_power_of_a_sine():
    """Summed over frequency, each column has half the amplitude squared; the greatest level is at the sine's."""
    time = (np.arange(20_000) + 1) / RATE
    found = spectrogram(time, 9.81 + 3.0 * np.sin(2.0 * np.pi * 80.0 * time), RATE, 20.0)
    power = np.sum(10.0 ** (found.level / 10.0), axis=0) * (found.frequency[1] - found.frequency[0])
    assert power == pytest.approx(np.full(len(found.time), 4.5), rel=1e-3)
    assert np.all(found.frequency[found.level.argmax(axis=0)] == 80.0)


@pytest.mark.property
def test_spectrogram_is_empty_where_samples_are_missing():
    """Columns about a gap of a second, and no others."""
    time = (np.arange(20_000) + 1) / RATE
    time = time[(time < 8.0) | (time > 9.0)]
    found = spectrogram(time, np.random.default_rng(3).normal(size=len(time)), RATE, 20.0)
    empty = np.isnan(found.level).all(axis=0)
    assert np.array_equal(empty, np.isnan(found.level).any(axis=0))
    assert empty[(found.time > 8.0) & (found.time < 9.0)].all()
    assert not empty[(found.time < 7.5) | (found.time > 9.5)].any()


@pytest.mark.slow(reason="a long recording")
@pytest.mark.property
def test_report_data_of_a_long_bag_is_small():
    """Lines and spectrograms do not grow with the bag."""
    recording = made_recording(np.arange(1, 200_001))
    found = build_report_data(recording, analyse(recording))
    currents = (*found.currents.values(), *found.demanded.values())
    lines = [*currents, *(line for axes in found.accelerations.values() for line in axes.values())]
    assert len(lines) == 10
    for time, values in lines:
        assert len(time) == len(values) <= MOST + 4
    assert [each.level.shape[1] for each in found.spectrograms.values()] == [COLUMNS, COLUMNS]
    assert time[-1] == pytest.approx(200.0)
