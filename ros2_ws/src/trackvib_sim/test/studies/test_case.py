"""One case of a study: the shipped vehicle over a short stretch of measured road."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from trackvib_sim.analysis.vibration import rms
from trackvib_sim.studies.case import PROBES, RATES, Case, drive, prepare, probes, record, settling
from trackvib_sim.vehicle.step_size import recommended_rate

pytestmark = pytest.mark.property

CASE = Case("E", 20.0, 1, 0.5)
DURATION = 0.5  # s


@pytest.fixture(scope="module")
def result(vehicle):
    """The result of the case."""
    return drive(vehicle, CASE, DURATION)


def test_a_drive_gives_the_levels_of_its_settled_part(vehicle, result):
    """The same case a second time gives the same numbers to the last bit, and they are those of the record."""
    recorded = record(*prepare(vehicle, CASE), DURATION)
    assert result.status == "ok"
    assert tuple(result.rms) == PROBES
    for probe, level in result.rms.items():
        assert recorded.limited[probe].shape == (round(DURATION * recorded.rate), 3)
        assert level == tuple(rms(recorded.limited[probe]))
        assert min(level) > 0.1
    assert recorded.time[0] == pytest.approx(settling(20.0) + 1.0 / recorded.rate)
    assert result.mean_speed == recorded.speed.mean() == pytest.approx(20.0, rel=0.01)


@pytest.mark.parametrize("times", [1.0, 16.0])
def test_steps_are_as_short_as_the_contacts_need(vehicle, times):
    """Stiffer teeth get more steps in a control period, which stays as long."""
    teeth = vehicle.sprocket_teeth.model_copy(update={"stiffness": times * vehicle.sprocket_teeth.stiffness})
    other = vehicle.model_copy(update={"sprocket_teeth": teeth})
    simulation, _ = prepare(other, CASE)
    rates = simulation.settings.rates
    assert rates.physics == max(RATES.physics, recommended_rate(other)) and rates.control == RATES.control
    assert (rates.physics > RATES.physics) == (times > 1.0)


def test_rigid_baseline_is_the_hull_at_the_powertrains_sensor(vehicle, result):
    """The powertrain turns about the hull's lateral axis only, so across the vehicle both points move alike."""
    chassis, powertrain, rigid = (np.array(result.rms[probe]) for probe in PROBES)
    assert rigid[1] == pytest.approx(powertrain[1], rel=0.01)
    assert rigid[2] != pytest.approx(powertrain[2], rel=0.01)
    at_rear, at_sensor = (np.array(probes(vehicle)[k].place) for k in (0, 2))
    assert_allclose(at_sensor - at_rear, vehicle.mounts["left"].place * np.array((1.0, 0.0, 1.0)))
    assert [probe.body for probe in probes(vehicle)] == ["hull", "powertrain", "hull"]


@pytest.mark.parametrize("change", [{"seed": 2}, {"track_phase": 0.2}, {"current": 2.0}, {"road_class": "A"}])
def test_every_part_of_a_case_changes_its_levels(vehicle, result, change):
    """Road, phase between the tracks and current in the mounts all reach the sensors."""
    other = drive(vehicle, replace(CASE, **change), DURATION)
    assert other.status == "ok"
    assert max(abs(a / b - 1.0) for a, b in zip(other.rms["powertrain"], result.rms["powertrain"], strict=True)) > 1e-3


def test_leaving_the_valid_range_is_a_result(vehicle):
    """Class H at 25 m/s throws the vehicle about until a run fails, with reason and time and without levels."""
    failed = drive(vehicle, Case("H", 25.0, 1, 0.5))
    assert failed.status.startswith("failed: ") and " after t = " in failed.status
    assert failed.rms == {} and failed.mean_speed is None


def test_a_vehicle_that_cannot_roll_is_a_result(changed):
    """A driver who steers far too hard throws the vehicle off before its run begins; that, too, is said."""
    failed = drive(changed("driver", heading_gain=1e12), CASE, DURATION)
    assert failed.status.startswith("failed: the vehicle cannot roll at 20 m/s on a level road: ")
    assert failed.status.endswith("; check the vehicle file")
