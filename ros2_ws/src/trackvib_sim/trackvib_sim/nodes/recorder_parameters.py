"""Parameters of the recorder node."""

from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.parameters import Parameter

from ..bags.writing import COMPRESSIONS

DEFAULT_TOPICS = [
    topics.CHASSIS_IMU,
    topics.POWERTRAIN_IMU,
    topics.COIL_CURRENT,
    topics.MOUNT_STATE,
    topics.ODOMETRY,
    topics.DRIVE_STATE,
    topics.DRIVE_DESCRIPTION,
    topics.DRIVE_COMMAND,
    topics.ROAD_PROFILE,
    topics.VEHICLE_DESCRIPTION,
    topics.MOUNT_DESCRIPTION,
    topics.CLOCK,
    topics.DIAGNOSTICS,
]
PARAMETERS = (
    Parameter(
        "bag",
        "",
        "Folder of the bag; empty for bag_<date and time> in the working directory. Each further epoch is written to "
        "a separate bag, <bag>_epoch_2 and so on.",
    ),
    Parameter("topics", DEFAULT_TOPICS, "Topics to record; recording starts when all of them exist. [''] for none."),
    Parameter(
        "pattern",
        "",
        "Regular expression for further topics in the recorder's namespace, which are recorded as soon as they "
        "appear. It is searched in the name without the namespace, such as `/chassis/imu`.",
    ),
    Parameter("compression", "zstd", "Compression of the chunks of the bag.", choices=tuple(COMPRESSIONS)),
    Parameter("chunk_size", 1024, "Chunk size before compression.", "KiB", 16, 65536),
)
