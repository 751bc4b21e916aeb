"""Which sensors a recording of others has: any topic, type or file, alone or not; where the vehicle was; refusals."""

import numpy as np
import pytest
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.sources import SourceError, Sources

from .recorded_bags import EPOCH, accel, fix, imu, motion, stream, tf_static, times, transform, vector, write_bag

TIME = times(100, 1)


@pytest.mark.property
@pytest.mark.parametrize("kind", [imu, accel, vector])
def test_any_topic_of_any_type_of_acceleration(tmp_path, kind):
    """With or without a leading slash; where they come from is kept, and the samples are the bag's."""
    bag = write_bag(tmp_path / "a.mcap", {"/s/hull": stream(TIME, kind), "/s/engine": stream(TIME, kind, 0.5)})
    found = read_recording(bag, sources=Sources({"chassis": "/s/hull", "powertrain": "s/engine"}))
    np.testing.assert_allclose(found.chassis.specific_force, motion(TIME))
    np.testing.assert_allclose(found.powertrain.specific_force, motion(TIME, 0.5))
    assert found.origins["powertrain"].source == "/s/engine" and found.origins["chassis"].frame == "sensor"
    assert found.origins["chassis"].type_name == stream(TIME, kind)[0][1].__msgtype__
    np.testing.assert_array_equal(found.chassis.stamp, EPOCH + np.round(TIME * 1e9).astype(np.int64))


@pytest.mark.property
def test_foreign_names_are_refused_with_those_that_are_there(tmp_path):
    """All topics that could be a sensor, with type and count, and the options; others are not listed."""
    topics = {"/a/imu_raw": stream(TIME), "/b": stream(TIME, accel), "/gps": [(EPOCH, fix(EPOCH, 1.0, 2.0))]}
    bag = write_bag(tmp_path / "a.mcap", topics)
    with pytest.raises(BagError, match=r"there are /a/imu_raw .Imu, 100., /b .AccelStamped, 100.: choose by --cha"):
        read_recording(bag)  # neither ends as ours do
    with pytest.raises(BagError, match="no topic '/c' for chassis; there are /a/imu_raw"):
        read_recording(bag, sources=Sources({"chassis": "/c"}))
    with pytest.raises(BagError, match="'/gps' is a sensor_msgs/msg/NavSatFix, accepted: sensor_msgs/msg/Imu, "):
        read_recording(bag, sources=Sources({"chassis": "/gps"}))


@pytest.mark.property
@pytest.mark.parametrize("name", ["chassis", "powertrain"])
def test_one_sensor_is_enough(tmp_path, name):
    """Under either name, by its usual topic or another one; the other has no sample that is a number."""
    other = {"chassis": "powertrain", "powertrain": "chassis"}[name]
    for topic, sources in ((f"/{name}/imu", Sources()), ("/x", Sources({name: "/x"}))):
        found = read_recording(write_bag(tmp_path / "a.mcap", {topic: stream(TIME)}), sources=sources)
        assert set(found.origins) == {name}
        np.testing.assert_allclose(getattr(found, name).specific_force, motion(TIME))
        assert np.isnan(getattr(found, other).specific_force).all()


@pytest.mark.property
def test_further_sensors_by_name_beside_the_usual_ones(tmp_path):
    """A named topic goes before the usual one; what is not named is found by its usual name."""
    topics = {"/chassis/imu": stream(TIME), "/powertrain/imu": stream(TIME, gain=0.5), "/x": stream(TIME, gain=0.25)}
    bag = write_bag(tmp_path / "a.mcap", topics)
    found = read_recording(bag, sources=Sources({"seat": "/x"}))
    assert list(found.sensors) == ["seat"] and list(found.origins) == ["chassis", "powertrain", "seat"]
    found = read_recording(bag, sources=Sources({"chassis": "/x"}))
    np.testing.assert_allclose(found.chassis.specific_force, motion(TIME, 0.25))
    np.testing.assert_allclose(found.powertrain.specific_force, motion(TIME, 0.5))


@pytest.mark.property
def test_sensors_told_twice_are_refused():
    """One topic cannot be two sensors, and an angle is a number."""
    with pytest.raises(SourceError, match="given for two sensors"):
        Sources({"chassis": "/x", "powertrain": "x"})
    with pytest.raises(SourceError, match="roll, pitch and yaw"):
        Sources(rotations={"": (0.0, float("nan"), 0.0)})


