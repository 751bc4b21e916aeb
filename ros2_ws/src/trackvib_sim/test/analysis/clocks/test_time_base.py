"""Clocks of real sensors: coarse, late, drifting; numbers as if they were perfect, and what was done is told."""

import numpy as np
import pytest
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.clocks.mending import NoClock
from trackvib_sim.analysis.clocks.time_base import on_one_time_base

from .made_sensors import both, nanoseconds, recorded, sensor, times
from .right_numbers import LOGGED, require_right, says

MS = 1e-3  # s


@pytest.mark.analytic
@LOGGED
@pytest.mark.parametrize("rate", [150.0, 300.0, 416.0, 550.0, 600.0, 833.0, 990.0, 1010.0, 1200.0])
def test_whole_milliseconds_at_any_rate(rate, logged):
    """The rate is that of the samples, whatever steps the stamps make; nothing is taken for lost."""
    time = times(rate, 12.0)
    found = analyse(both(time, np.floor(time / MS) * MS, logged=logged, highest=0.42 * rate))
    require_right(found, rate, tones=True)
    assert found.measured == pytest.approx(10.0, abs=0.01) and not says(found, "gaps")
    assert says(found, "chassis/imu: stamps are not even", "ms RMS")


@pytest.mark.analytic
@pytest.mark.parametrize("rate", [300.0, 600.0, 833.0, 499.98])
def test_exact_stamps_at_rates_that_are_no_whole_period(rate):
    """They are even as they stand."""
    found = analyse(both(times(rate, 10.0)))
    require_right(found, rate)
    assert found.clocks == {} and found.loop["lost_chassis"] == 0


def jittered(time, rate, share):
    return time + np.random.default_rng(5).normal(scale=share / rate, size=len(time))


def in_batches(time, size):
    return np.repeat(time[size - 1 :: size], size)[: len(time)]


def in_random_batches(time):
    random, told, begin = np.random.default_rng(6), time.copy(), 0
    while begin < len(time):
        end = min(begin + int(random.integers(1, 7)), len(time))
        told[begin:end] = time[end - 1]
        begin = end
    return told


def repeated(time, every):
    told = time.copy()
    told[7::every] = told[6::every][: len(told[7::every])]
    return told


@pytest.mark.analytic
@LOGGED
@pytest.mark.parametrize(
    ("rate", "told"),
    [
        (1000.0, lambda time: jittered(time, 1000.0, 0.1)),
        (1000.0, lambda time: jittered(time, 1000.0, 0.35)),
        (400.0, lambda time: jittered(time, 400.0, 0.5)),
        (1000.0, lambda time: in_batches(time, 2)),
        (1000.0, lambda time: in_batches(time, 3)),
        (1000.0, lambda time: in_batches(time, 8)),
        (800.0, in_random_batches),
        (400.0, lambda time: repeated(time, 401)),
        (250.0, lambda time: repeated(time, 53)),
    ],
    ids=["jitter 10 %", "jitter 35 %", "jitter 50 %", "pairs", "threes", "eights", "bursts", "repeated", "often"],
)
def test_late_stamps_lose_no_sample(rate, told, logged):
    """Jitter, bursts, repeated stamps: samples follow each other evenly, and how far the stamps are off is told."""
    time = times(rate, 12.0)
    found = analyse(both(time, told(time), logged=logged, highest=0.42 * rate))
    require_right(found, rate, tones=True)
    assert found.measured == pytest.approx(10.0, abs=0.02) and not says(found, "gaps")
    assert found.clocks["chassis/imu"].lost == 0 and found.clocks["chassis/imu"].correction > 0.0


@pytest.mark.property
@LOGGED
@pytest.mark.parametrize("blur", [0.0, 0.2])
def test_lost_samples_are_told_from_jitter(blur, logged):
    """Five of 30000, in three places: each ends a stretch, and they are counted."""
    time = times(1000.0, 30.0)
    kept = np.setdiff1d(np.arange(len(time)), [5000, 5001, 5002, 12000, 21000])
    told = jittered(time, 1000.0, blur) if blur else time
    found = analyse(both(time, told, logged=logged, kept=kept))
    require_right(found, 1000.0)
    assert found.timing["chassis/imu"].gap_count == 3
    if blur:
        assert found.clocks["chassis/imu"].lost == 5
    else:
        assert found.clocks == {} and found.timing["chassis/imu"].missing == 5


