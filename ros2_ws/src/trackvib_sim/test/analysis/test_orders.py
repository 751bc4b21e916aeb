"""Order tracking and Campbell diagrams: run-ups in which the amplitude of each order is known."""

import numpy as np
import pytest
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.orders import STEP

from .made_recordings import driven, made_recording

SECONDS = 24
MILLISECONDS = np.arange(1, 1000 * SECONDS + 1)
AMPLITUDES = {2.0: 1.0, 3.0: 0.5, 6.0: 2.0}  # m/s² of the orders that the vehicle file names


def run_up(time):
    """From 700 to 2100 r/min."""
    return 700.0 + 1400.0 * time / SECONDS


def speed_up(time):
    """From 3.5 m/s, 200 r/min a m/s."""
    return run_up(time) / 200.0


def accelerations(turns, amplitudes=AMPLITUDES, noise=0.0):
    """Return specific forces (k, 3) of orders at turns (k,) of the crank, along x, y and z 1 to 3 of the amplitudes."""
    wave = sum(a * np.sin(2.0 * np.pi * order * turns + order) for order, a in amplitudes.items())
    random = np.random.default_rng(5).normal(size=(len(turns), 3))
    return np.outer(wave, (1.0, 2.0, 3.0)) + noise * random + (0.0, 0.0, 9.81)


def turns_of(time):
    """Return the integral of `run_up`."""
    return (700.0 * time + 700.0 * time**2 / SECONDS) / 60.0


@pytest.fixture(scope="module")
def recording():
    """A run-up in one gear, on which there are three orders and little else."""
    return driven(made_recording(MILLISECONDS, accelerations(turns_of(MILLISECONDS / 1e3))), speed_up, run_up)


@pytest.mark.analytic
def test_each_order_has_its_level_at_each_engine_speed(recording):
    """Within 1 % of amplitude over root two, axis by axis, sensor by sensor, though each frequency triples."""
    found = analyse(recording)
    assert len(found.order_levels) > 70
    assert {level.order for level in found.order_levels} == set(AMPLITUDES)
    for level in found.order_levels:
        for factor, axis in enumerate("xyz", 1):
            rms = factor * AMPLITUDES[level.order] / np.sqrt(2.0)
            assert level.rms["chassis"][axis] == pytest.approx(rms, rel=0.01), level
            assert level.rms["powertrain"][axis] == pytest.approx(0.5 * rms, rel=0.01), level
    spectra = found.order_spectra
    assert spectra.engine_speed[0] < 900.0 and spectra.engine_speed[-1] > 2000.0
    assert np.all(np.diff(spectra.engine_speed) == STEP)
    # what is left between the orders is nothing beside them
    between = np.abs(spectra.order[:, None] - tuple(AMPLITUDES)).min(axis=1) > 0.5
    psd = spectra.psd["chassis"][spectra.windows > 0][:, between, 2]
    assert np.nanmax(psd[:, 2:]) < 1e-3 * np.nanmax(spectra.psd["chassis"])


@pytest.mark.property
def test_shifting_gears_does_not_smear_orders():
    """Engine speed jumps by a third at each shift: no window reaches across, and levels stay those of the orders."""

    def gear(time):
        return 1.0 + np.floor(time / 6.0)

    def saw(time):
        return 1200.0 + 100.0 * np.mod(time, 6.0)

    time = MILLISECONDS / 1e3
    whole, part = np.floor(time / 6.0), np.mod(time, 6.0)
    turns = (whole * (1200.0 * 6.0 + 50.0 * 36.0) + 1200.0 * part + 50.0 * part**2) / 60.0
    made = driven(made_recording(MILLISECONDS, accelerations(turns)), lambda t: 5.0 + t / 6.0, saw, gear)
    found = analyse(made)
    assert found.order_levels
    for level in found.order_levels:
        assert level.rms["chassis"]["x"] == pytest.approx(AMPLITUDES[level.order] / np.sqrt(2.0), rel=0.03), level


