"""Mean spectra: a known filter between the sensors, noise that has nothing to do with it, sines on known lines."""

import numpy as np
import pytest
from scipy import signal
from trackvib_sim.analysis import mean_spectra
from trackvib_sim.analysis.lines import known_lines
from trackvib_sim.analysis.mean_spectra import MeanSpectra
from trackvib_sim.analysis.motion import MeanMotion
from trackvib_sim.analysis.vibration import psd

RATE = 1000.0


def spectra_of(chassis, powertrain):
    """Return the spectra of one segment."""
    found = MeanSpectra(RATE)
    found.add(chassis, powertrain)
    return found.spectra()


def moved(speed, engine_speed, speeds=None, engine=None):
    """Return the motion at mean speeds, over ranges or without one."""
    ranges = speeds or (speed, speed), engine or (engine_speed, engine_speed)
    return MeanMotion(speed, 0.0, engine_speed, 0.0, *ranges)


@pytest.mark.analytic
def test_transmissibility_of_a_known_filter():
    """A resonant filter between the sensors: |H1| is its gain, coherence one; noise of equal power halves coherence.

    With 599 windows, half overlapping, of coherence g^2 the random error of |H1| is sqrt((1 - g^2) / (2 g^2 n)).
    """
    random = np.random.default_rng(2)
    chassis = random.normal(size=(300_000, 3))
    sections = signal.butter(2, (20.0, 60.0), "bandpass", fs=RATE, output="sos")
    powertrain = signal.sosfilt(sections, chassis, axis=0)
    found = spectra_of(chassis, powertrain)
    gain = np.abs(signal.sosfreqz(sections, found.frequency, fs=RATE)[1])
    within = (found.frequency > 15.0) & (found.frequency < 90.0)
    np.testing.assert_allclose(found.transmissibility[within], np.repeat(gain[within, None], 3, axis=1), rtol=0.03)
    assert found.coherence[within].min() > 0.98
    noisy = spectra_of(chassis, chassis + random.normal(size=chassis.shape))
    np.testing.assert_allclose(noisy.coherence[10:490].mean(axis=0), 0.5, atol=0.01)
    np.testing.assert_allclose(noisy.transmissibility[10:490].mean(axis=0), 1.0, atol=0.01)


@pytest.mark.property
@pytest.mark.parametrize("length", [1000, 1499, 1500, 30_777])
def test_blocks_do_not_show(monkeypatch, length):
    """However many windows make a block, the means are scipy's over all of them."""
    random = np.random.default_rng(3)
    chassis, powertrain = random.normal(size=(2, length, 3))
    monkeypatch.setattr(mean_spectra, "BLOCK", 4.0)
    found = spectra_of(chassis, powertrain)
    frequency, below = psd(chassis, RATE)
    cross = signal.csd(chassis, powertrain, fs=RATE, nperseg=1000, axis=0)[1]
    np.testing.assert_array_equal(found.frequency, frequency)
    np.testing.assert_allclose(found.psd["chassis"], below, rtol=1e-10)
    np.testing.assert_allclose(found.psd["powertrain"], psd(powertrain, RATE)[1], rtol=1e-10)
    np.testing.assert_allclose(found.transmissibility, np.abs(cross) / below, rtol=1e-9)


@pytest.mark.analytic
def test_lines_hold_the_level_of_their_sines():
    """At 10 m/s and 125 mm links pass with 80 Hz; the engine's order 2 at 1650 r/min is 55 Hz. Each has its sine."""
    time = np.arange(60_000) / RATE
    amplitudes = {80.0: 2.0, 160.0: 1.0, 240.0: 0.5, 55.0: 4.0}
    wave = sum(a * np.sin(2.0 * np.pi * f * time) for f, a in amplitudes.items())
    chassis = np.outer(wave, (1.0, 2.0, 3.0))
    lines, notes = known_lines(spectra_of(chassis, 0.5 * chassis), moved(10.0, 1650.0), 0.125, (0.05, 2.0, 50.0))
    assert notes == []
    # order 0.05 lies below what can be told from rest, order 50 beyond half the rate
    assert [line.name for line in lines] == ["link passing 1", "link passing 2", "link passing 3", "engine order 2"]
    for line in lines:
        assert line.frequency == pytest.approx(min(amplitudes, key=lambda f, own=line.frequency: abs(f - own)))
        level = amplitudes[round(line.frequency)] / np.sqrt(2.0)
        for axis, factor in zip("xyz", (1.0, 2.0, 3.0), strict=True):
            assert line.rms["chassis"][axis] == pytest.approx(factor * level, rel=1e-6)
            assert line.rms["powertrain"][axis] == pytest.approx(0.5 * factor * level, rel=1e-6)


@pytest.mark.analytic
def test_bands_reach_over_the_speeds_driven():
    """From the lowest to the highest frequency that a line had, and 2 Hz beyond, which the window spreads."""
    spectra = spectra_of(*np.random.default_rng(1).normal(size=(2, 5000, 3)))
    (first, second, third, order), notes = known_lines(spectra, moved(7.0, 1200.0, (6.0, 8.0)), 0.125, (1.0,))
    assert notes == [] and (first.low, first.high) == (48.0 - 2.0, 64.0 + 2.0)
    assert (third.low, third.high, third.hertz) == (144.0 - 2.0, 192.0 + 2.0, "144.0 to 192.0")
    assert second.sweeps and not order.sweeps and order.hertz == "20.0"
    inside = (spectra.frequency >= 46.0) & (spectra.frequency <= 66.0)
    assert first.rms["chassis"]["z"] == pytest.approx(np.sqrt(spectra.psd["chassis"][inside, 2].sum()))
    assert known_lines(spectra, moved(0.0, 0.0), 0.125, (2.0,)) == ((), [])
    unknown = moved(float("nan"), float("nan"))
    assert known_lines(spectra, unknown, float("nan"), (2.0,)) == ((), [])


@pytest.mark.analytic
def test_lines_that_nothing_can_be_attributed_to_are_left_out():
    """From 5 to 15 m/s the ranges of link passing overlap, from a stand they begin at 0; a steady engine keeps its own.

    One note names those left out. Forwards and backwards links pass at all frequencies from 0.
    """
    spectra = spectra_of(*np.random.default_rng(1).normal(size=(2, 5000, 3)))
    for ends in ((5.0, 15.0), (0.0, 15.0), (-5.0, 15.0)):
        lines, (note,) = known_lines(spectra, moved(10.0, 1200.0, ends), 0.125, (2.0,))
        assert [line.name for line in lines] == ["engine order 2"]
        assert "of link passing 1, 2, 3 overlap" in note
    lines, (note,) = known_lines(spectra, moved(10.0, 1200.0, engine=(800.0, 1600.0)), 0.125, (2.0, 3.0, 4.0))
    assert [line.name for line in lines] == [f"link passing {n}" for n in (1, 2, 3)] and "engine order 2, 3, 4" in note