@pytest.mark.property
def test_swapped_pairs_are_put_in_order():
    """Two samples change places now and then, with or without the recorder's own times."""
    time = times(1000.0, 10.0)
    order = np.arange(len(time))
    for k in range(500, len(time) - 1, 1000):
        order[[k, k + 1]] = order[[k + 1, k]]
    for logged in (nanoseconds(time), nanoseconds(time[order])):
        pair = (sensor(time, gain, kept=order)._replace(logged=logged) for gain in (1.0, 0.5))
        found = analyse(recorded(*pair))
        require_right(found, 1000.0)
        assert found.measured == 8.0 and says(found, "20 samples were sorted by their stamps")


@pytest.mark.analytic
@pytest.mark.parametrize("ppm", [20.0, -200.0, 3000.0, -20000.0])
@pytest.mark.parametrize("coarse", [False, True])
def test_clocks_that_drift_apart(ppm, coarse):
    """The powertrain's samples are brought to the chassis's instants; coherence is 1 up to 0.4 of the rate."""
    rate = 400.0 if coarse else 1000.0
    pair = [times(each, 30.0) for each in (rate, rate * (1.0 + 1e-6 * ppm))]
    told = [np.floor(time / MS) * MS if coarse else time for time in pair]
    made = (sensor(*each, highest=0.41 * rate) for each in zip(pair, (1.0, 0.5), told, strict=True))
    found = analyse(recorded(*made))
    require_right(found, rate, tones=True)
    word = "faster" if ppm > 0 else "slower"
    assert says(found, "powertrain/imu samples", word, "resampled, band-limited")


@pytest.mark.analytic
@pytest.mark.parametrize("ppm", [200.0, -2000.0])
def test_each_sensor_stamps_by_a_clock_of_its_own(ppm):
    """Stamps agree, samples do not: the recorder's times, 1 ms late at random, show it."""
    random = np.random.default_rng(8)
    one, other = times(1000.0, 30.0), times(1000.0 * (1.0 + 1e-6 * ppm), 30.0)
    made = [
        sensor(time, gain, told, time + random.exponential(MS, len(time)), highest=400.0)
        for time, gain, told in ((one, 1.0, one), (other, 0.5, np.arange(1, len(other) + 1) / 1000.0))
    ]
    found = analyse(recorded(*made))
    require_right(found, 1000.0, tones=True)
    assert says(found, "by the times at which messages were recorded its clock runs")


@pytest.mark.analytic
@pytest.mark.parametrize("offset", [0.0004, 0.0005, 0.0032, 0.1, 1e6])
def test_stamps_that_do_not_coincide(offset):
    """The same samples, stamped later: a part of a period, some, or by a clock that was never set."""
    time = times(1000.0, 12.0)
    found = analyse(recorded(sensor(time), sensor(time, 0.5, time + offset)))
    require_right(found, 1000.0)
    assert found.measured == pytest.approx(10.0, abs=0.11)
    assert says(found, "recorded at the same time: corrected") == (offset > 1.0)


def wandering(seconds, scatter=0.0, rate=400.0):
    """Return true times of a loop that takes as long as it takes: its period goes up and down by 4 % and scatters."""
    random, number = np.random.default_rng(9), np.arange(int(seconds * rate))
    period = 1.0 + 0.04 * np.sin(2.0 * np.pi * number / rate / 25.0) + random.normal(scale=scatter, size=len(number))
    return np.cumsum(period) / rate


@pytest.mark.analytic
@LOGGED
@pytest.mark.parametrize("coarse", [False, True])
def test_a_rate_that_wanders_smoothly(coarse, logged):
    """Nothing is taken for lost, lines do not smear, and how far the stamps leave even ones is told."""
    time = wandering(50.0)
    found = analyse(both(time, np.floor(time / MS) * MS if coarse else time, logged=logged, highest=0.42 * 400.0))
    require_right(found, 400.0, tones=True)
    assert found.measured == pytest.approx(48.0, abs=0.1)
    assert found.loop["lost_chassis"] == found.loop["lost_powertrain"] == 0
    for axis, tone in (("x", 8.0), ("z", 20.0)):
        psd = found.spectra.psd["chassis"][:, "xyz".index(axis)]
        near = np.abs(found.spectra.frequency - tone) <= 2.0
        level = {8.0: 0.5, 20.0: 2.0}[tone] / np.sqrt(2.0)
        assert np.sqrt(psd[near].sum()) == pytest.approx(level, rel=0.02)
    assert says(found, "chassis/imu: its rate varies from 38", "to 41", "resampled, band-limited, to even instants")


