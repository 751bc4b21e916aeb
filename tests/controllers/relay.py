"""Passes messages of a topic on to another, in order: `relay.py Imu|CoilCurrent FROM TO drop|delay SECONDS EVERY`.

Of every EVERY messages the last is dropped, or held up by SECONDS, and with it all that come behind.
"""

import sys
import time

import rclpy
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent


def main():
    kind = {"Imu": Imu, "CoilCurrent": CoilCurrent}[sys.argv[1]]
    source, sink, fault = sys.argv[2:5]
    seconds, every = float(sys.argv[5]), int(sys.argv[6])
    rclpy.init()
    node = rclpy.create_node("relay")
    publisher = node.create_publisher(kind, sink, 10)
    passed = 0

    def relay(data):
        nonlocal passed
        # whoever gave it may know the relay before the relay knows who shall get it
        while not publisher.get_subscription_count():
            time.sleep(0.01)
        passed += 1
        if passed % every == 0:
            if fault == "drop":
                return
            time.sleep(seconds)
        publisher.publish(data)

    subscription = node.create_subscription(kind, source, relay, 10, raw=True)
    while not subscription.get_publisher_count():
        rclpy.spin_once(node, timeout_sec=0.05)
    print("found its source", flush=True)
    rclpy.spin(node)


main()
