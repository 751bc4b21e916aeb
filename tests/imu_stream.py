"""Publishes Imu messages 500 times a second: python imu_stream.py TOPIC [TOPIC ...]

The stamp is the time at which a message was published, on the machine's monotonic clock; the acceleration along x
counts them, from 1 on.
"""

import signal
import sys
import time

import rclpy
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu
from trackvib_sim.nodes.messages import ImuMessage


def main(topics):
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("imu_stream")
    publishers = [node.create_publisher(Imu, topic, LOOP_WRITER_QOS) for topic in topics]
    message, count = ImuMessage("stream"), 0
    while True:
        count += 1
        data = message.fill(time.monotonic_ns(), (float(count), 0.0, 0.0), (0.0, 0.0, 0.0))
        for publisher in publishers:
            publisher.publish(data)
        time.sleep(0.002)


if __name__ == "__main__":
    main(sys.argv[1:])
