"""Names of topics and frames, in one place. Relative names can be remapped and put into a namespace."""

CHASSIS_IMU = "chassis/imu"
POWERTRAIN_IMU = "powertrain/imu"
COIL_CURRENT = "coil_current"
MOUNT_STATE = "mount_state"
ODOMETRY = "odometry"
ROAD_PROFILE = "road_profile"
VEHICLE_DESCRIPTION = "vehicle_description"
RECORDED = "recorder/recorded"  # time up to which the recorder has written every sample
RECORDED_ANSWERS = "recorder/recorded_answers"  # likewise every answer
CLOCK = "/clock"
DIAGNOSTICS = "/diagnostics"

CHASSIS_FRAME = "chassis_imu_link"
POWERTRAIN_FRAME = "powertrain_imu_link"
HULL_FRAME = "base_link"
ROAD_FRAME = "odom"
