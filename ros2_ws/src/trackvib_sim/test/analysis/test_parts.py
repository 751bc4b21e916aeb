"""Numbers by way and by speed: levels of known size where the vehicle was and as fast as it drove."""

import csv
import json

import numpy as np
import pytest
from pyarrow import parquet
from trackvib_sim.analysis.absorbed_power import absorbed_by_frequency
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.bag_tables import write_tables

from .made_recordings import driven, made_recording

SECONDS = 30
MILLISECONDS = np.arange(1, 1000 * SECONDS + 1)


def speed(time):
    """5 m/s, from 10 to 12 s faster, then 15 m/s."""
    return np.interp(time, (10.0, 12.0), (5.0, 15.0))


def engine(time):
    """200 r/min a m/s."""
    return 200.0 * speed(time)


@pytest.fixture(scope="module")
def recording():
    """A sine of 5 Hz along z whose amplitude is a tenth of the speed's number, x and y at rest."""
    time = MILLISECONDS / 1e3
    sine = 0.1 * speed(time) * np.sin(2.0 * np.pi * 5.0 * time)
    return driven(made_recording(MILLISECONDS, np.outer(sine, (0.0, 0.0, 1.0)) + (0.0, 0.0, 9.81)), speed, engine)


@pytest.mark.analytic
def test_levels_by_speed_and_by_way(recording):
    """In each band and interval of steady speed RMS and absorbed power are those of the sine, and times add up."""
    found = analyse(recording, interval=25.0, speed_band=2.0)
    assert [(band.low, band.high) for band in found.by_speed] == [(low, low + 2.0) for low in range(4, 15, 2)]
    assert sum(band.measured for band in found.by_speed) == pytest.approx(found.measured, abs=0.02)
    assert sum(part.measured for part in found.by_way) == pytest.approx(found.measured, abs=0.02)
    slow, fast = found.by_speed[0], found.by_speed[-1]
    # 2 s of settling before, half a second of the ramp's smoothing after
    assert slow.measured == pytest.approx(8.0, abs=0.5) and fast.measured == pytest.approx(18.0, abs=0.5)
    for band, wanted in ((slow, 5.0), (fast, 15.0)):
        rms = 0.1 * wanted / np.sqrt(2.0)
        assert band.speed == pytest.approx(wanted, rel=0.02)
        assert band.engine_speed == pytest.approx(200.0 * band.speed, rel=0.02)
        assert band.rms["chassis"]["z"] == pytest.approx(rms, rel=0.02)
        assert band.rms["powertrain"]["z"] == pytest.approx(0.5 * rms, rel=0.02)
        assert band.rms["chassis"]["x"] == 0.0
        assert band.absorbed_power["chassis"] == pytest.approx(absorbed_by_frequency(5.0) * rms**2, rel=0.04)
    intervals = {part.low: part for part in found.by_way}
    assert list(intervals) == list(np.arange(0.0, 340.0, 25.0))
    assert intervals[0.0].measured == pytest.approx(3.0, abs=0.02)  # 5 s in it, of which 2 s settle
    assert intervals[25.0].measured == pytest.approx(5.0, abs=0.02)
    assert intervals[25.0].rms["chassis"]["z"] == pytest.approx(0.5 / np.sqrt(2.0), rel=0.01)
    assert intervals[200.0].measured == pytest.approx(25.0 / 15.0, abs=0.02)
    assert intervals[200.0].rms["chassis"]["z"] == pytest.approx(1.5 / np.sqrt(2.0), rel=0.01)


@pytest.mark.property
def test_absorbed_power_of_the_whole_is_that_of_its_spectrum(recording):
    """Noise: the filter's mean power is the integral of the published factor over the spectrum."""
    noise = np.random.default_rng(2).normal(size=(len(MILLISECONDS), 3))
    found = analyse(made_recording(MILLISECONDS, noise))
    frequency = np.linspace(0.0, 499.0, 50_000)
    wanted = np.trapezoid(absorbed_by_frequency(frequency), frequency) * 2.0 / 1000.0
    assert found.absorbed_power["chassis"] == pytest.approx(wanted, rel=0.15)  # 6 Hz wide, 28 s: 8 % of scatter
    assert found.absorbed_power["powertrain"] == pytest.approx(0.25 * found.absorbed_power["chassis"], rel=1e-9)
    assert np.nanmean(found.history.absorbed_power["chassis"]) == pytest.approx(wanted, rel=0.15)


@pytest.mark.property
def test_a_steady_speed_is_one_band_and_odometry_tells_the_way():
    """Also where it swings about an edge of bands; without a recorded drive the way is the integral of the speed."""
    made = made_recording(MILLISECONDS, speed=10.0)
    swinging = 10.0 + 0.3 * np.sin(np.arange(len(made.odometry.stamp)) / 40.0)
    found = analyse(made._replace(odometry=made.odometry._replace(speed=swinging)))
    (band,) = found.by_speed
    assert 9.6 < band.low < 9.9 and 10.1 < band.high < 10.4 and band.measured == pytest.approx(28.0, abs=0.02)
    assert np.isnan(band.engine_speed)
    assert [part.low for part in found.by_way] == [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0][: len(found.by_way)]
    assert found.by_way[2].measured == pytest.approx(5.0, abs=0.2)