@pytest.mark.property
def test_orders_stand_out_of_noise_and_do_not_need_a_whole_bag():
    """White noise adds its share of the band; a gap ends the windows, and the rest is there."""
    noise = 0.2
    made = made_recording(MILLISECONDS, accelerations(turns_of(MILLISECONDS / 1e3), noise=noise))
    kept = np.flatnonzero((MILLISECONDS < 9000) | (MILLISECONDS > 9500))
    cut = {sensor: getattr(made, sensor).at(kept) for sensor in ("chassis", "powertrain")}
    found = analyse(driven(made, speed_up, run_up)._replace(**cut))
    assert found.timing["chassis/imu"].gap_count == 1
    for level in found.order_levels:
        band = 0.5 * level.engine_speed / 60.0  # Hz about the order
        rms = np.hypot(AMPLITUDES[level.order] / np.sqrt(2.0), noise * np.sqrt(band / 500.0))
        assert level.rms["chassis"]["x"] == pytest.approx(rms, rel=0.06), level


@pytest.mark.property
def test_without_a_speed_that_varies_there_are_none(recording):
    """No drive, a steady one, an engine that stands still."""
    for engine in (lambda time: np.full(len(time), 1650.0), lambda time: np.zeros(len(time))):
        found = analyse(driven(recording, speed_up, engine))
        assert found.order_levels == () and found.order_spectra is None
    found = analyse(recording._replace(drive=None))
    assert found.order_levels == () and found.order_spectra is None
    assert [diagram.over for diagram in found.campbell] == ["speed"]


@pytest.mark.analytic
def test_campbell_diagrams_have_their_ridges_on_the_rays(recording):
    """Over engine speed and over speed the greatest level lies on order 6; link passing is v over the pitch."""
    by_engine, by_speed = analyse(recording).campbell
    assert (by_engine.over, by_speed.over) == ("engine speed", "speed")
    for diagram, name in ((by_engine, "engine order 6"), (by_speed, "engine order 6, gear 1")):
        rays = {ray.name: ray for ray in diagram.rays}
        (x, y), (x_end, y_end) = rays[name].ends
        wanted = y + (diagram.value - x) * (y_end - y) / (x_end - x)
        level = diagram.psd["chassis"]
        there = np.isfinite(level[:, 0])
        ridge = diagram.frequency[level[there].argmax(axis=1)]
        assert there.sum() > 10 and np.abs(ridge - wanted[there]).max() <= 6.0  # Hz: within a band it sweeps as much
    passing = {ray.name: ray.ends for ray in by_engine.rays}["link passing 1, gear 1"]
    pitch = {ray.name: ray.ends for ray in by_speed.rays}["link passing 1"]
    assert pitch[1][1] / pitch[1][0] * 1.0 / 200.0 == pytest.approx(passing[1][1] / passing[1][0], rel=1e-3)


@pytest.mark.property
def test_odd_drives_do_no_harm(recording):
    """Numbers that are none and speeds that no engine has are left out; a slow sensor tells low orders only."""
    engine = np.array(recording.drive.engine_speed)
    engine[1000:1100], engine[1500:1510], distance = np.nan, 1e100, np.full(len(engine), 1e100)
    odd = recording._replace(drive=recording.drive._replace(engine_speed=engine, distance=distance))
    found = analyse(odd)
    assert found.by_way == () and len(found.by_speed) > 1
    acceleration = np.array(recording.chassis.specific_force)
    acceleration[15_000, 0] = np.nan
    holed = recording._replace(chassis=recording.chassis._replace(specific_force=acceleration))
    assert len(analyse(holed).order_levels) > 30
    slow = {sensor: getattr(recording, sensor).at(slice(9, None, 10)) for sensor in ("chassis", "powertrain")}
    spectra = analyse(recording._replace(mounts=None, answers=None, **slow)).order_spectra
    told = np.isfinite(spectra.psd["chassis"][:, :, 2])
    assert spectra.order[told.any(axis=0)].max() * spectra.engine_speed[told.any(axis=1)].min() / 60.0 < 100.0


@pytest.mark.property
def test_lines_use_the_recorded_engine_speed():
    """Not what the simulator was told, 1650 r/min; the band takes in how much it varied."""
    made = made_recording(MILLISECONDS[:8000])
    steady = analyse(driven(made, lambda time: np.full(len(time), 10.0), lambda time: np.full(len(time), 1500.0)))
    assert (steady.engine_speed, steady.engine_speed_deviation) == (1500.0, 0.0)
    lines = {line.name: line for line in steady.lines}
    assert lines["engine order 2"].frequency == 50.0 and lines["engine order 2"].high == 52.0
    told = analyse(made)
    assert told.engine_speed == 1650.0 and told.campbell == ()
    assert {line.name: line.frequency for line in told.lines}["engine order 2"] == 55.0
