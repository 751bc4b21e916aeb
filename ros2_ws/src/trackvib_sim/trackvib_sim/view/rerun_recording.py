"""A recorded run as a recording of Rerun."""

from mr_mount_controller.node_base.plain_text import readable

from ..extras import require

require("view", "rerun")

import numpy as np  # noqa: E402
import rerun as rr  # noqa: E402

from ..vehicle.system import Operation, build_system  # noqa: E402
from .curves import announce_curves, log_curves, sensor_vectors  # noqa: E402
from .layout import layout  # noqa: E402
from .road import strips_of  # noqa: E402
from .vehicle_log import VehicleLog  # noqa: E402

APPLICATION = "trackvib"
STEP = 1e-4  # s, of a system of which only the geometry is used


def new_stream(name):
    """Return a `rerun.RecordingStream` that is called `name`."""
    stream = rr.RecordingStream(APPLICATION)
    stream.send_recording_name(readable(name))
    return stream


def write_run(stream, recording, vehicle, motion):
    """Write the `motion.Motion` of a vehicle and what its `Recording` tells beside it to a stream."""
    log = VehicleLog(stream, vehicle, build_system(vehicle, Operation(0.0, 0.0, False), STEP))
    stream.send_blueprint(layout(log.mounts.coils > 0, bool(log.mounts.names)))
    log.begin()
    log.frames(motion.time, motion.poses)
    if recording.mounts is not None:
        row = np.clip(np.searchsorted(recording.mounts.stamp, motion.time, "right") - 1, 0, None)
        current, force = recording.mounts.current[row], recording.mounts.force[row, :, 2]
        log.mount_frames(motion.time, motion.poses, current, force)
    known = {sensor.name for sensor in log.sensors}
    for name, specific_force in sensor_vectors(recording, motion.time):
        if name in known:
            log.sensor_frames(name, motion.time, specific_force)
    if recording.road:
        log.road(strips_of(recording, vehicle, motion.way))
    announce_curves(stream, log.mounts)
    log_curves(stream, recording, log.mounts.names, motion.time[0], motion.time[-1])