@pytest.mark.property
def test_without_odometry_there_are_none_and_backwards_there_are(recording):
    """Distances below zero have their intervals, too; stamps that come again and numbers that are none do not count."""
    bare = recording._replace(odometry=None, drive=None)
    assert analyse(bare).by_way == analyse(bare).by_speed == ()
    back = driven(recording, lambda time: -speed(time), engine)
    lows = [part.low for part in analyse(back).by_way]
    assert lows == sorted(lows) and lows[0] == -350.0 and lows[-1] == -50.0
    odd = np.array(recording.odometry.speed)
    odd[500], twice = np.nan, np.array(recording.odometry.stamp)
    twice[701] = twice[700]
    found = analyse(recording._replace(odometry=recording.odometry._replace(stamp=twice, speed=odd), drive=None))
    assert sum(part.measured for part in found.by_way) == pytest.approx(found.measured, abs=0.05)


@pytest.mark.property
def test_a_way_without_end_has_longer_intervals():
    """A drive that tells a million kilometres does not make a million rows."""
    made = driven(made_recording(MILLISECONDS[:5000]), lambda time: np.full(len(time), 1e8), engine)
    parts = analyse(made, interval=1.0).by_way
    assert 0 < len(parts) <= 3600 and parts[0].high - parts[0].low == pytest.approx(5e8 / 3600, rel=0.5)


@pytest.mark.property
@pytest.mark.parametrize("name", ["interval", "speed_band"])
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf")])
def test_widths_that_are_none_are_refused(recording, name, value):
    """The message names the item and what it was."""
    with pytest.raises(ValueError, match=f"{name} is {value:g}, must be a number above 0"):
        analyse(recording, **{name: value})


@pytest.mark.property
def test_further_sensors_have_numbers_at_their_own_rate(recording):
    """A seat at 500 Hz has all of them; one at 40 Hz levels, but nothing weighted; one of two samples none."""
    seats = {}
    for name, step in (("seat", 2), ("slow", 25), ("short", 15_000)):
        seats[name] = recording.chassis.at(slice(step - 1, None, step))
    found = analyse(recording._replace(sensors=seats))
    assert list(found.sensors) == ["chassis", "powertrain", "seat", "slow"]
    chassis, seat, slow = (found.sensors[name]["z"] for name in ("chassis", "seat", "slow"))
    assert seat.rms == pytest.approx(chassis.rms, rel=1e-2) and slow.rms == pytest.approx(chassis.rms, rel=1e-2)
    assert found.absorbed_power["seat"] == pytest.approx(found.absorbed_power["chassis"], rel=1e-2)
    assert np.isnan(slow.rms_weighted) and np.isnan(found.absorbed_power["slow"])
    assert found.by_speed[0].rms["seat"]["z"] == pytest.approx(found.by_speed[0].rms["chassis"]["z"], rel=1e-2)


@pytest.mark.property
def test_tables_by_way_speed_and_order(tmp_path, recording):
    """What the analysis says stands in the files of two bags, of which one has no drive."""
    found = analyse(recording)
    other = analyse(recording._replace(path="other", drive=None, sensors={"seat": recording.chassis}))
    write_tables([found, other], tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {
        "numbers.json", "numbers.csv", "spectra.parquet", "history.parquet", "by_way.csv", "by_speed.csv",
        "order_levels.csv", "order_spectra.parquet", "campbell_engine_speed.parquet", "campbell_speed.parquet",
    }  # fmt: skip
    (first, _) = json.loads((tmp_path / "numbers.json").read_text())["bags"]
    assert len(first["by_speed"]) == len(found.by_speed) > 3
    assert first["by_way"][1]["rms"] == found.by_way[1].rms
    assert first["absorbed_power"] == found.absorbed_power
    tables = {}
    for name in ("by_way", "by_speed", "order_levels"):
        with (tmp_path / f"{name}.csv").open(encoding="utf-8") as file:
            tables[name] = list(csv.DictReader(file))
    assert len(tables["by_speed"]) == len(found.by_speed) + len(other.by_speed)
    row = tables["by_speed"][0]
    assert float(row["powertrain_rms_z"]) == found.by_speed[0].rms["powertrain"]["z"]
    assert row["seat_absorbed_power"] == "" and tables["by_speed"][-1]["seat_absorbed_power"] != ""
    assert tables["by_speed"][-1]["engine_speed"] == ""  # not recorded
    assert {row["bag"] for row in tables["order_levels"]} == {"bag"}
    spectra = parquet.read_table(tmp_path / "order_spectra.parquet")
    assert spectra.num_rows == found.order_spectra.psd["chassis"][:, :, 0].size
    assert spectra.schema.field("chassis_psd_z").metadata[b"unit"] == "(m/s²)²/order".encode()
    diagram = parquet.read_table(tmp_path / "campbell_engine_speed.parquet")
    assert diagram.column_names == ["bag", "engine_speed", "frequency", "chassis_psd_z", "powertrain_psd_z"]
