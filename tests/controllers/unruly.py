"""A controller that answers properly, but beside it, or from some sample on instead, something that must not count."""

import sys
import time

import rclpy
from builtin_interfaces.msg import Time
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent

NANO = 1_000_000_000
SLOW = 5.0  # s, well beyond the answer_timeout of its test


def shifted(stamp, nanoseconds):
    seconds, rest = divmod(stamp.sec * NANO + stamp.nanosec + nanoseconds, NANO)
    return Time(sec=seconds, nanosec=rest)


def unruly(kind, stamp):
    """Return what must not count."""
    answers = {
        "late": CoilCurrent(sample_stamp=Time(), current=[4.0, 4.0]),
        "early": CoilCurrent(sample_stamp=shifted(stamp, 1_000_000), current=[4.0, 4.0]),
        "not_finite": CoilCurrent(sample_stamp=stamp, current=[float("nan"), 2.0]),
        "infinite": CoilCurrent(sample_stamp=stamp, current=[2.0, float("inf")]),
        "duplicate": CoilCurrent(sample_stamp=stamp, current=[4.0, 4.0]),
        "saturated": CoilCurrent(sample_stamp=stamp, current=[9.0, 9.0]),
        "out_of_order": CoilCurrent(sample_stamp=shifted(stamp, -1_000_000), current=[4.0, 4.0]),
    }
    return answers[kind]


def main():
    kind = sys.argv[1]
    turns = int(sys.argv[2]) if len(sys.argv) > 2 else None  # sample, from which on it answers nothing proper
    rclpy.init()
    node = rclpy.create_node("unruly")
    publisher = node.create_publisher(CoilCurrent, "coil_current", 10)

    def answer(imu):
        proper = CoilCurrent(sample_stamp=imu.header.stamp, current=[2.0, 2.0])
        number = (imu.header.stamp.sec * NANO + imu.header.stamp.nanosec) // 1_000_000
        if kind == "slow":  # one answer takes its time
            time.sleep(SLOW if number == turns else 0.0)
            publisher.publish(proper)
            return
        bad = unruly(kind, imu.header.stamp)
        if turns is not None and number >= turns:
            publisher.publish(bad)
            return
        # a duplicate comes second; a current beyond the limits is itself the answer
        second = {"duplicate": (proper, bad), "out_of_order": (proper, bad), "saturated": (bad,)}
        for message in second.get(kind, (bad, proper)):
            publisher.publish(message)

    node.create_subscription(Imu, "chassis/imu", lambda imu: None, 10)
    node.create_subscription(Imu, "powertrain/imu", answer, 10)
    rclpy.spin(node)


main()
