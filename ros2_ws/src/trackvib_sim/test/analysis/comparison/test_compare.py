"""Ratios of two made drives: as large as they were made, and intervals that hold them as often as they say."""

import json

import numpy as np
import pytest
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.comparison.compare import THROUGH, compare
from trackvib_sim.analysis.comparison.intervals import jackknifed, ratio_interval
from trackvib_sim.analysis.comparison.settlings import settlings
from trackvib_sim.analysis.comparison.tables import write_comparison
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.ratio_section import ratio_section
from trackvib_sim.analysis.report.report_data import build_report_data

from ..hostile_recordings import SCRIPT
from ..made_recordings import made_recording


def drive(seed, gain=1.0, through=0.5, speed=None, seconds=30, rate=1000):
    """Return a recording of noise of a gain, and of how much of it goes through to the powertrain."""
    count = seconds * rate
    time = np.arange(1, count + 1) * (1000 // rate)
    noise = gain * np.random.default_rng(seed).normal(size=(count, 3))
    found = made_recording(time, noise, through * noise)
    if speed is None:
        return found._replace(odometry=None, vehicle=None)
    return found._replace(odometry=found.odometry._replace(speed=speed(found.odometry.stamp / 1e9)))


def compared(*recordings, **options):
    """Return the `Comparison` of two recordings."""
    return compare(recordings, [analyse(each) for each in recordings], **options)


def of(comparison, part, axis, quantity):
    """Return the `Ratio`s of something."""
    return [each for each in comparison.ratios if (each.part, each.axis, each.quantity) == (part, axis, quantity)]


@pytest.mark.analytic
def test_ratios_are_as_large_as_they_were_made():
    """Levels 1.5 fold, transmissibility 0.6 fold, in all bands; the intervals hold them and are narrow."""
    found = compared(drive(1), drive(2, 1.5, 0.3))
    assert found.aligned_by == "none" and any("statistics of all time that counts" in note for note in found.notes)
    for part, wanted in (("chassis", 1.5), ("powertrain", 0.9)):
        for quantity in ("RMS", "RMS, weighted"):
            for axis in "xyz":
                (ratio,) = of(found, part, axis, quantity)
                assert ratio.ratio == pytest.approx(wanted, rel=0.1) and ratio.low < ratio.ratio < ratio.high
        thirds = of(found, part, "z", "RMS, third octave")
        assert [each.frequency for each in thirds][:3] == [2.0, 2.5, 3.15] and thirds[-1].frequency == 400.0
        held = [each.low <= wanted <= each.high for each in thirds]
        assert np.mean(held) > 0.8
        assert thirds[-1].high / thirds[-1].low < thirds[0].high / thirds[0].low < 5.0
    for each in of(found, THROUGH, "z", "transmissibility, third octave"):
        assert (each.measured, each.simulated) == (pytest.approx(0.5), pytest.approx(0.3))
        assert each.ratio == pytest.approx(0.6) and each.unit == "-"


@pytest.mark.analytic
def test_intervals_hold_the_ratio_as_often_as_they_say():
    """Of 400 pairs of drives of equal level about 95 % have 1 within; of 10 windows as of 40 beside 15."""
    random = np.random.default_rng(7)
    for counts in ((10, 10), (40, 15)):
        held = 0
        for _ in range(400):
            pair = []
            for count in counts:
                power = random.chisquare(20, size=(count, 1))
                pair.append(jackknifed(power, np.zeros(count, int), np.ones(1), lambda mean: 0.5 * np.log(mean)))
            _, low, high = ratio_interval(*pair)
            held += bool(low[0] <= 1.0 <= high[0])
        assert 0.92 <= held / 400 <= 0.98


@pytest.mark.slow(reason="long recordings")
@pytest.mark.analytic
def test_aligned_by_speed_the_same_speeds_are_compared():
    """Two drives whose level goes with the speed, but which drove at different speeds for different times.

    As a whole they differ; at the speeds that both have they do not.
    """
    drives = []
    for seed, slow in ((3, 20.0), (4, 8.0)):
        found = drive(seed, speed=lambda time, slow=slow: np.where(time < slow, 5.0, 11.0))
        fast = (found.chassis.stamp > slow * 1e9)[:, None]
        chassis = found.chassis.specific_force * np.where(fast, 3.0, 1.0)
        drives.append(
            found._replace(
                chassis=found.chassis._replace(specific_force=chassis),
                powertrain=found.powertrain._replace(specific_force=0.5 * chassis),
            )
        )
    (whole,) = of(compared(*drives, align="none"), "chassis", "z", "RMS")
    found = compared(*drives)
    (same,) = of(found, "chassis", "z", "RMS")
    assert found.aligned_by == "speed" and sum(found.windows) < 60
    assert whole.ratio > 1.25 and same.ratio == pytest.approx(1.0, abs=0.05)
    assert not of(found, "chassis", "z", "link passing 1")  # whose range overlaps those of others at these speeds
    assert compared(*drives, align="distance").aligned_by == "distance"


@pytest.mark.property
def test_drives_that_have_nothing_in_common_are_refused():
    """Where an alignment is asked for, and there is none."""
    slow, fast = (drive(k, speed=lambda time, v=v: np.full(len(time), v)) for k, v in ((1, 3.0), (2, 9.0)))
    with pytest.raises(ValueError, match="no speed in common"):
        compared(slow, fast, align="speed")
    assert compared(slow, fast).aligned_by == "none"


@pytest.mark.slow(reason="long recordings")
@pytest.mark.property
def test_different_rates_and_one_sensor(tmp_path):
    """Compared up to 0.45 of the lower rate; what one drive lacks is empty, and files and report can be written."""
    measured = drive(1, rate=200)
    nothing = np.full((len(measured.chassis.stamp), 3), np.nan)
    measured = measured._replace(powertrain=measured.powertrain._replace(specific_force=nothing))
    recordings = measured, drive(2)
    analyses = [analyse(each) for each in recordings]
    found = compare(recordings, analyses)
    assert found.band == (0.5, pytest.approx(90.0))
    assert max(each.frequency for each in of(found, "chassis", "z", "RMS, third octave")) == 80.0
    write_comparison(found, tmp_path)
    (row,) = [
        each
        for each in json.loads((tmp_path / "comparison.json").read_text())["ratios"]
        if (each["part"], each["axis"], each["quantity"]) == ("powertrain", "z", "RMS")
    ]
    assert row["measured"] is None and row["ratio"] is None and row["simulated"] > 0.0
    assert "nan" not in (tmp_path / "comparison.csv").read_text()
    data = [build_report_data(*each) for each in zip(recordings, analyses, strict=True)]
    write_report(data, tmp_path / "report.html", [ratio_section(found)])
    assert "Simulated over measured" in (tmp_path / "report.html").read_text()


@pytest.mark.property
def test_text_from_bags_is_escaped(tmp_path):
    """Paths, provenance and notes are text in the page."""
    recordings = [
        drive(seed, seconds=8)._replace(notes=(SCRIPT,), provenance={SCRIPT: {SCRIPT: SCRIPT}}) for seed in (1, 2)
    ]
    analyses = [analyse(each) for each in recordings]
    data = [build_report_data(*each) for each in zip(recordings, analyses, strict=True)]
    write_report(data, tmp_path / "report.html", [ratio_section(compare(recordings, analyses))])
    assert SCRIPT not in (tmp_path / "report.html").read_text()


@pytest.mark.property
def test_both_settle_by_one_rule():
    """As their own runs tell; what tells nothing as the other one; by what is asked for both. The report says it."""
    slow, fast = (
        drive(1)._replace(
            provenance={
                "parameters of /road_excitation": {"level_until": "8.0", "fade": "8.0", "begins": "16.0"},
                "parameters of /simulator": {"engine_speed": "1650.0", "speed": speed},
            }
        )
        for speed in ("3.7", "18.5")
    )
    logger = drive(2)._replace(provenance={})
    assert settlings([logger, slow]) == [(5.0, "as the other one, for it tells nothing"), (5.0, "by its own run")]
    assert settlings([slow, fast]) == [(5.0, "by its own run"), (2.0, "by its own run")]
    assert settlings([logger, logger]) == [(2.0, "the shortest")] * 2
    assert settlings([logger, slow], 7.0) == [(7.0, "as asked for")] * 2
    found = compare([logger, slow], [analyse(each, 5.0) for each in (logger, slow)])
    assert found.settle == (5.0, 5.0)
    assert found.windows == (24, 24)  # of 2 s, half overlapping, in 25 s
    assert "first 5 s of the measured drive and the first 5 s of the simulated one do not" in ratio_section(found).words
