"""Poses as a bag has them on /tf and among its track links: of a run that followed the wall clock."""

import numpy as np
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import LayoutError

from ..bags.definitions import Definition
from ..bags.errors import BagError
from ..bags.raw_messages import RawMessage, raw_records
from ..numerics.units import NANO
from ..scene.pose_messages import PoseAssembly
from ..scene.road_strips import way_of

_TYPES = {topics.TF: topics.TF_TYPE, topics.TRACK_LINKS: topics.TRACK_LINKS_TYPE}


def read_recorded_poses(recording, vehicle, span):
    """Return times (k,) [ns] and k `Pose`s of a `motion.Span` of a bag, as often as it has them but no more often.

    Raises
    ------
    BagError
        The bag has none, or they do not fit its vehicle.
    """
    assembly, frames, due = PoseAssembly(vehicle), [], span.start * NANO
    try:
        for topic, message in _messages(recording.path):
            done = assembly.take_frames(message) if topic == topics.TF else assembly.take_tracks(message)
            if done and due <= done[0] <= span.end * NANO:
                frames.append(done)
                due = done[0] + (1.0 - 1e-6) * NANO / span.rate
    except (LayoutError, LookupError, ValueError) as error:
        raise BagError(f"the poses in bag {str(recording.path)!r} are not those of its vehicle: {error}") from None
    if not frames:
        raise BagError(
            f"bag {str(recording.path)!r} holds no poses on {topics.TF} and {topics.TRACK_LINKS}, which are needed "
            "for a run that followed the wall clock: record it with the simulator's view_rate"
        )
    time, poses = zip(*frames, strict=True)
    return np.array(time), list(poses)


def way_of_recording(recording):
    """Return the `Way` that a bag tells of by odometry and state of the drive; straight where it does not."""
    odometry, drive = recording.odometry, recording.drive
    if odometry is None or drive is None:
        return way_of(np.array([0.0, 1.0]), np.zeros(2), np.array([(0.0, 0.0), (1.0, 0.0)]), np.zeros(2))
    _, here, there = np.intersect1d(odometry.stamp, drive.stamp, return_indices=True)
    distance, curvature = drive.distance[there], drive.curvature[there]
    turned = np.concatenate(([0.0], np.cumsum(curvature[:-1] * np.diff(distance))))
    return way_of(distance, drive.offset[there], odometry.position[here, :2], turned)


def _messages(path):
    """Yield what a bag has on the topics of poses: the end of the topic's name, and the message."""
    definitions = {}
    for record in raw_records(path):
        if not isinstance(record, RawMessage) or record.message is None:
            continue
        end = next((end for end in _TYPES if f"/{record.topic}".endswith(f"/{end}")), None)
        if end is None or record.type_name != _TYPES[end]:
            continue
        key = (record.schema.name, record.schema.data)
        if key not in definitions:
            definitions[key] = Definition(record.schema.name, record.schema.encoding, record.schema.data)
        yield end, definitions[key].message(record.message.data)
