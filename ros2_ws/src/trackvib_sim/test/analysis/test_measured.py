"""What was not measured is no number, and g is not m/s²."""

import numpy as np
import pytest
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.clocks.mending import NoClock
from trackvib_sim.analysis.measured import STANDARD_GRAVITY, in_unit
from trackvib_sim.analysis.report.report_data import build_report_data

from .clocks.made_sensors import RMS_Z, both, recorded, sensor, times

pytestmark = pytest.mark.property
GAINS = {"chassis": 1.0, "powertrain": 0.5}
TIME = times(1000.0, 10.0)
EACH = pytest.mark.parametrize("name", GAINS)


def pair(**changed):
    """Return a recording of both sensors, of which some are changed by functions of an `Inertial`."""
    made = {name: changed.get(name, lambda inertial: inertial)(sensor(TIME, gain)) for name, gain in GAINS.items()}
    return recorded(**made)


def with_nan(inertial, where=5000):
    force = inertial.specific_force.copy()
    force[where] = np.nan
    return inertial._replace(specific_force=force)


def in_g(inertial):
    return inertial._replace(specific_force=inertial.specific_force / STANDARD_GRAVITY)


def never_measured(inertial):
    return inertial._replace(specific_force=0.0 * inertial.specific_force, covariance=np.full(len(TIME), -1.0))


@EACH
def test_a_sample_that_is_no_number_ends_a_stretch(name):
    """Of either sensor: two stretches of 3 s count, with the numbers of a whole recording."""
    found = analyse(pair(**{name: with_nan}))
    assert found.measured == pytest.approx(6.0, abs=0.01)
    for each, gain in GAINS.items():
        assert found.sensors[each]["z"].rms == pytest.approx(gain * RMS_Z, rel=0.01)
    assert any(f"{name}/imu: samples that are not finite: 1" in note for note in found.notes)
    assert np.isfinite(found.spectra.coherence[:, 2]).all()


def test_samples_whose_covariance_denies_them_are_none():
    """Some of a sensor that else measures: as if they were lost."""
    covariance = np.zeros(len(TIME))
    covariance[5000:5100] = -1.0
    found = analyse(pair(chassis=lambda inertial: inertial._replace(covariance=covariance)))
    assert found.measured == pytest.approx(5.9, abs=0.01)
    assert found.sensors["chassis"]["z"].rms == pytest.approx(RMS_Z, rel=0.01)


@EACH
@pytest.mark.parametrize("how", [never_measured, lambda inertial: with_nan(inertial, slice(None))])
def test_a_sensor_that_measures_nothing_has_no_numbers(name, how):
    """Its covariance says so, or every sample: nothing in place of 0, the other one as ever, and a report."""
    recording = pair(**{name: how})
    found = analyse(recording)
    other = "powertrain" if name == "chassis" else "chassis"
    assert np.isnan([found.sensors[name][axis].rms for axis in "xyz"]).all()
    assert np.isnan(found.spectra.transmissibility).all() and np.isnan(found.absorbed_power[name])
    assert found.sensors[other]["z"] == analyse(pair()).sensors[other]["z"]
    assert any(f"{name}/imu: acceleration was not measured" in note for note in found.notes)
    assert build_report_data(recording, found).analysis is found


def test_two_sensors_that_measure_nothing_are_refused():
    """With the reason of each."""
    with pytest.raises(NoClock, match="neither chassis/imu nor powertrain/imu measured an acceleration.*covariance"):
        analyse(pair(chassis=never_measured, powertrain=never_measured))


def test_too_many_samples_that_are_no_numbers_are_refused_with_counts():
    """Every 500th: no stretch is left, and the message says why."""
    with pytest.raises(ValueError, match=r"10 s long, but no part of it has the 3 s .* gaps: 19 in chassis/imu"):
        analyse(pair(chassis=lambda inertial: with_nan(inertial, slice(500, None, 500))))


@pytest.mark.parametrize("names", [("chassis",), ("powertrain",), ("chassis", "powertrain")])
def test_accelerations_in_g(names):
    """It is noticed by the mean; told, those sensors are converted that are not in m/s² already."""
    recording = pair(**dict.fromkeys(names, in_g))
    found = analyse(recording)
    assert [note.split(":")[0] for note in found.notes if "--unit g" in note] == list(names)
    found = analyse(in_unit(recording, "g"))
    for name, gain in GAINS.items():
        assert found.sensors[name]["z"].rms == pytest.approx(gain * RMS_Z, rel=0.01)
        assert found.sensors[name]["z"].mean == pytest.approx(9.81, rel=1e-3)
        word = "converted from g" if name in names else "not converted"
        assert any(name in note and word in note for note in found.notes)
    assert not any("--unit g" in note for note in found.notes)


def test_metres_are_left_alone():
    """No conversion without the word for it, and no suspicion."""
    recording = both(TIME)
    assert in_unit(recording, "m/s2") is recording
    assert not any("unit" in note for note in analyse(recording).notes)
