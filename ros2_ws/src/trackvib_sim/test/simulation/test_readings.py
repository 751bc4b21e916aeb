"""What sensors read: their low-pass against its formula, their turns, the errors of their instruments."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.signal import butter
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.readings import Readings, noise_level
from trackvib_sim.simulation.sensing import BY_DEFAULT, ORDER, WIDEST, low_pass
from trackvib_sim.simulation.simulation import Probe
from trackvib_sim.vehicle.parameters import SensorParameters
from trackvib_sim.vehicle.sensors import Instrument, sensors_of

pytestmark = pytest.mark.analytic

ROAD = Iso8608Road("E", 2, 8.0, 8.0)
SEAT, GUN = [0.0, 0.0, 0.5], [1.0, 0.0, 0.0]


@pytest.fixture(scope="module")
def with_sensors(vehicle):
    """A function: the vehicle with a slow sensor in the turret and one on the gun, of other items given."""

    def made(**items):
        given = {"seat": {"body": "turret", "place": SEAT, "divisor": 7}, "gun": {"body": "gun_mount", "place": GUN}}
        sensors = {name: SensorParameters.model_construct(**(given[name] | items.get(name, {}))) for name in given}
        return vehicle.model_copy(update={"sensors": sensors})

    return made


@pytest.fixture
def measured(with_sensors, simulation):
    """A function: a simulation of such a vehicle at 10 m/s, with probes where the sensors are."""

    def made(**items):
        probes = Probe("turret", SEAT), Probe("gun_mount", GUN)
        return simulation(10.0, vehicle=with_sensors(**items), probes=probes)

    return made


def followed(simulation, drive, periods):
    """Return what is read in each period, and all samples (k, sensors, 2, 3)."""
    readings, found, samples = Readings(simulation), [], []
    for moving in drive(simulation, ROAD, periods):
        found.append({name: np.array(reading) for name, reading in readings.take().items()})
        samples.append(np.stack((moving.sample.specific_force, moving.sample.angular_velocity), axis=1))
    return found, np.array(samples)


def test_each_reads_at_its_turn(measured, drive):
    """At its turn each reads, to the last bit, what its low-pass gives then."""
    found, samples = followed(measured(), drive, 30)
    for k, read in enumerate(found, 1):
        assert list(read) == ["chassis", "powertrain", *(["seat"] if k % 7 == 0 else []), "gun"]
        for row, name in enumerate(("chassis", "powertrain", "seat", "gun")):
            if name in read:
                assert_array_equal(read[name], samples[k - 1, row])


@pytest.mark.cross_engine
@pytest.mark.parametrize(("corner", "rate"), [(400.0, 5e3), (400.0, 1e4), (20.0, 8e3), (123.4, 7e3), (1800.0, 4e3)])
def test_sections_are_those_of_scipy(corner, rate):
    """To rounding, but for the gain, which is 1 in every section of ours."""
    b, a = np.split(butter(ORDER, corner, fs=rate, output="sos"), 2, axis=1)
    expected = np.hstack((b * (a.sum(axis=1) / b.sum(axis=1))[:, None], a[:, 1:]))
    assert_allclose(low_pass(corner, rate), expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("corner", [40.0, 57.0, 400.0, 4000.0])
def test_low_pass_is_a_butterworth(corner):
    """Its magnitude is that of the formula with frequencies bent by the bilinear transform; gain 1 at 0."""
    rate = 10_000.0
    frequency = np.array([0.0, 0.5, 0.9, 1.0, 1.1, 1.24]) * corner
    z = np.exp(2j * np.pi * frequency / rate)[:, None]
    b0, b1, b2, a1, a2 = low_pass(corner, rate).T
    found = np.abs(np.prod((b0 + b1 / z + b2 / z**2) / (1.0 + a1 / z + a2 / z**2), axis=1))
    bent = np.tan(np.pi * frequency / rate) / np.tan(np.pi * corner / rate)
    assert_allclose(found, 1.0 / np.sqrt(1.0 + bent ** (2 * ORDER)), rtol=1e-6, atol=1e-12)


def test_beyond_what_the_steps_show_nothing_is_filtered(measured, drive):
    """A sensor wider than `WIDEST` of the physics rate reads what a probe meets in the last step of the period."""
    moving = measured(gun={"bandwidth": 1.01 * WIDEST * 10_000.0})
    for now in drive(moving, ROAD, 20):
        assert_array_equal(now.sample.specific_force[3], now.sample.probed[-1, 1])


def test_filters_run_at_the_physics_rate(measured, drive):
    """What a sensor reads is the probe's signal of all steps through the low-pass, which began at rest."""
    probed, read = [], []
    moving = measured()
    readings = Readings(moving)
    for now in drive(moving, ROAD, 70):
        probed.append(now.sample.probed[:, 0].copy())
        read += [reading.specific_force.copy() for name, reading in readings.take().items() if name == "seat"]
    signal = np.concatenate(probed)
    sections = low_pass(BY_DEFAULT * 1000.0 / 7.0, 10_000.0)
    for b0, b1, b2, a1, a2 in sections:
        last_x, older_x, last_y, older_y = (signal[0],) * 4
        steps = []
        for x in signal:
            y = b0 * x + b1 * last_x + b2 * older_x - a1 * last_y - a2 * older_y
            last_x, older_x, last_y, older_y = x, last_x, y, last_y
            steps.append(y)
        signal = np.array(steps)
    assert_allclose(read, signal[69::70], rtol=1e-9, atol=1e-9)


