"""Topics, their types and frames, in one place. All names are relative: a namespace holds a whole vehicle."""

from typing import NamedTuple

CHASSIS_IMU = "chassis/imu"
POWERTRAIN_IMU = "powertrain/imu"
FURTHER_IMU = "*/imu"  # see `imu_topic`
COIL_CURRENT = "coil_current"
MOUNT_STATE = "mount_state"
MOUNT_DESCRIPTION = "mount_description"
ODOMETRY = "odometry"
DRIVE_STATE = "drive_state"
DRIVE_DESCRIPTION = "drive_description"
DRIVE_COMMAND = "drive_command"
CMD_VEL = "cmd_vel"
LAW_PARAMETERS = "law_parameters"
ROAD_PROFILE = "road_profile"
VEHICLE_DESCRIPTION = "vehicle_description"
RECORDED = "recorder/recorded"
RECORDED_ANSWERS = "recorder/recorded_answers"
RECORDED_TOPICS = "recorder/topics"
CLOCK = "clock"
DIAGNOSTICS = "diagnostics"
TF = "tf"
TF_STATIC = "tf_static"
JOINT_STATES = "joint_states"
ROBOT_DESCRIPTION = "robot_description"
TRACK_LINKS = "track_links"
ROAD_STRIPS = "road_strips"
MEASURED = "measured/*"  # see `measured_topic`
MEASURED_DESCRIPTION = "measured/description"

IMU_TYPE = "sensor_msgs/msg/Imu"
COIL_CURRENT_TYPE = "trackvib_msgs/msg/CoilCurrent"
MOUNT_STATE_TYPE = "trackvib_msgs/msg/MountState"
MOUNT_DESCRIPTION_TYPE = "trackvib_msgs/msg/MountDescription"
LAW_PARAMETERS_TYPE = "rcl_interfaces/msg/ParameterEvent"
ODOMETRY_TYPE = "nav_msgs/msg/Odometry"
DRIVE_STATE_TYPE = "trackvib_msgs/msg/DriveState"
DRIVE_DESCRIPTION_TYPE = "std_msgs/msg/String"
COMMAND_TYPE = "geometry_msgs/msg/TwistStamped"
ROAD_PROFILE_TYPE = "trackvib_msgs/msg/RoadProfile"
VEHICLE_DESCRIPTION_TYPE = "std_msgs/msg/String"
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
DIAGNOSTICS_TYPE = "diagnostic_msgs/msg/DiagnosticArray"
TF_TYPE = "tf2_msgs/msg/TFMessage"
JOINT_STATES_TYPE = "sensor_msgs/msg/JointState"
ROBOT_DESCRIPTION_TYPE = "std_msgs/msg/String"
TRACK_LINKS_TYPE = "visualization_msgs/msg/MarkerArray"
ROAD_STRIPS_TYPE = "visualization_msgs/msg/Marker"
MEASURED_TYPE = "trackvib_msgs/msg/Measured"
MEASURED_DESCRIPTION_TYPE = "trackvib_msgs/msg/MeasuredDescription"
RECORDED_TYPE = "builtin_interfaces/msg/Time"
RECORDED_TOPICS_TYPE = "std_msgs/msg/String"

CHASSIS_FRAME = "chassis_imu_link"
HULL_FRAME = "base_link"
ROAD_FRAME = "odom"


def imu_topic(sensor):
    """Return the topic of a sensor by its name."""
    return f"{sensor}/imu"


def imu_frame(sensor):
    """Return the frame of a sensor by its name."""
    return f"{sensor}_imu_link"


def measured_topic(kind):
    """Return the topic of a kind of what is measured in the running gear."""
    return f"measured/{kind}"


class Topic(NamedTuple):
    """What travels on a topic, for people; `docs/nodes.md` is made from it."""

    name: str
    type: str
    publisher: str  # node
    rate: str  # in simulated time, at the default rates
    meaning: str
    readers: tuple = ()  # nodes that listen to it, beside the recorder


