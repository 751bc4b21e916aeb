"""Which types a topic of ours may have."""

import pytest
from sensor_msgs.msg import Imu
from trackvib_sim.nodes.messages import message_type

pytestmark = pytest.mark.property


def test_a_message_is_found_by_its_name():
    """As it is in the graph and in bags."""
    assert message_type("sensor_msgs/msg/Imu") is Imu


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("sensor_msgs/msg/Odd", "message type sensor_msgs/msg/Odd is not installed"),
        ("odd_msgs/msg/Imu", "message type odd_msgs/msg/Imu is not installed"),
        ("std_srvs/srv/Trigger_Event", "std_srvs/srv/Trigger_Event is not a message type"),
    ],
)
def test_others_are_named(name, words):
    """Also the events of services, which can be subscribed to but have no definition that a bag could hold."""
    with pytest.raises(ValueError, match=words):
        message_type(name)
