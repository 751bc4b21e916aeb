"""Clocks that are set while they record, or are wrong for a moment."""

import numpy as np
import pytest
from trackvib_sim.analysis.analyse import analyse

from .made_sensors import both, times
from .right_numbers import LOGGED, require_right, says


@pytest.mark.property
@LOGGED
@pytest.mark.parametrize("step", [-2.0, -60.0, 7200.0, 0.1, -0.1])
def test_a_clock_that_is_set_while_recording(step, logged):
    """The recorder's times bear out that no sample is lost; without them there are two stretches."""
    time = times(1000.0, 20.0)
    told = time.copy()
    told[7500:] += step
    found = analyse(both(time, told, logged=logged))
    require_right(found, 1000.0)
    assert found.measured == pytest.approx(18.0 if logged else 16.0, abs=0.01)
    if logged:
        assert found.duration == pytest.approx(20.0)
        way = "ahead" if step > 0.0 else "back"
        assert says(found, f"clock was set {way} by {abs(step):g} s", "corrected")


@pytest.mark.property
@LOGGED
@pytest.mark.parametrize(("samples", "step"), [(slice(0, 3), -1.7e9), (slice(4000, 4500), 500.0)])
def test_a_clock_that_is_wrong_for_a_moment(samples, step, logged):
    """Not set yet, or wrong for half a second: nearly all samples count."""
    time = times(1000.0, 20.0)
    told = time.copy()
    told[samples] += step
    found = analyse(both(time, told, logged=logged))
    require_right(found, 1000.0)
    assert found.duration == pytest.approx(20.0, abs=0.01) and found.measured >= 15.0
    assert says(found, "the clock was set") or says(found, "left out")


@pytest.mark.property
@LOGGED
def test_single_wild_stamps(logged):
    """Ten of 20000 that are a day ahead: the rest counts as it stands; without other times they are lost samples."""
    time = times(1000.0, 20.0)
    wild = np.arange(2100, 2130)
    told = time.copy()
    told[wild[::3]] += 86400.0
    found = analyse(both(time, told, logged=logged))
    require_right(found, 1000.0)
    assert found.duration == pytest.approx(20.0) and found.measured > 15.0
