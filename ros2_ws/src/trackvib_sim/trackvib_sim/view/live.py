"""A run that goes on as a growing recording of Rerun, piece by piece."""

import numpy as np

from ..nodes.live_poses import LivePoses
from ..vehicle.parameters import CHASSIS, POWERTRAIN
from ..vehicle.system import Operation, build_system
from .curves import ACCELERATION, CURRENT, FORCE, add_points, announce_curves
from .layout import layout
from .rerun_recording import STEP, new_stream
from .vehicle_log import GRAVITY_UP, VehicleLog

_PIECE = 0.5  # s of wall time


def live_pieces(vehicle, title, namespace, over):
    """Yield the pieces of a recording of a run of a vehicle in a namespace, as bytes, until `over()`."""
    stream = new_stream(title)
    system = build_system(vehicle, Operation(0.0, 0.0, False), STEP)
    binary, log = stream.binary_stream(), VehicleLog(stream, vehicle, system)
    stream.send_blueprint(layout(log.mounts.coils > 0, bool(log.mounts.names), live=True))
    log.begin()
    announce_curves(stream, log.mounts)
    live = LivePoses(vehicle, [sensor.name for sensor in log.sensors], namespace)
    try:
        ended, first = False, True
        while not ended:
            ended = over()  # what had come by then is still shown
            live.look(_PIECE)
            if live.frames or first:
                first = False
                _write(stream, log, live)
                yield binary.read(flush=True)
    finally:
        live.close()


def _write(stream, log, live):
    frames, live.frames = live.frames, []
    roads, live.roads = live.roads, []
    for time, corners, colours in roads[-1:]:
        log.road_now(time, corners, (255 * np.clip(colours, 0.0, 1.0)).astype(np.uint8))
    fits = [log.mounts.coils, len(log.mounts.names)]
    frames = [each for each in frames if [len(each.current), len(each.force)] == fits]
    if not frames:
        return
    time, poses = np.array([each.time for each in frames]), [each.pose for each in frames]
    current, force = (np.stack([getattr(each, name) for each in frames]) for name in ("current", "force"))
    log.frames(time, poses)
    log.mount_frames(time, poses, current, force)
    for sensor in log.sensors:
        specific_force = np.stack([each.specific_force[sensor.name] for each in frames])
        log.sensor_frames(sensor.name, time, specific_force)
        if sensor.name in (CHASSIS, POWERTRAIN):
            add_points(stream, ACCELERATION, sensor.name, time, specific_force[:, 2] - GRAVITY_UP[2])
    for name, values in zip(log.mounts.names, current.T, strict=False):
        add_points(stream, CURRENT, name, time, values)
    for name, values in zip(log.mounts.names, force.T, strict=True):
        add_points(stream, FORCE, name, time, 1e-3 * values)
