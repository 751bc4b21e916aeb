"""Numbers of recordings of others: one sensor, sensors of different rates, turned ones, gravity by orientation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from trackvib_sim.analysis.analyse import analyse
from trackvib_sim.analysis.placement import in_vehicle_axes
from trackvib_sim.analysis.report.page import write_report
from trackvib_sim.analysis.report.report_data import build_report_data
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.sources import BY_ORIENTATION, Sources
from trackvib_sim.bags.transforms import angles_of, rotation_by_angles

from ..bags.recorded_bags import EPOCH, GRAVITY, RMS, motion, stream, tf_static, times, transform, write_bag

ANGLES = (10.0, -20.0, 150.0)  # roll, pitch, yaw of a sensor in the vehicle, deg
TURN = Rotation.from_euler("xyz", ANGLES, degrees=True)  # about fixed axes


def rms_of(analysis, sensor="chassis"):
    """Return the band-limited RMS along x, y, z."""
    return [analysis.sensors[sensor][axis].rms for axis in "xyz"]


@pytest.mark.property
@pytest.mark.parametrize("name", ["chassis", "powertrain"])
def test_what_needs_both_is_null_with_a_note(tmp_path, name):
    """Of one sensor alone its own numbers are right; the report can be written."""
    recording = read_recording(write_bag(tmp_path / "a.mcap", {f"/{name}/imu": stream(times(200, 8))}))
    analysis = analyse(recording)
    other = {"chassis": "powertrain", "powertrain": "chassis"}[name]
    assert rms_of(analysis, name) == pytest.approx(RMS, rel=2e-3)
    assert np.isnan(rms_of(analysis, other)).all() and np.isnan(analysis.spectra.transmissibility).all()
    assert any(note.startswith(f"no {other} in the recording") for note in analysis.notes)
    assert f"{other}/imu" not in analysis.timing and analysis.loop[f"lost_{other}"] is None
    write_report([build_report_data(recording, analysis)], tmp_path / "report.html")


@pytest.mark.analytic
@pytest.mark.parametrize("rates", [(1000.0, 200.0), (200.0, 1000.0), (400.0, 150.0)])
def test_sensors_of_different_rates(tmp_path, rates):
    """Each its own numbers at its own rate; transmissibility 0.5 and coherence 1 on the common band."""
    chassis, powertrain = (stream(times(rate, 10), gain=gain) for rate, gain in zip(rates, (1.0, 0.5), strict=True))
    bag = write_bag(tmp_path / "a.mcap", {"/chassis/imu": chassis, "/powertrain/imu": powertrain})
    analysis = analyse(read_recording(bag))
    assert analysis.rates == {"chassis": pytest.approx(rates[0]), "powertrain": pytest.approx(rates[1])}
    assert analysis.rate == pytest.approx(min(rates))
    assert analysis.spectra.frequency[-1] == pytest.approx(min(rates) / 2.0)
    assert rms_of(analysis) == pytest.approx(RMS, rel=2e-3)
    assert rms_of(analysis, "powertrain") == pytest.approx(0.5 * RMS, rel=2e-3)
    for axis, frequency in ((0, 10), (1, 12), (2, 30), (2, 15)):
        assert analysis.spectra.transmissibility[frequency, axis] == pytest.approx(0.5, rel=5e-3)
        assert analysis.spectra.coherence[frequency, axis] > 0.999
    assert any("each has numbers at its own rate" in note for note in analysis.notes)


@pytest.mark.analytic
def test_angles_are_those_of_static_transforms():
    """Roll, pitch, yaw about fixed axes, as an independent library has them, and back."""
    np.testing.assert_allclose(rotation_by_angles(ANGLES), TURN.as_matrix(), atol=1e-12)
    assert angles_of(rotation_by_angles(ANGLES)) == pytest.approx(ANGLES)


@pytest.mark.analytic
@pytest.mark.parametrize("told", ["option", "bag", "both"])
def test_a_turned_sensor_shows_the_vehicle_s_axes(tmp_path, told):
    """By the option, by the bag's static transforms through two frames; the option goes before the bag."""
    time = times(200, 8)
    topics = {"/chassis/imu": stream(time, force=TURN.inv().apply(motion(time)))}
    if told != "option":
        half = Rotation.from_euler("z", 90.0, degrees=True)
        lower = half.inv() * TURN if told == "bag" else Rotation.from_euler("x", 33.0, degrees=True)
        frames = transform("base_link", "hull", half.as_quat()), transform("hull", "sensor", lower.as_quat())
        topics["/tf_static"] = [(EPOCH, tf_static(*frames))]
    sources = Sources(rotations={} if told == "bag" else {"chassis": ANGLES})
    analysis = analyse(in_vehicle_axes(read_recording(write_bag(tmp_path / "a.mcap", topics)), sources))
    assert rms_of(analysis) == pytest.approx(RMS, rel=2e-3)
    assert analysis.sensors["chassis"]["z"].mean == pytest.approx(GRAVITY, rel=1e-3)
    words = analysis.origins["chassis"]
    assert "10, -20, 150 degrees" in words and ("/tf_static" if told == "bag" else "--rotate") in words


