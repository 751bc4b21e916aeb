"""Topics and frames, in one place. Relative names can be remapped and put into a namespace."""

from typing import NamedTuple

CHASSIS_IMU = "chassis/imu"
POWERTRAIN_IMU = "powertrain/imu"
COIL_CURRENT = "coil_current"
MOUNT_STATE = "mount_state"
ODOMETRY = "odometry"
ROAD_PROFILE = "road_profile"
VEHICLE_DESCRIPTION = "vehicle_description"
RECORDED = "recorder/recorded"
CLOCK = "/clock"
DIAGNOSTICS = "/diagnostics"

CHASSIS_FRAME = "chassis_imu_link"
POWERTRAIN_FRAME = "powertrain_imu_link"
HULL_FRAME = "base_link"
ROAD_FRAME = "odom"


class Topic(NamedTuple):
    """What travels on a topic, for people; `docs/nodes.md` is made from it."""

    name: str
    type: str
    publisher: str  # node
    rate: str  # in simulated time, at the default rates
    meaning: str


TOPICS = (
    Topic(
        CHASSIS_IMU,
        "sensor_msgs/msg/Imu",
        "simulator",
        "1 kHz",
        "Lower (hull) end of the mounts: specific force and angular velocity, mean over the period, body axes.",
    ),
    Topic(
        POWERTRAIN_IMU,
        "sensor_msgs/msg/Imu",
        "simulator",
        "1 kHz",
        "Upper (powertrain) end of the mounts, likewise.",
    ),
    Topic(
        COIL_CURRENT,
        "trackvib_msgs/msg/CoilCurrent",
        "controller",
        "1 kHz",
        "The answer: demanded current of both coils, and the stamp of the sample that it answers.",
    ),
    Topic(
        MOUNT_STATE,
        "trackvib_msgs/msg/MountState",
        "simulator",
        "1 kHz",
        "Current, stiffness, damping, deflection, velocity, force and dissipated power of both mounts.",
    ),
    Topic(ODOMETRY, "nav_msgs/msg/Odometry", "simulator", "100 Hz", "Pose and velocity of the hull."),
    Topic(
        ROAD_PROFILE,
        "trackvib_msgs/msg/RoadProfile",
        "road_excitation",
        "on demand",
        "Patches of road, left and right.",
    ),
    Topic(VEHICLE_DESCRIPTION, "std_msgs/msg/String", "simulator", "once", "The vehicle file in use."),
    Topic(
        RECORDED,
        "builtin_interfaces/msg/Time",
        "recorder",
        "as it writes",
        "Time up to which the bag holds everything.",
    ),
    Topic(CLOCK, "rosgraph_msgs/msg/Clock", "simulator", "100 Hz", "Simulated time."),
    Topic(
        DIAGNOSTICS,
        "diagnostic_msgs/msg/DiagnosticArray",
        "simulator",
        "10 Hz",
        "State and epoch, currents in force, pace, late and rejected answers, saturation, where the time of a period "
        "and the work on the mounts goes.",
    ),
)
