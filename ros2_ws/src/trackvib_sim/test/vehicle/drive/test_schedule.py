"""What is wanted over time or distance, and the files that say so."""

import numpy as np
import pytest
from trackvib_sim.vehicle.drive.drive_file import DriveFileError, drive_text, parse_drive
from trackvib_sim.vehicle.drive.schedule import (
    Schedule,
    arrival_time,
    new_wanted,
    wanted_curvature,
    wanted_speed,
)


@pytest.mark.analytic
def test_speed_and_curvature_are_over_time_or_distance():
    """What a point says holds at its time or place; a command replaces both."""
    at = np.array([0.0, 10.0])
    table = Schedule(True, at, np.array([2.0, 4.0]), np.array([0.0, 0.05]), np.zeros(2))
    for by_distance, distance, time in ((True, 5.0, 0.0), (False, 0.0, 5.0)):
        schedule = table._replace(by_distance=by_distance)
        wanted = new_wanted(schedule)
        wanted.time[0] = time
        assert wanted_speed(schedule, wanted, distance) == pytest.approx(3.0)
        assert wanted_curvature(schedule, wanted, distance) == pytest.approx(0.025)
        wanted.command[:], wanted.commanded[0] = (1.5, -0.01), True
        assert (wanted_speed(schedule, wanted, distance), wanted_curvature(schedule, wanted, distance)) == (1.5, -0.01)


@pytest.mark.analytic
@pytest.mark.parametrize(
    ("by_distance", "at", "speed", "distance", "expected"),
    [
        (False, [0.0], [5.0], 10.0, 2.0),
        (False, [0.0], [-5.0], 10.0, 2.0),
        (False, [0.0, 4.0], [0.0, 8.0], 16.0, 4.0),
        (False, [1.0, 3.0], [2.0, 6.0], 14.0, 3.0 + 4.0 / 6.0),
        (False, [0.0, 2.0], [4.0, 0.0], 5.0, np.inf),
        (True, [0.0], [5.0], 10.0, 2.0),
        (True, [0.0, 10.0], [5.0, 10.0], 10.0, 2.0 * np.log(2.0)),
        (True, [2.0, 4.0], [1.0, 1.0], 10.0, 10.0),
    ],
)
def test_arrival(by_distance, at, speed, distance, expected):
    """The time at which so many metres are done is the integral's."""
    zeros = np.zeros(len(at))
    schedule = Schedule(by_distance, np.array(at), np.array(speed), zeros, zeros)
    assert arrival_time(schedule, distance) == pytest.approx(expected)


@pytest.mark.analytic
def test_a_file_becomes_a_schedule():
    """Numbers are those of the file, what is not said is straight on and at the given engine speed."""
    text = "over: distance\npoints:\n  - {at: 0, speed: 5}\n  - {at: 20.5, speed: 8, curvature: -0.02}\n"
    schedule = parse_drive(text, 1650.0, "drive")
    assert schedule.by_distance and schedule.at.tolist() == [0.0, 20.5] and schedule.speed.tolist() == [5.0, 8.0]
    assert schedule.curvature.tolist() == [0.0, -0.02]
    np.testing.assert_allclose(schedule.engine_speed, 1650.0 * np.pi / 30.0)


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "drive"),
        ("[]", "drive"),
        ("points: []", "points"),
        ("points: 5", "points"),
        ("{over: weeks, points: [{at: 0, speed: 1}]}", "over"),
        ("points: [{at: 0}]", "speed"),
        ("points: [{at: 0, speed: fast}]", "speed"),
        ("points: [{at: 0, speed: .nan}]", "speed"),
        ("points: [{at: .inf, speed: 1}]", "at"),
        ("points: [{at: 1e9, speed: 1}]", "at"),
        ("points: [{at: 0, speed: 26}]", "speed is 26.0 m/s, accepted: -25 to 25 m/s"),
        ("points: [{at: 0, speed: 5, curvature: 0.2}]", "curvature is 0.2 1/m, accepted: -0.1 to 0.1 1/m"),
        ("points: [{at: 0, speed: -5, curvature: 0.05}]", "accepted in reverse is 0"),
        ("points: [{at: 0, speed: 1}, {at: 0, speed: 2}]", "point 2: at is 0, must be above 0"),
        ("points: [{at: 2, speed: 1}, {at: 1, speed: 2}]", "point 2: at is 1, must be above 2"),
        ("points: [{at: 0, speed: 1, engine_speed: 900}, {at: 1, speed: 2}]", "1 of 2 points have an engine_speed"),
        ("points: [{at: 0, speed: 1, engine_speed: -9}]", "engine_speed"),
        ("points: [{at: 0, speed: 1, gear: 2}]", "gear"),
        ("{over: distance, points: [{at: 0, speed: 0}]}", "point 1: speed is 0 m/s, over distance at least 0.1"),
        ("points: [{at: 0, speed: 1}]\nroad: C", "road"),
        ("\0", "drive"),
        ("points: [" * 100, "drive"),
    ],
)
def test_a_bad_file_is_refused(text, words):
    """With the file's name, the item and what is accepted."""
    with pytest.raises(DriveFileError) as refused:
        parse_drive(text, 1650.0, "drive.yaml")
    assert "drive.yaml" in str(refused.value) and words in str(refused.value)