@pytest.mark.property
def test_a_rotation_of_no_sensor_is_refused(tmp_path):
    """And nothing is turned where nobody tells anything."""
    recording = read_recording(write_bag(tmp_path / "a.mcap", {"/chassis/imu": stream(times(100, 1))}))
    with pytest.raises(ValueError, match="a rotation of seat, the sensors are chassis"):
        in_vehicle_axes(recording, Sources(rotations={"seat": ANGLES}))
    assert in_vehicle_axes(recording, Sources()).chassis is recording.chassis


@pytest.mark.analytic
def test_gravity_is_removed_by_orientation(tmp_path):
    """A sensor that tilts by a quarter turn while it measures: what is left is the motion alone, in its own axes."""
    time = times(200, 8)
    shaken = motion(time) - (0.0, 0.0, GRAVITY)
    attitude = Rotation.from_euler("y", np.linspace(0.0, 90.0, len(time))[:, None], degrees=True)
    force = shaken + GRAVITY * attitude.inv().apply((0.0, 0.0, 1.0))
    both = zip(stream(time, force=force), attitude.as_quat(), strict=True)
    messages = [(stamp, stream_with(message, quaternion)) for (stamp, message), quaternion in both]
    sources = Sources(gravity=BY_ORIENTATION)
    recording = read_recording(write_bag(tmp_path / "a.mcap", {"/chassis/imu": messages}), sources=sources)
    found = in_vehicle_axes(recording, sources).chassis.specific_force
    np.testing.assert_allclose(found, shaken, atol=1e-9)
    without = write_bag(tmp_path / "b.mcap", {"/chassis/imu": stream(time)})
    with pytest.raises(ValueError, match="chassis has no orientation for removing gravity; `--gravity mean`"):
        in_vehicle_axes(read_recording(without, sources=sources), sources)


def stream_with(message, quaternion):
    """Return an Imu with an orientation."""
    message.orientation.x, message.orientation.y, message.orientation.z, message.orientation.w = map(float, quaternion)
    message.orientation_covariance[:] = 0.0
    return message


@pytest.mark.property
@pytest.mark.parametrize(
    ("rate", "words"), [(40, "no weighted values"), (100, "hold what is below 50 Hz"), (200, None)]
)
def test_what_a_rate_cannot_hold_is_said(tmp_path, rate, words):
    """Below 50 Hz there are no weighted values, below 200 Hz they lack the upper end of the band."""
    time = times(rate, 8)
    analysis = analyse(read_recording(write_bag(tmp_path / "a.mcap", {"/chassis/imu": stream(time)})))
    said = [note for note in analysis.notes if "sampling rate" in note]
    assert len(said) == (words is not None) and (words is None or words in said[0])
    assert np.isnan(analysis.sensors["chassis"]["z"].rms_weighted) == (rate < 50)