@pytest.mark.analytic
def test_fixes_tell_speed_and_way(tmp_path):
    """15 m/s to the north-east by satellite fixes, within half a per cent; odometry of any name goes before them."""
    seconds = np.arange(0.0, 20.0, 0.2)
    north = np.degrees(15.0 * np.sqrt(0.5) * seconds / 6_371_000.0)
    fixes = [
        (int(EPOCH + s * 1e9), fix(int(EPOCH + s * 1e9), 48.0 + n, 11.0 + n / np.cos(np.radians(48.0))))
        for s, n in zip(seconds, north, strict=True)
    ]
    found = read_recording(write_bag(tmp_path / "a.mcap", {"/chassis/imu": stream(TIME), "/gnss": fixes}))
    assert found.odometry.speed == pytest.approx(15.0, rel=5e-3)
    assert np.linalg.norm(found.odometry.position[-1]) == pytest.approx(15.0 * seconds[-1], rel=5e-3)
    assert any("/gnss (NavSatFix)" in note for note in found.notes)


@pytest.mark.property
def test_static_transforms_are_kept(tmp_path):
    """Each frame with the one above it."""
    message = tf_static(transform("base_link", "hull", (0, 0, 0, 1)), transform("hull", "sensor", (0, 0, 1, 0)))
    topics = {"/chassis/imu": stream(TIME), "/tf_static": [(EPOCH, message)]}
    found = read_recording(write_bag(tmp_path / "a.mcap", topics))
    assert found.transforms == {"hull": ("base_link", (0, 0, 0, 1)), "sensor": ("hull", (0, 0, 1, 0))}


def csv_file(path, head, rows, delimiter=","):
    """Write a CSV file."""
    lines = [delimiter.join(head), *(delimiter.join(f"{cell:.9f}" for cell in row) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.property
def test_a_csv_file_is_a_recording(tmp_path):
    """One sensor or both, in g and ms, with names of its own, with semicolons and decimal commas."""
    force, rows = motion(TIME), np.column_stack((TIME, motion(TIME)))
    found = read_recording(csv_file(tmp_path / "a.csv", ("time_s", "x_m/s2", "y_m/s2", "z_m/s2"), rows))
    np.testing.assert_allclose(found.chassis.specific_force, force, atol=1e-8)
    assert set(found.origins) == {"chassis"} and found.chassis.stamp[-1] == 10**9
    both = np.column_stack((1e3 * TIME, force / 9.80665, 0.5 * force / 9.80665))
    head = ("time_ms", *(f"{sensor}_{axis}_g" for sensor in ("chassis", "powertrain") for axis in "xyz"))
    found = read_recording(csv_file(tmp_path / "b.csv", head, both))
    np.testing.assert_allclose(found.powertrain.specific_force, 0.5 * force, atol=1e-7)
    path = csv_file(tmp_path / "c.csv", ("Zeit [s]", "ax", "ay", "az"), rows, ";")
    path.write_text(path.read_text().replace(".", ","))
    own = Sources(csv_columns={"time_s": "Zeit [s]", "x_m/s2": "ax", "y_m/s2": "ay", "z_m/s2": "AZ"})
    np.testing.assert_allclose(read_recording(path, sources=own).chassis.specific_force, force, atol=1e-8)


@pytest.mark.property
def test_csv_files_stand_in_for_topics(tmp_path):
    """Of a sensor each, beside each other or beside a bag."""
    rows = np.column_stack((TIME + EPOCH / 1e9, motion(TIME, 0.5)))
    csv_file(tmp_path / "p.csv", ("time_s", "x_m/s2", "y_m/s2", "z_m/s2"), rows)
    sources = Sources({"powertrain": str(tmp_path / "p.csv")})
    found = read_recording(write_bag(tmp_path / "a.mcap", {"/chassis/imu": stream(TIME)}), sources=sources)
    np.testing.assert_allclose(found.powertrain.specific_force, motion(TIME, 0.5), atol=1e-8)
    assert found.origins["powertrain"].type_name == "CSV"
    assert np.abs(found.powertrain.stamp - found.chassis.stamp).max() < 1000  # seconds since 1970 have so many digits


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t,a,b,c\n1,2,3,4\n", "has the columns t, a, b, c; accepted: time_UNIT,chassis_x_UNIT"),
        ("time_s,x_g,y_g,z_g\n1,2,3,nan\n", "1 times, at least two"),
        ("time_s,x_g,y_g,z_g\n1,2,3\n2,3,4,5\n", "line 2: '1,2,3', accepted: 4 numbers"),
        ("time_s,x_g,y_g,z_g\ninf,2,3,4\n2,3,4,5\n", "all of them finite"),
        ("", "is empty"),
    ],
)
def test_csv_files_that_cannot_be_used_are_refused(tmp_path, text, words):
    """In one line that names the file."""
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(BagError, match=words):
        read_recording(tmp_path / "a.csv")
    with pytest.raises(BagError, match="nowhere.csv"):
        read_recording(tmp_path / "nowhere.csv")
    with pytest.raises(BagError, match=r"has no column q, it has|is empty"):
        read_recording(tmp_path / "a.csv", sources=Sources(csv_columns={"time_s": "q"}))
