"""Property: a packed message is the message with the same values, and has the same bytes each time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mr_mount_controller.mounting import PAIR, described, undescribed
from mr_mount_controller.node_base.listener import whole_message
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import MountDescription, MountState
from trackvib_sim.bags.definitions import Definition
from trackvib_sim.bags.schemas import schema_text
from trackvib_sim.nodes.messages import ImuMessage, MountMessage, mount_description, set_stamp, set_vector
from trackvib_sim.vehicle.mounts import MountSample

STAMPS = st.integers(0, 2**31 * 10**9 - 1)
SEEDS = st.integers(0, 2**32 - 1)


@given(STAMPS, SEEDS, st.text("abcdefgh_", min_size=1, max_size=30))
def test_imu(stamp, seed, frame):
    """Whatever the length of the frame's name, which shifts everything behind it."""
    force, rate = np.random.default_rng(seed).normal(size=(2, 3))
    message = Imu()
    message.header.frame_id = frame
    message.orientation_covariance[0] = -1.0
    set_stamp(message, stamp)
    set_vector(message.linear_acceleration, force.tolist())
    set_vector(message.angular_velocity, rate.tolist())
    packed = ImuMessage(frame).fill(stamp, force, rate)
    assert deserialize_message(packed, Imu) == message
    assert len(packed) == len(serialize_message(message))
    assert packed == ImuMessage(frame).fill(stamp, force, rate)


def mount_sample(coils, mounts):
    """Room for the state of any number of mounts, as `new_mount_sample` makes it for those of a vehicle."""
    shapes = {"current": coils} | dict.fromkeys(("deflection", "velocity", "force"), (mounts, 3))
    return MountSample(*(np.zeros(shapes.get(name, mounts)) for name in MountSample._fields))


@pytest.mark.parametrize(("coils", "mounts"), [(0, 0), (0, 3), (1, 1), (2, 2), (2, 4), (4, 4), (16, 32)])
@given(stamp=STAMPS, seed=SEEDS)
def test_mount_state(coils, mounts, stamp, seed):
    """Numbers and vectors of any number of mounts come back as they were."""
    random, sample = np.random.default_rng(seed), mount_sample(coils, mounts)
    for values in sample:
        values[...] = random.normal(size=values.shape)
    message = deserialize_message(MountMessage(sample).fill(stamp, sample), MountState)
    assert message.header.stamp.sec * 10**9 + message.header.stamp.nanosec == stamp
    for name, values in sample._asdict().items():
        found = getattr(message, name)
        if values.ndim == 2:
            found = np.reshape([(vector.x, vector.y, vector.z) for vector in found], values.shape)
        np.testing.assert_array_equal(found, values)


@pytest.mark.parametrize("mounting", [PAIR, undescribed(0), undescribed(16, 32)])
def test_mount_description(mounting):
    """What is told of the mounts comes back, whoever reads it."""
    data = serialize_message(mount_description(mounting))
    assert described(deserialize_message(data, MountDescription)) == mounting
    assert described(whole_message(MountDescription)(data)) == mounting
    text = schema_text("trackvib_msgs/msg/MountDescription").encode()
    in_bag = Definition("trackvib_msgs/msg/MountDescription", "ros2msg", text)
    assert described(in_bag.message(data)) == mounting
