"""A run that goes on as a growing recording of Rerun, piece by piece."""

import numpy as np

from ..nodes.live_poses import LivePoses
from ..vehicle.system import Operation, build_system
from .curves import ACCELERATION, CURRENT, FORCE, log_now
from .layout import layout
from .rerun_recording import STEP, new_stream
from .vehicle_log import GRAVITY_UP, VehicleLog

_PIECE = 0.5  # s of wall time


def live_pieces(vehicle, title, over):
    """Yield the pieces of a recording of a run of a vehicle, as bytes, until `over()`."""
    stream = new_stream(title)
    binary, log = stream.binary_stream(), VehicleLog(stream, vehicle, build_system(vehicle, Operation(0.0, 0.0, False), STEP))
    stream.send_blueprint(layout(log.mounts.coils > 0, bool(log.mounts.names), live=True))
    log.begin()
    live = LivePoses(vehicle, [sensor.name for sensor in log.sensors])
    try:
        ended, first = False, True
        while not ended:
            ended = over()  # what had come by then is still shown
            live.look(_PIECE)
            if live.poses or first:
                first = False
                _write(stream, log, live)
                yield binary.read(flush=True)
    finally:
        live.close()


def _write(stream, log, live):
    poses, live.poses = live.poses, []
    roads, live.roads = live.roads, []
    for time, corners, colours in roads[-1:]:
        log.road_now(time, corners, (255 * np.clip(colours, 0.0, 1.0)).astype(np.uint8))
    if not poses:
        return
    time = np.array([stamp for stamp, _ in poses])
    log.frames(time, [pose for _, pose in poses])
    now, last = time[-1:], [poses[-1][1]]
    for name, vector in live.sensors.items():
        log.sensor_frames(name, now, vector.specific_force[None])
        if name in ("chassis", "powertrain"):
            log_now(stream, f"{ACCELERATION}/{name}", now, vector.specific_force[2] - GRAVITY_UP[2])
    if live.mounts is None or [len(each) for each in live.mounts] != [log.mounts.coils, len(log.mounts.names)]:
        return
    current, force = live.mounts
    log.mount_frames(now, last, current[None], force[None])
    for name, value in zip(log.mounts.names, current, strict=False):
        log_now(stream, f"{CURRENT}/{name}", now, value)
    for name, value in zip(log.mounts.names, force, strict=True):
        log_now(stream, f"{FORCE}/{name}", now, 1e-3 * value)
