"""Quality of service of what only the simulator side publishes; the loop's own is in `mr_mount_controller`."""

from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

ROAD_QOS = QoSProfile(depth=64, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)  # all patches around the vehicle
CLOCK_QOS = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