@pytest.mark.property
@LOGGED
@pytest.mark.parametrize("scatter", [0.02, 0.05, 0.15])
def test_periods_that_scatter_are_no_loss(scatter, logged):
    """Each sample is taken when its loop comes round, and stamped then: delays stay, but are no whole samples."""
    time = wandering(50.0, scatter)
    found = analyse(both(time, logged=logged))
    require_right(found, (len(time) - 1) / (time[-1] - time[0]))
    assert found.clocks["chassis/imu"].lost == 0 and found.loop["lost_chassis"] == 0
    kept = np.setdiff1d(np.arange(len(time)), [4000, 4001, 9000])
    if scatter < 0.1:
        assert analyse(both(time, logged=logged, kept=kept)).clocks["chassis/imu"].lost == 3


@pytest.mark.property
def test_parts_in_any_order_and_copies():
    """A file whose second half comes first, and one that has a part twice."""
    time = times(1000.0, 10.0)
    whole = np.arange(len(time))
    for kept, note in (
        (np.roll(whole, 5000), ""),
        (np.append(whole, whole[2000:6000]), "4000 messages are in the recording"),
    ):
        found = analyse(both(time, logged=time - 0.01, kept=kept) if note else both(time, kept=kept))
        require_right(found, 1000.0)
        assert found.measured == 8.0 and (not note or says(found, note))


@pytest.mark.property
@LOGGED
@pytest.mark.parametrize("slower", [1.0, 1.01])
def test_one_sensor_alone_has_its_own_rate(slower, logged):
    """The other one tells no number: the first is what it is beside a sound one, and the other is not brought to it."""
    time, other = times(50.0, 30.0), times(50.0 / slower, 30.0)
    chassis = sensor(time, told=jittered(time, 50.0, 0.1), logged=logged)
    nothing = sensor(other, told=jittered(other, 50.0, 0.1), logged=logged)
    nothing = nothing._replace(specific_force=np.full_like(nothing.specific_force, np.nan))
    found = analyse(recorded(chassis, nothing))
    assert found.rate == pytest.approx(50.0, rel=1e-4) and found.measured == pytest.approx(28.0, abs=0.1)
    assert found.sensors["chassis"]["x"].rms_raw == pytest.approx(0.5 / np.sqrt(2.0), rel=0.01)
    assert np.isnan(found.sensors["powertrain"]["z"].rms)
    assert not says(found, "resampled") and not says(found, "gaps")


@pytest.mark.property
def test_even_stamps_stay_as_they_are():
    """Not a bit of a simulator's recording is changed."""
    recording = both(times(1000.0, 5.0))
    found = on_one_time_base(recording)
    assert found.chassis is recording.chassis and found.powertrain is recording.powertrain
    assert found.clocks == {} and found.notes == ()


@pytest.mark.property
def test_stamps_that_are_no_time_base_are_refused():
    """All zero, or of steps that tell nothing: with counts, and the way out where the recorder's times go on."""
    time = times(1000.0, 8.0)
    zero = np.zeros(len(time), np.int64)
    with pytest.raises(NoClock, match="all 8000 header stamps of powertrain/imu are zero; `--time log` uses"):
        on_one_time_base(recorded(sensor(time), sensor(time, 0.5, stamp=zero)))
    for logged in (True, False):
        with pytest.raises(
            NoClock, match=r"stamps of chassis/imu do not increase: 7999 steps, 7992 of 0 ms, 7 of 1000"
        ):
            on_one_time_base(both(time, np.ceil(time), logged=logged))
        with pytest.raises(NoClock, match=r"stamps of chassis/imu do not increase: 7999 steps, 7999 of 0 ms"):
            on_one_time_base(both(time, np.full(len(time), 5.0), logged=logged))
