"""What sensors read: each the mean over its own periods."""

import numpy as np
import pytest
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.readings import Readings
from trackvib_sim.simulation.simulation import Probe
from trackvib_sim.vehicle.sensors import Sensor

pytestmark = pytest.mark.analytic

ROAD = Iso8608Road("E", 2, 8.0, 8.0)


@pytest.fixture
def measured(simulation):
    """A simulation with a slow sensor in the turret and one as fast as the others on the gun."""
    one = simulation(10.0, probes=(Probe("turret", (0.0, 0.0, 0.5)), Probe("gun_mount", (1.0, 0.0, 0.0))))
    one.sensors = [
        *one.sensors,
        Sensor("seat", "turret", (0.0, 0.0, 0.5), divisor=7),
        Sensor("gun", "gun_mount", (1.0, 0.0, 0.0)),
    ]
    return one


def followed(simulation, drive, periods):
    """Return what is read in each period, and all samples (k, sensors, 2, 3)."""
    readings, found, samples = Readings(simulation), [], []
    for moving in drive(simulation, ROAD, periods):
        found.append({name: np.array(reading) for name, reading in readings.take().items()})
        samples.append(np.stack((moving.sample.specific_force, moving.sample.angular_velocity), axis=1))
    return found, np.array(samples)


def test_each_reads_at_its_turn(measured, drive):
    """Those of every period read the sample to the last bit, a slow one the mean since its last reading."""
    found, samples = followed(measured, drive, 30)
    for k, read in enumerate(found, 1):
        assert list(read) == ["chassis", "powertrain", *(["seat"] if k % 7 == 0 else []), "gun"]
        for row, name in ((0, "chassis"), (1, "powertrain"), (3, "gun")):
            np.testing.assert_array_equal(read[name], samples[k - 1, row])
        if k % 7 == 0:
            np.testing.assert_allclose(read["seat"], samples[k - 7 : k, 2].mean(axis=0), rtol=1e-12)


def test_after_a_reset_it_begins_anew(measured, drive):
    """What was gathered before does not count."""
    readings = Readings(measured)
    first = [readings.take() for _ in drive(measured, ROAD, 10)]
    measured.reset()
    again = [readings.take() for _ in drive(measured, ROAD, 10)]
    assert [list(read) for read in first] == [list(read) for read in again]
    np.testing.assert_array_equal(first[6]["seat"], again[6]["seat"])
