"""A road from a node that is none of ours: whoever publishes RoadProfile ahead of the vehicle is driven on."""

import numpy as np
import pytest
import trackvib_sim as tv
from mr_mount_controller.node_base.qos import LATCHED_QOS, ROAD_QOS
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import RoadProfile

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="a loop of real processes")]
SPACING, PATCH, AHEAD = 0.1, 100, 60.0  # m, samples, m
PERIODS = 1500


class Waves:
    """A road of waves, as the in-process loop takes it."""

    spacing = SPACING

    def heights(self, first, count):
        """Return heights (2, count) [m]: level up to 4 m, then waves, the right ones opposite."""
        distance = SPACING * np.arange(first, first + count)
        wave = np.where(distance > 4.0, 0.03 * np.sin(np.pi * (distance - 4.0)), 0.0)
        return np.stack((wave, -wave))


def test_another_nodes_road_is_driven_on(start_node, observer):
    """By a node of plain rclpy, with patches and samples of its own length: to the bits of the loop in one process."""
    published, last = observer.node.create_publisher(RoadProfile, "road_profile", ROAD_QOS), [-3]

    def on_odometry(odometry):
        while last[0] * PATCH * SPACING < odometry.pose.pose.position.x + AHEAD:
            left, right = Waves().heights(last[0] * PATCH, PATCH)
            published.publish(RoadProfile(start=last[0] * PATCH * SPACING, spacing=SPACING, left=left, right=right))
            last[0] += 1

    observer.node.create_subscription(Odometry, "odometry", on_odometry, LATCHED_QOS)
    measured = observer.collect(Imu, "chassis/imu", QoSProfile(depth=PERIODS))
    start_node("controller")
    simulator = start_node("simulator", duration=PERIODS / 1000, answer_timeout=UNHURRIED)
    observer.wait_until(lambda: not simulator.running)
    assert simulator.wait() == 0, simulator.output
    vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    rates = tv.Rates(tv.recommended_rate(vehicle))
    settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False, 0.25), rates, passive_current=1.0)
    expected = tv.run_open_loop(tv.Simulation(vehicle, settings), Waves(), PERIODS).specific_force[:, 0]
    # what came before this test's reader was found is no matter
    found = [deserialize_message(data, Imu) for data in measured]
    assert len(found) > PERIODS // 2
    for imu in found:
        period = round(imu.header.stamp.sec * 1000 + imu.header.stamp.nanosec / 1e6)
        force = imu.linear_acceleration
        assert (force.x, force.y, force.z) == tuple(expected[period - 1]), period
