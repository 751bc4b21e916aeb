"""Property: a packed message is the message with the same values, and has the same bytes each time."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import MountState
from trackvib_sim.nodes.messages import ImuMessage, MountMessage, set_stamp, set_vector
from trackvib_sim.vehicle.mr_mounts import new_mount_sample

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


@given(STAMPS, SEEDS)
def test_mount_state(stamp, seed):
    """Arrays of numbers and of vectors come back as they were."""
    random, sample = np.random.default_rng(seed), new_mount_sample()
    for values in sample:
        values[...] = random.normal(size=values.shape)
    message = deserialize_message(MountMessage(sample).fill(stamp, sample), MountState)
    assert message.header.stamp.sec * 10**9 + message.header.stamp.nanosec == stamp
    for name, values in sample._asdict().items():
        found = getattr(message, name)
        if values.ndim == 2:
            found = [(vector.x, vector.y, vector.z) for vector in found]
        np.testing.assert_array_equal(found, values)
