"""Quality of service of the topics, in one place."""

from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

# Loop topics are reliable and volatile. A reader holds a few periods, so that nobody acts on old samples; a writer
# holds more, so that a recorder which is slow for a moment still gets everything.
LOOP_QOS = QoSProfile(depth=10)
LOOP_WRITER_QOS = QoSProfile(depth=1000)
LATCHED_QOS = QoSProfile(depth=50, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
ROAD_QOS = QoSProfile(depth=64, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)  # all patches around the vehicle
CLOCK_QOS = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.BEST_EFFORT)
