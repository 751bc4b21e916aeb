"""The analysis of a whole recording: its start, its gaps, what is missing in it, and its tables as files."""

import csv
import json

import numpy as np
import pytest
from pyarrow import parquet
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.bag_tables import rows, write_tables
from trackvib_sim.analysis.picture_data import prepare
from trackvib_sim.analysis.report.report_data import build_report_data
from trackvib_sim.analysis.segments import TooShort, settling_of
from trackvib_sim.analysis.summary import summarise
from trackvib_sim.analysis.vibration import rms

from .made_recordings import made_recording

SENSORS = ("chassis", "powertrain")


@pytest.mark.property
def test_summary_and_picture_show_the_same_levels():
    """RMS of the analysis is that of the histories that the picture of a run draws."""
    recording = made_recording(np.arange(1, 8001))
    summary, prepared = summarise(analyse(recording, 2.5)), prepare(recording, 2.5)
    for sensor in SENSORS:
        drawn = rms(prepared.limited[sensor][prepared.settled])
        np.testing.assert_allclose(list(summary["rms_mps2"][sensor].values()), drawn, rtol=1e-12)
    assert summary["settled_after_s"] == 2.5 and summary["band_hz"] == [0.5, 500.0]
    assert summary["loop"] == {"samples": 8000, "late": "0"} | dict.fromkeys(
        ("lost_chassis", "lost_powertrain", "unanswered", "answered_twice"), 0
    )


@pytest.mark.property
def test_no_number_is_taken_across_a_gap():
    """After a gap both sensors lie 100 m/s^2 higher: each level is that of its segment, and the gap is told."""
    milliseconds = np.append(np.arange(1, 10_001), np.arange(12_001, 22_001))
    noise = np.random.default_rng(4).normal(size=(20_000, 3))
    noise[10_000:] += 100.0
    found = analyse(made_recording(milliseconds, noise), 2.0)
    assert found.duration == 22.0 and found.measured == pytest.approx(16.0)
    for axis in "xyz":
        assert found.sensors["chassis"][axis].rms == pytest.approx(1.0, rel=0.03)
        assert found.sensors["powertrain"][axis].peak < 4.0
    assert found.spectra.psd["chassis"][1:].max() < 0.02  # 2 / rate of white noise, and its scatter
    np.testing.assert_allclose(found.spectra.transmissibility, 0.5, rtol=1e-6)
    gaps = found.timing["chassis/imu"].gaps
    assert [(gap.begin, gap.length, gap.missing) for gap in gaps] == [(10.0, 2.001, 2000)]
    assert "chassis/imu: gaps: 1, in which 2000 samples are missing" in found.notes
    assert np.isnan(found.history.rms["chassis"][10:12]).all() and found.loop["lost_chassis"] == 2000
    one = analyse(made_recording(np.delete(np.arange(1, 10_001), 5000)))
    assert "chassis/imu: gaps: 1, in which 1 sample is missing" in one.notes


@pytest.mark.property
def test_a_recording_that_began_late_starts_with_its_first_sample():
    """Also where stamps are the time of day; the settling time counts from there."""
    whole = made_recording(np.arange(1, 8001))
    day = 1_700_000_000_000_000_000
    late = whole._replace(
        odometry=None,
        chassis=whole.chassis._replace(stamp=whole.chassis.stamp + day),
        powertrain=whole.powertrain._replace(stamp=whole.powertrain.stamp + day),
        answers=None,
    )
    first, second = analyse(whole), analyse(late)
    assert second.begin == day and (second.duration, second.settle) == (first.duration, first.settle)
    assert second.sensors == first.sensors and second.loop["lost_chassis"] == 0


@pytest.mark.property
def test_what_is_missing_is_said():
    """Without mounts, answers, odometry, vehicle and parameters there are levels and spectra, and notes on the rest."""
    whole = made_recording(np.arange(1, 5001))
    bare = whole._replace(mounts=None, answers=None, odometry=None, vehicle=None, provenance={}, diagnostics={})
    found = analyse(bare)
    assert found.sensors == analyse(whole, 2.0).sensors
    assert (found.mounts, found.demand, found.lines, found.mount_energy) == ({}, {}, (), None)
    assert np.isnan([found.speed, found.engine_speed]).all() and np.isnan(found.history.current).all()
    for words in ("no odometry", "no engine speed", "no vehicle description", "no mount_state", "no coil_current"):
        assert sum(words in note for note in found.notes) == 1, words
    assert (found.loop["unanswered"], found.loop["answered_twice"]) == (None, None)
    early = whole._replace(odometry=type(whole.odometry)(*(column[:100] for column in whole.odometry)))
    assert any("no odometry after the settling time" in note for note in analyse(early).notes)
    unreadable = analyse(whole._replace(vehicle="hull: 1"))
    assert unreadable.lines == () and any("vehicle description" in note for note in unreadable.notes)