TOPICS = (
    Topic(
        CHASSIS_IMU,
        IMU_TYPE,
        "simulator",
        "1 kHz",
        "Lower (hull) end of the mounts: specific force and angular velocity through the low-pass, body axes.",
        ("controller",),
    ),
    Topic(
        POWERTRAIN_IMU,
        IMU_TYPE,
        "simulator",
        "1 kHz",
        "Upper (powertrain) end of the mounts, likewise.",
        ("controller",),
    ),
    Topic(
        FURTHER_IMU,
        IMU_TYPE,
        "simulator",
        "1 kHz over the sensor's divisor",
        "Each further sensor of the vehicle file by its name, likewise.",
    ),
    Topic(
        COIL_CURRENT,
        COIL_CURRENT_TYPE,
        "controller",
        "1 kHz",
        "The answer: demanded current in each coil, and the stamp of the sample it answers.",
        ("simulator",),
    ),
    Topic(
        LAW_PARAMETERS,
        LAW_PARAMETERS_TYPE,
        "controller",
        "as they change",
        "Changed parameters of the law; the stamp is that of the last sample answered with the old values.",
    ),
    Topic(
        MOUNT_STATE,
        MOUNT_STATE_TYPE,
        "simulator",
        "1 kHz",
        "Current in each coil; stiffness, damping, deflection, velocity, force and dissipated power of each mount.",
    ),
    Topic(
        MOUNT_DESCRIPTION,
        MOUNT_DESCRIPTION_TYPE,
        "simulator",
        "once",
        "Name, kind and position of each mount, and the number of coils.",
        ("controller",),
    ),
    Topic(ODOMETRY, ODOMETRY_TYPE, "simulator", "100 Hz", "Pose and velocity of the hull."),
    Topic(
        DRIVE_STATE,
        DRIVE_STATE_TYPE,
        "simulator",
        "100 Hz",
        "Distance along the path, demanded speed and curvature, engine speed, gear, speed and torque of the sprockets.",
        ("road_excitation",),
    ),
    Topic(DRIVE_DESCRIPTION, DRIVE_DESCRIPTION_TYPE, "simulator", "once", "The drive file in use; empty if none."),
    Topic(
        CMD_VEL,
        COMMAND_TYPE,
        "anybody",
        "any",
        "Demanded speed (`linear.x`) and yaw rate (`angular.z`), effective from the next control period.",
        ("simulator",),
    ),
    Topic(
        DRIVE_COMMAND,
        COMMAND_TYPE,
        "simulator",
        "when accepted",
        "The accepted command; its stamp is the simulated time from which it is effective.",
    ),
    Topic(
        ROAD_PROFILE,
        ROAD_PROFILE_TYPE,
        "road_excitation",
        "on demand",
        "Patches of road, left and right.",
        ("simulator",),
    ),
    Topic(VEHICLE_DESCRIPTION, VEHICLE_DESCRIPTION_TYPE, "simulator", "once", "The vehicle file in use."),
    Topic(
        TF, TF_TYPE, "simulator", "`view_rate`", "Frames of hull, bodies and tensioners, below the root frame `odom`."
    ),
    Topic(TF_STATIC, TF_TYPE, "simulator", "once, with `view_rate`", "Frames of the sensors on their bodies."),
    Topic(
        JOINT_STATES,
        JOINT_STATES_TYPE,
        "simulator",
        "`view_rate`",
        "Positions and rates of all movable joints of the robot description.",
    ),
    Topic(
        ROBOT_DESCRIPTION,
        ROBOT_DESCRIPTION_TYPE,
        "simulator",
        "once, with `view_rate`",
        "The vehicle as URDF: bodies with shapes and inertia, joints, sensors.",
    ),
    Topic(
        TRACK_LINKS,
        TRACK_LINKS_TYPE,
        "simulator",
        "`view_rate`",
        "Every link of both tracks as a line from pin to pin, left and right, in `odom`.",
    ),
    Topic(
        ROAD_STRIPS,
        ROAD_STRIPS_TYPE,
        "simulator",
        "1 Hz, with `view_rate`",
        "The road around the vehicle as two strips, left and right, in `odom`.",
    ),
    Topic(
        MEASURED,
        MEASURED_TYPE,
        "simulator",
        "`measure_rate`",
        "One topic per kind: `suspension_travel`, `damper_force`, `wheel_force`, `ground_force`, `track_tension`, "
        "`sprocket_torque`, `engine_speed`.",
    ),
    Topic(
        MEASURED_DESCRIPTION,
        MEASURED_DESCRIPTION_TYPE,
        "simulator",
        "once, with `measure_rate`",
        "Unit and meaning of each kind, and the element that each of its numbers belongs to.",
    ),
    Topic(
        RECORDED,
        RECORDED_TYPE,
        "recorder",
        "as it writes",
        "Time up to which the bag holds every sample on all topics.",
        ("simulator",),
    ),
    Topic(
        RECORDED_ANSWERS,
        RECORDED_TYPE,
        "recorder",
        "as it writes",
        "Time of the latest sample whose answer the bag holds.",
        ("simulator",),
    ),
    Topic(
        RECORDED_TOPICS,
        RECORDED_TOPICS_TYPE,
        "recorder",
        "as it subscribes",
        "Full names of the topics that it records, one per line.",
        ("simulator",),
    ),
    Topic(CLOCK, CLOCK_TYPE, "simulator", "100 Hz", "Simulated time.", ("simulator",)),
    Topic(
        DIAGNOSTICS,
        DIAGNOSTICS_TYPE,
        "simulator",
        "10 Hz",
        "State and epoch, actual currents, pace, late and rejected answers, saturation, "
        "time per part of a period, energy balance of the mounts.",
    ),
)