def test_instruments_have_their_errors(with_sensors, measured, drive):
    """Bias and noise are added, range cuts, and all is rounded to the resolution; the other sensors stay."""
    ideal, _ = followed(measured(), drive, 400)
    errors = {
        "bias": [0.5, -0.2, 0.0], "noise": 0.01, "range": 200.0, "resolution": 0.04,
        "rate_noise": 0.001, "rate_bias": [0.0, 0.0, 0.1],
    }  # fmt: skip
    found, _ = followed(measured(gun=errors, seat={"range": 9.5}), drive, 400)
    for one, other in zip(ideal, found, strict=True):
        assert_array_equal(one["chassis"], other["chassis"])
    force, rate = np.moveaxis(np.array([read["gun"] for read in found]), 1, 0)
    true_force, true_rate = np.moveaxis(np.array([read["gun"] for read in ideal]), 1, 0)
    seat = np.array([read["seat"][0] for read in found if "seat" in read])
    assert np.abs(seat).max() == 9.5 and (seat[:, 2] == 9.5).any() and np.ptp(seat[:, 2]) > 0.0
    assert_allclose(force / 0.04, np.round(force / 0.04), atol=1e-9)
    error = (force - true_force)[:, :2]
    level = noise_level(Instrument(noise=0.01), 1000.0)
    assert level == pytest.approx(0.01 * np.sqrt(500.0))
    # 800 numbers: their deviation is good to 1 / sqrt(1600), four times that; rounding adds 0.04 / sqrt(12)
    assert_allclose(error.mean(axis=0), (0.5, -0.2), atol=5.0 * level / np.sqrt(400.0))
    assert error.std(axis=0).mean() == pytest.approx(np.hypot(level, 0.04 / np.sqrt(12.0)), rel=0.1)
    assert_allclose((rate - true_rate).mean(axis=0), (0.0, 0.0, 0.1), atol=5.0 * 0.001 * np.sqrt(500.0 / 400.0))
    own = sensors_of(with_sensors(gun=errors))[-1]
    assert own.accelerometer == Instrument(0.01, (0.5, -0.2, 0.0), 200.0, 0.04) and not own.gyroscope.is_ideal


@pytest.mark.property
def test_after_a_reset_it_begins_anew(measured, drive):
    """What was met before does not count: filters and noise begin as in the first run."""
    moving = measured(seat={"noise": 0.01})
    readings = Readings(moving)
    first = [readings.take() for _ in drive(moving, ROAD, 14)]
    moving.reset()
    again = [readings.take() for _ in drive(moving, ROAD, 14)]
    assert [list(read) for read in first] == [list(read) for read in again]
    for one, other in zip(first, again, strict=True):
        for name, reading in one.items():
            assert_array_equal(reading, other[name])