@pytest.mark.property
def test_samples_that_are_no_numbers_are_noted():
    """They are counted by topic, and the report can be made all the same."""
    whole = made_recording(np.arange(1, 5001))
    force, acceleration = np.array(whole.mounts.force), np.array(whole.chassis.specific_force)
    force[3000, 1, 2], acceleration[10:12, 0] = np.nan, np.inf
    odd = whole._replace(
        mounts=whole.mounts._replace(force=force), chassis=whole.chassis._replace(specific_force=acceleration)
    )
    found = analyse(odd)
    assert found.notes == (
        "chassis/imu: samples that are not finite: 2; each splits the recording like a gap",
        "chassis/imu: gaps: 1, in which 2 samples are missing",
        "mount_state: samples that are not finite: 1",
    )
    assert np.isfinite(found.sensors["chassis"]["x"].rms)
    assert np.isfinite(build_report_data(odd, found).deflection_loops["right"].density).any()


@pytest.mark.property
def test_a_bag_that_was_cut_short_is_noted():
    """First of all, for all numbers are of a part of the run."""
    whole = made_recording(np.arange(1, 5001))
    assert analyse(whole).notes == ()
    assert "was cut short" in analyse(whole._replace(complete=False)).notes[0]


@pytest.mark.analytic
@pytest.mark.parametrize(("speed", "seconds"), [(10.0, 2.0), (5.0, 3.7)])
def test_settling_follows_from_the_parameters_in_the_bag(speed, seconds):
    """16 m to the full roughness and 2.5 m of vehicle, at least 2 s, as `trackvib run` has it."""
    recording = made_recording(np.arange(1, 11), speed=speed)
    assert settling_of(recording) == pytest.approx(seconds)
    recording.provenance["parameters of /ns/road_excitation"]["begins"] = "40.0"  # of a road from a file
    assert settling_of(recording) == pytest.approx(42.5 / speed)
    recording.provenance["parameters of /ns/road_excitation"]["begins"] = "inf"
    assert settling_of(recording) == 2.0


@pytest.mark.property
def test_recordings_that_cannot_be_measured_are_refused():
    """Too short, too short between gaps, settling for less than filters do, with a stamp that is none."""
    with pytest.raises(TooShort, match="2.499 s long, RMS values need 3 s"):
        analyse(made_recording(np.arange(1, 2500)))
    holes = np.setdiff1d(np.arange(1, 10_001), np.arange(0, 10_001, 2000))
    with pytest.raises(TooShort, match="9.999 s long.*without a gap"):
        analyse(made_recording(holes))
    whole = made_recording(np.arange(1, 5001))
    for settle in (1.9, float("nan")):
        with pytest.raises(ValueError, match=f"settle is {settle} s, must be 2 s or more"):
            analyse(whole, settle)
    stamp = whole.chassis.stamp.copy()
    stamp[-1] = 2**62
    found = analyse(whole._replace(chassis=whole.chassis._replace(stamp=stamp)))
    assert found.duration == 4.999 and found.measured == pytest.approx(2.999)
    assert "chassis/imu: 1 samples are isolated or next to lost ones, left out" in found.notes


@pytest.mark.property
def test_tables_hold_the_numbers(tmp_path):
    """JSON, CSV and Parquet of two bags give back what the analyses say, with units, and nothing for nan."""
    whole = made_recording(np.arange(1, 5001))
    analyses = [analyse(whole), analyse(whole._replace(path="other", odometry=None))]
    write_tables(analyses, tmp_path)
    document = json.loads((tmp_path / "numbers.json").read_text())
    assert [bag["bag"] for bag in document["bags"]] == ["bag", "other"]
    z = analyses[0].sensors["powertrain"]["z"]
    assert document["bags"][0]["sensors"]["powertrain"]["z"] == vars(z)
    assert document["bags"][1]["speed"] is None and document["units"]["AxisNumbers"]["vdv"] == "m/s^1.75"
    assert len(document["bags"][0]["lines"]) > len(document["bags"][1]["lines"]) > 0
    with (tmp_path / "numbers.csv").open(encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert len(table) == sum(1 for analysis in analyses for _ in rows(analysis)) > 200
    keys = [tuple(row[name] for name in ("bag", "part", "axis", "quantity")) for row in table]
    assert len(set(keys)) == len(keys) and all(row["unit"] for row in table)
    by_key = dict(zip(keys, table, strict=True))
    assert float(by_key["other", "powertrain", "z", "vdv"]["value"]) == z.vdv
    assert by_key["other", "run", "", "speed"]["value"] == ""
    assert by_key["bag", "left mount", "", "energy_dissipated"]["unit"] == "J"
    spectra, history = (parquet.read_table(tmp_path / f"{name}.parquet") for name in ("spectra", "history"))
    assert spectra.num_rows == 2 * 501 and history.num_rows == 2 * 5
    np.testing.assert_array_equal(spectra["chassis_psd_z"][:501], analyses[0].spectra.psd["chassis"][:, 2])
    np.testing.assert_array_equal(history["powertrain_rms_x"][:5], analyses[0].history.rms["powertrain"][:, 0])
    assert spectra.schema.field("chassis_psd_z").metadata[b"unit"] == "(m/s²)²/Hz".encode()
