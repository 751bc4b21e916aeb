"""Bags made of the nodes' own messages with random numbers, written by the recorder's own writer."""

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from mr_mount_controller.mounting import PAIR
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from trackvib_msgs.msg import CoilCurrent
from trackvib_sim.bags.writing import BagWriter
from trackvib_sim.nodes.messages import ImuMessage, MountMessage, mount_description, set_stamp, set_vector
from trackvib_sim.numerics.units import NANO
from trackvib_sim.vehicle.mounts import MountSample

PERIOD = NANO // 1000
PERIODS = 2500  # of the shared bag: three chunks
TYPES = {
    "chassis/imu": "sensor_msgs/msg/Imu",
    "powertrain/imu": "sensor_msgs/msg/Imu",
    "mount_state": "trackvib_msgs/msg/MountState",
    "coil_current": "trackvib_msgs/msg/CoilCurrent",
    "odometry": "nav_msgs/msg/Odometry",
    "diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "vehicle_description": "std_msgs/msg/String",
}


def write_bag(
    path, periods, space="/", topics=tuple(TYPES), frames=("chassis_imu_link",), vehicle="", mounting=PAIR, told=None
):
    """Write a bag of so many periods of 1 ms; the chassis's frame takes the given names in turn.

    `mounting` tells how many coils and mounts there are, `told` what the bag says of them, if it does.
    """
    random, bag = np.random.default_rng(7), BagWriter(path)
    for end in topics:
        bag.add_topic(f"{space}{end}", TYPES[end], [], "")
    bag.add_provenance("parameters of /simulator", {"speed": 10.0, "engine_speed": 1650.0})
    translators = [ImuMessage(frame) for frame in frames]
    count = len(mounting.mounts)
    shapes = {"current": mounting.coils} | dict.fromkeys(("deflection", "velocity", "force"), (count, 3))
    sample = MountSample(*(np.zeros(shapes.get(name, count)) for name in MountSample._fields))
    powertrain = ImuMessage("powertrain_imu_link")
    mounts = MountMessage(sample)

    def write(end, stamp, data):
        if end in topics:
            bag.write(f"{space}{end}", stamp, data)

    if told is not None:
        bag.add_topic(f"{space}mount_description", "trackvib_msgs/msg/MountDescription", [], "")
        bag.write(f"{space}mount_description", 0, serialize_message(mount_description(told)))
    write("vehicle_description", 0, serialize_message(String(data=vehicle)))
    for k in range(1, periods + 1):
        stamp = k * PERIOD
        write("chassis/imu", stamp, translators[k % len(frames)].fill(stamp, *random.normal(size=(2, 3))))
        write("powertrain/imu", stamp, powertrain.fill(stamp, *random.normal(size=(2, 3))))
        for values in sample:
            values[...] = random.normal(size=values.shape)
        write("mount_state", stamp, mounts.fill(stamp, sample))
        answer = CoilCurrent(current=random.normal(size=mounting.coils).tolist())
        answer.sample_stamp.sec, answer.sample_stamp.nanosec = divmod(stamp, NANO)
        set_stamp(answer, stamp + 1)
        write("coil_current", stamp, serialize_message(answer))
        if k % 10 == 0:
            odometry = Odometry(child_frame_id="base_link")
            odometry.header.frame_id = "odom"
            set_stamp(odometry, stamp)
            set_vector(odometry.pose.pose.position, random.normal(size=3).tolist())
            set_vector(odometry.twist.twist.linear, random.normal(size=3).tolist())
            write("odometry", stamp, serialize_message(odometry))
        if k % 100 == 0:
            told = [KeyValue(key="time", value=str(stamp / NANO)), KeyValue(key=f"key_{k}", value="1")]
            others = DiagnosticStatus(name="other", values=[KeyValue(key="not", value="ours")])
            status = DiagnosticArray(status=[DiagnosticStatus(name="simulator", values=told), others])
            set_stamp(status, stamp)
            write("diagnostics", stamp, serialize_message(status))
    bag.close()
