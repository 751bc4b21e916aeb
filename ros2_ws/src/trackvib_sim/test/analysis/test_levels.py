"""Levels of long segments: sines of known level, and blocks that do not show."""

import numpy as np
import pytest
from trackvib_sim.analysis import levels
from trackvib_sim.analysis.iso2631 import transfer, weighted
from trackvib_sim.analysis.levels import Levels, build_bins
from trackvib_sim.analysis.vibration import band_limited, rms

RATE = 1000.0
MS = 1_000_000  # ns


def levels_of(acceleration, measured, rate=RATE):
    """Return numbers of x, y, z and history of one segment from the start on."""
    stamp = np.arange(1, len(acceleration) + 1) * round(1e9 / rate)
    found = Levels(rate, build_bins(0, int(stamp[-1])))
    for _ in found.add(stamp, acceleration, measured):
        pass
    return found.numbers(), found.history()


@pytest.mark.analytic
def test_sine_has_its_levels():
    """5 Hz of amplitude a upon gravity: a / sqrt(2), crest factor sqrt(2), and VDV = (3/8 a^4 T)^(1/4), as weighted."""
    count, measured, amplitude = 62_000, 2000, 3.0
    # beginning and ending at a crest, where being mirrored does not bend it
    sine = amplitude * np.cos(2.0 * np.pi * 5.0 * np.arange(count) / RATE)
    numbers, history = levels_of(np.outer(sine, (1.0, 0.5, 1.0)) + (0.0, 0.0, 9.81), measured)
    gain = np.sqrt(2.0) * rms(weighted(sine / amplitude, "Wk", RATE)[10_000:])
    z, perceived = numbers[2], gain * amplitude
    assert z.mean == pytest.approx(9.81, rel=1e-12)
    assert z.rms_raw == pytest.approx(amplitude / np.sqrt(2.0), rel=1e-9)
    assert z.rms == pytest.approx(z.rms_raw, rel=2e-4)  # the band's lower end takes 1 - 1e-4 of 5 Hz
    assert z.peak == pytest.approx(amplitude, rel=2e-3)
    assert z.rms_weighted == pytest.approx(perceived / np.sqrt(2.0), rel=1e-3)
    assert z.mtvv == pytest.approx(z.rms_weighted, rel=1e-2)
    assert z.crest_factor == pytest.approx(np.sqrt(2.0), rel=1e-2)
    assert z.vdv == pytest.approx((0.375 * perceived**4 * 60.0) ** 0.25, rel=1e-3)
    assert numbers[1].rms == pytest.approx(0.5 * z.rms, rel=1e-9)
    assert numbers[0].rms_weighted < z.rms_weighted  # Wd has left 5 Hz behind, Wk has not
    np.testing.assert_allclose(history.rms[5:55, 2], z.rms, rtol=1e-6)


@pytest.mark.analytic
def test_running_rms_finds_the_burst():
    """A burst of just one second within silence: the running RMS reaches its level, the RMS over all stays below."""
    sine = np.sqrt(2.0) * np.sin(2.0 * np.pi * 8.0 * np.arange(100_000) / RATE)
    sine[:50_000], sine[51_000:] = 0.0, 0.0
    numbers, _ = levels_of(np.outer(sine, (0.0, 0.0, 1.0)), 2000)
    gain = rms(weighted(np.sin(2.0 * np.pi * 8.0 * np.arange(20_000) / RATE), "Wk", RATE)[10_000:]) * np.sqrt(2.0)
    assert numbers[2].mtvv == pytest.approx(gain, rel=0.03)  # the filter's own time smears the burst's ends
    assert numbers[2].rms_weighted == pytest.approx(gain * np.sqrt(1.0 / 98.0), rel=0.02)


@pytest.mark.property
def test_blocks_do_not_show(monkeypatch):
    """A segment is cut into blocks, yet its numbers are those of filters that run through in one go."""
    random = np.random.default_rng(5)
    acceleration = np.cumsum(random.normal(scale=0.02, size=(95_500, 3)), axis=0) + random.normal(size=(95_500, 3))
    measured = 3000
    monkeypatch.setattr(levels, "BLOCK", 15.0)  # s
    numbers, history = levels_of(acceleration, measured)
    limited = band_limited(acceleration, RATE)
    for axis, (found, name) in enumerate(zip(numbers, levels.WEIGHTINGS, strict=True)):
        raw, perceived = acceleration[measured:, axis], weighted(acceleration[:, axis], name, RATE)[measured:]
        squared = np.cumsum(np.append(0.0, perceived**2))
        expected = (
            raw.mean(), raw.std(), rms(limited[measured:, axis]), np.abs(limited[measured:, axis]).max(),
            rms(perceived), np.abs(perceived).max() / rms(perceived),
            np.sqrt((squared[1000:] - squared[:-1000]).max() / 1000.0), (np.sum(perceived**4) / RATE) ** 0.25,
        )  # fmt: skip
        np.testing.assert_allclose(list(vars(found).values()), expected, rtol=1e-10)
    seconds_of = limited[:95_000].reshape(95, 1000, 3)
    np.testing.assert_allclose(history.rms[:95], np.sqrt(np.mean(seconds_of**2, axis=1)), rtol=1e-10)


@pytest.mark.property
def test_a_low_rate_has_no_weighted_values():
    """Where little of the weighted band is left the numbers are nan, the others are there."""
    numbers, _ = levels_of(np.random.default_rng(1).normal(size=(400, 3)), 80, 40.0)
    assert np.isnan([numbers[2].rms_weighted, numbers[2].crest_factor, numbers[2].vdv, numbers[2].mtvv]).all()
    assert numbers[2].rms == pytest.approx(1.0, rel=0.1)


@pytest.mark.analytic
def test_slow_heave_has_its_motion_sickness_dose():
    """A sine of 0.2 Hz within vibration of 20 Hz: level and dose by the standard's factor; of less time there is none.

    Blocks, shorter than the filter's memory, do not show.
    """
    time = np.arange(20_000) / 100.0
    heave = 0.5 * np.sin(2.0 * np.pi * 0.2 * time) + 5.0 * np.sin(2.0 * np.pi * 20.0 * time) + 9.81
    acceleration, stamp = np.outer(heave, (0.0, 0.0, 1.0)), np.arange(1, 20_001) * 10 * MS
    found = Levels(100.0, build_bins(0, int(stamp[-1])))
    assert len(list(found.add(stamp, acceleration, 200))) == 2
    motion = found.motion_sickness()
    level = 0.5 / np.sqrt(2.0) * np.abs(transfer("Wf", np.array([0.2])))[0]
    assert motion.measured == pytest.approx(170.0)
    assert motion.rms == pytest.approx(level, rel=2e-3)
    assert motion.msdv == pytest.approx(level * np.sqrt(170.0), rel=2e-3)
    short = Levels(100.0, build_bins(0, int(stamp[-1])))
    assert list(short.add(stamp[:8900], acceleration[:8900], 200)) and short.motion_sickness() is None


@pytest.mark.property
def test_bins_of_a_long_bag_stay_few():
    """Seconds of a short bag; of one of 10 h no more than of an hour. Each sample lies in one."""
    assert build_bins(0, 10_000 * MS)[1:] == (1000 * MS, 10)
    long = build_bins(5, 5 + 36_000_000 * MS)
    assert long.count <= levels.BINS and long.width * long.count >= 36_000_000 * MS
    stamp = 5 + np.arange(1, 36_001) * 1000 * MS
    count, sums = long.sums(stamp, np.ones((36_000, 2)))
    assert count.sum() == 36_000 and (count == sums[:, 1]).all() and (count == count[0]).all()
