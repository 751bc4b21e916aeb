"""Bags of any number of mounts and sensors."""

import numpy as np
import pytest
from mr_mount_controller.mounting import PAIR, Kind, Mount, Mounting, undescribed
from rclpy.serialization import serialize_message
from trackvib_msgs.msg import CoilCurrent
from trackvib_sim.bags.copying import copy_bag
from trackvib_sim.bags.errors import BagError
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.nodes.messages import ImuMessage

from .made_bags import PERIOD, write_bag
from .test_recording import decoded, same

pytestmark = pytest.mark.property

FOUR = Mounting(
    (
        Mount("front left", Kind.MR, (0.5, 0.4, 0.0)),
        Mount("front right", Kind.MR, (0.5, -0.4, 0.0)),
        Mount("rear left", Kind.RUBBER, (-0.5, 0.4, 0.0)),
        Mount("rear right", Kind.RUBBER, (-0.5, -0.4, 0.0)),
    )
)


@pytest.mark.parametrize("mounting", [undescribed(1), undescribed(2), FOUR, undescribed(4), undescribed(16, 32)])
@pytest.mark.parametrize("space", ["/", "/left/of/two/"])
def test_any_number_of_mounts(tmp_path, mounting, space):
    """Columns are what rosbags decodes; names are those that are told, numbers where nobody tells any."""
    write_bag(tmp_path / "told", 40, space, mounting=mounting, told=mounting)
    write_bag(tmp_path / "not_told", 40, space, mounting=mounting)
    told, not_told = read_recording(tmp_path / "told"), read_recording(tmp_path / "not_told")
    assert told.mounting == mounting
    assert not_told.mounting == undescribed(mounting.coils, len(mounting.mounts))
    for recording in (told, not_told):
        assert recording.mounts.current.shape == (40, mounting.coils)
        assert recording.mounts.force.shape == (40, len(mounting.mounts), 3)
    same(not_told, decoded(tmp_path / "not_told"))
    np.testing.assert_array_equal(told.mounts.force, not_told.mounts.force)


def test_without_a_coil(tmp_path):
    """Mount states have no current, and answers are empty."""
    write_bag(tmp_path / "bag", 40, mounting=undescribed(0, 3), told=undescribed(0, 3))
    recording = read_recording(tmp_path / "bag")
    assert recording.mounts.current.shape == recording.answers.current.shape == (40, 0)
    assert recording.mounts.stiffness.shape == (40, 3)


@pytest.mark.parametrize(
    ("mounting", "told", "words"),
    [
        (undescribed(3), FOUR, "mount_description describes 2 coils and 4 mounts, mount_state has 3 and 3"),
        (PAIR, PAIR._replace(mounts=PAIR.mounts[:1] * 2), "mount names are left, left"),
    ],
)
def test_what_is_told_must_fit(tmp_path, mounting, told, words):
    """Names for other mounts than there are would be worse than none."""
    write_bag(tmp_path / "bag", 10, mounting=mounting, told=told)
    with pytest.raises(BagError, match=words):
        read_recording(tmp_path / "bag")


def test_answers_of_another_number_are_none(tmp_path):
    """Of a controller beside ours, before and among its own; they are counted as messages all the same."""
    write_bag(tmp_path / "bag", 20)
    writer = BagWriter(tmp_path / "mixed")
    writer.add_topic("/coil_current", "trackvib_msgs/msg/CoilCurrent", [], "")
    for k in range(100):
        writer.write("/coil_current", k, serialize_message(CoilCurrent(current=[1.0] * (1 + 2 * (k % 2)))))
    copy_bag(tmp_path / "bag", writer)
    writer.close()
    first, second = read_recording(tmp_path / "bag"), read_recording(tmp_path / "mixed")
    assert second.counts["/coil_current"] == 120
    for before, after in zip(first.answers, second.answers, strict=True):
        np.testing.assert_array_equal(before, after)


def test_further_sensors(tmp_path):
    """Each beside chassis and powertrain, by its name, with the rate that it has; none of another vehicle."""
    write_bag(tmp_path / "bag", 40, space="/mine/")
    writer, imu, random = BagWriter(tmp_path / "more"), ImuMessage("link"), np.random.default_rng(3)
    copy_bag(tmp_path / "bag", writer)
    written = {}
    divisors = {"/mine/seat/imu": 4, "/mine/turret/imu": 1, "/other/seat/imu": 1, "/mine/a/b/imu": 2}
    for topic, divisor in divisors.items():
        writer.add_topic(topic, "sensor_msgs/msg/Imu", [], "")
        written[topic] = random.normal(size=(40 // divisor, 2, 3))
        for k, values in enumerate(written[topic], 1):
            writer.write(topic, k * divisor * PERIOD, imu.fill(k * divisor * PERIOD, *values))
    writer.close()
    recording = read_recording(tmp_path / "more")
    assert list(recording.sensors) == ["seat", "turret"]
    for name, sensor in recording.sensors.items():
        np.testing.assert_array_equal(sensor.specific_force, written[f"/mine/{name}/imu"][:, 0])
        np.testing.assert_array_equal(sensor.angular_velocity, written[f"/mine/{name}/imu"][:, 1])
    assert recording.sensors["seat"].stamp.tolist() == [4 * k * PERIOD for k in range(1, 11)]
    assert recording.topics["seat/imu"] == "/mine/seat/imu"
