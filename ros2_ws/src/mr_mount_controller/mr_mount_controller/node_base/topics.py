"""Topics, their types and frames, in one place. All names are relative: a namespace holds a whole vehicle."""

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
