"""A controller that answers every sample properly, but first with something that must not count."""

import sys

import rclpy
from builtin_interfaces.msg import Time
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent

NANO = 1_000_000_000


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
    }
    return answers[kind]


def main():
    kind = sys.argv[1]
    rclpy.init()
    node = rclpy.create_node("unruly")
    publisher = node.create_publisher(CoilCurrent, "coil_current", 10)

    def answer(imu):
        proper = CoilCurrent(sample_stamp=imu.header.stamp, current=[2.0, 2.0])
        bad = unruly(kind, imu.header.stamp)
        # a duplicate comes second; a current beyond the limits is itself the answer
        for message in {"duplicate": (proper, bad), "saturated": (bad,)}.get(kind, (bad, proper)):
            publisher.publish(message)

    node.create_subscription(Imu, "chassis/imu", lambda imu: None, 10)
    node.create_subscription(Imu, "powertrain/imu", answer, 10)
    rclpy.spin(node)


main()
