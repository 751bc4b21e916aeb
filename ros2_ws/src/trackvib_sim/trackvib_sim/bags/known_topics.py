"""The topics of a run: by which ends of names they are known, of which types they are, which columns are read."""

from mr_mount_controller.node_base import topics

from .accelerations import IMU_COLUMNS
from .columns import Columns
from .places import ODOMETRY_COLUMNS
from .recording import Answers, Commands, Drive, Mounts
from .transforms import TF_STATIC, TF_TYPE

_NUMBERS = {name: (name, (-1,)) for name in ("current", "stiffness", "damping")}
_VECTORS = {name: (name, (-1, 3)) for name in ("deflection", "velocity", "force")}
_DRIVE = ("distance", "offset", "wanted_speed", "curvature", "engine_speed", "gear")
_SPROCKETS = {name: (name, (2,)) for name in ("sprocket_speed", "sprocket_torque")}
COLUMNS = {
    topics.CHASSIS_IMU: IMU_COLUMNS,
    topics.POWERTRAIN_IMU: IMU_COLUMNS,
    topics.MOUNT_STATE: Columns(topics.MOUNT_STATE_TYPE, Mounts, {
        "stamp": "header.stamp", **_NUMBERS, **_VECTORS, "dissipated_power": ("dissipated_power", (-1,)),
    }),
    topics.COIL_CURRENT: Columns(topics.COIL_CURRENT_TYPE, Answers, {
        "sample_stamp": "sample_stamp", "current": ("current", (-1,)),
    }),
    topics.ODOMETRY: ODOMETRY_COLUMNS,
    topics.DRIVE_STATE: Columns(topics.DRIVE_STATE_TYPE, Drive, {
        "stamp": "header.stamp", **{name: (name, ()) for name in _DRIVE}, **_SPROCKETS,
    }),
    topics.DRIVE_COMMAND: Columns(topics.COMMAND_TYPE, Commands, {
        "stamp": "header.stamp", "speed": ("twist.linear.x", ()), "yaw_rate": ("twist.angular.z", ()),
    }),
}  # fmt: skip
NEEDED = (topics.CHASSIS_IMU, topics.POWERTRAIN_IMU)
RARE = {  # read message by message
    topics.DIAGNOSTICS: topics.DIAGNOSTICS_TYPE,
    topics.VEHICLE_DESCRIPTION: topics.VEHICLE_DESCRIPTION_TYPE,
    topics.DRIVE_DESCRIPTION: topics.DRIVE_DESCRIPTION_TYPE,
    topics.MOUNT_DESCRIPTION: topics.MOUNT_DESCRIPTION_TYPE,
    topics.ROAD_PROFILE: topics.ROAD_PROFILE_TYPE,
    topics.LAW_PARAMETERS: topics.LAW_PARAMETERS_TYPE,
    TF_STATIC: TF_TYPE,
}
TYPES = {end: columns.type_name for end, columns in COLUMNS.items()} | RARE
FURTHER = topics.imu_topic("")  # stands for the end of every further sensor's topic


def end_of(topic):
    """Return by which of the known ends a topic is known; None by none."""
    further = FURTHER if topic.endswith(FURTHER) else None
    return next((end for end in TYPES if f"/{topic}".endswith(f"/{end}")), further)
