"""A run that goes on as a growing recording of Rerun, piece by piece."""

import time
from math import inf

import numpy as np

from ..nodes.live_poses import LivePoses
from ..vehicle.system import Operation, build_system
from .curves import Accelerations, add_mounts, announce_curves
from .layout import layout
from .rerun_recording import STEP, new_stream
from .vehicle_log import VehicleLog

_PIECE = 0.5  # s of wall time
_LAST = 10.0  # s of wall time that the end takes at most, should messages never cease


def live_pieces(vehicle, title, namespace, over):
    """Yield the pieces of a recording of a run of a vehicle in a namespace, as bytes, until `over()`.

    When the first one has come it listens: what is published from then on is shown.
    """
    stream = new_stream(title)
    system = build_system(vehicle, Operation(0.0, 0.0, False), STEP)
    binary, log = stream.binary_stream(), VehicleLog(stream, vehicle, system)
    stream.send_blueprint(layout(log.mounts.coils > 0, bool(log.mounts.names), live=True))
    log.begin()
    announce_curves(stream, log.mounts)
    mounts, accelerations = (log.mounts.coils, len(log.mounts.names)), Accelerations(stream)
    live = LivePoses(vehicle, [sensor.name for sensor in log.sensors], mounts, namespace)
    try:
        yield binary.read(flush=True)
        end = inf
        while True:
            if over():
                end = min(end, time.monotonic() + _LAST)  # what had come by then is still shown
            came = live.look(_PIECE)
            if live.frames:
                _write(stream, log, live, accelerations)
                yield binary.read(flush=True)
            if end < inf and (not came or time.monotonic() > end):
                break
    finally:
        live.close()


def _write(stream, log, live, accelerations):
    roads, live.roads = live.roads, []
    for stamp, corners, colours in roads[-1:]:
        log.road_now(stamp, corners, (255 * np.clip(colours, 0.0, 1.0)).astype(np.uint8))
    frames, live.frames = live.frames, []
    times, poses = np.array([each.time for each in frames]), [each.pose for each in frames]
    current, force = (np.stack([getattr(each, name) for each in frames]) for name in ("current", "force"))
    log.frames(times, poses)
    log.mount_frames(times, poses, current, force)
    for sensor in log.sensors:
        log.sensor_frames(sensor.name, times, np.stack([each.specific_force[sensor.name] for each in frames]))
        accelerations.add(sensor.name, *live.take_sensor(sensor.name))
    add_mounts(stream, log.mounts.names, *live.take_mounts())
