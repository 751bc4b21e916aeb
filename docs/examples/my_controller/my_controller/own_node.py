"""A controller node of one's own, on nothing but the messages: answers every Imu with a CoilCurrent."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent


class OwnNode(Node):
    """Firm while the powertrain is pushed up."""

    def __init__(self):
        super().__init__("own_node")
        self._firm = self.declare_parameter("firm_current", 2.5).value
        self._currents = self.create_publisher(CoilCurrent, "coil_current", 10)
        self.create_subscription(Imu, "powertrain/imu", self._answer, 10)

    def _answer(self, imu):
        current = self._firm if imu.linear_acceleration.z > 9.81 else 0.8
        # the stamp tells which sample is answered; the simulator waits for just that, with one current a coil
        answer = CoilCurrent(header=imu.header, sample_stamp=imu.header.stamp, current=[current, current])
        self._currents.publish(answer)


def main():
    """Run the node until Ctrl-C."""
    rclpy.init()
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(OwnNode())