@pytest.mark.analytic
@pytest.mark.parametrize(
    ("text", "by_distance", "at", "speed", "curvature"),
    [
        ("time_s,speed_kmh\n0,36\n12.5,72\n", False, [0.0, 12.5], [10.0, 20.0], [0.0, 0.0]),
        (
            "# a bend\ndistance_km;speed_mps;curvature_1/m\n0;5;0\n0.1;6;-1e-05\n",
            True,
            [0.0, 100.0],
            [5.0, 6.0],
            [0, -1e-5],
        ),
        ("speed_mph\ttime_min\n10\t0\n", False, [0.0], [4.4704], [0.0]),
    ],
)
def test_a_csv_file_becomes_the_same_schedule(tmp_path, text, by_distance, at, speed, curvature):
    """Its columns name quantity and unit; the text for the bag has every number to the last bit."""
    path = tmp_path / "drive.csv"
    path.write_text(text, encoding="utf-8")
    schedule = parse_drive(drive_text(path), 1650.0, "drive")
    assert schedule.by_distance == by_distance
    for ours, expected in ((schedule.at, at), (schedule.speed, speed), (schedule.curvature, curvature)):
        np.testing.assert_allclose(ours, expected, rtol=1e-15)


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "its first line must name the columns, like time_s,speed_mps"),
        ("time_s\n0\n", "accepted: time_UNIT,speed_UNIT or distance_UNIT,speed_UNIT"),
        ("time_s,speed_knots\n0,5\n", "UNIT being one of s, min, mps, kmh, mph, m, cm, mm, km, in, ft"),
        ("time_s,speed_mps\n0,fast\n", "line 2: '0,fast', accepted: 2 numbers"),
        ("time_s,speed_mps\n0,nan\n", "speed"),
        ("time_s,speed_mps\n0,1e999\n", "speed"),
        ("time_s,speed_mps\n1,5\n0,5\n", "point 2: at is 0, must be above 1"),
        ("time_s,speed_mps,speed_kmh\n0,5,5\n", "two columns are named speed"),
    ],
)
def test_a_bad_csv_file_is_refused(tmp_path, text, words):
    """With the file's name, the line or item and what is accepted."""
    path = tmp_path / "drive.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DriveFileError) as refused:
        parse_drive(drive_text(path), 1650.0, "drive.csv")
    assert "drive.csv" in str(refused.value) and words in str(refused.value)


@pytest.mark.property
def test_what_is_no_file_is_refused(tmp_path):
    """A folder and a file that is not there, of either kind."""
    for name in ("there.csv", "there.yaml"):
        (tmp_path / name).mkdir()
        for path in (tmp_path / name, tmp_path / f"not_{name}"):
            with pytest.raises(DriveFileError, match=name):
                drive_text(path)


@pytest.mark.slow(reason="reads a file of many points")
@pytest.mark.property
def test_too_many_points_are_refused():
    """The number of points is bounded."""
    points = ", ".join(f"{{at: {k}, speed: 1}}" for k in range(20_001))
    with pytest.raises(DriveFileError, match="points"):
        parse_drive(f"points: [{points}]", 0.0, "drive.yaml")
