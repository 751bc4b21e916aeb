"""Poses as a bag has them on /tf and among its track links: of a run that followed the wall clock."""

import numpy as np
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import LayoutError
from scipy.spatial.transform import Rotation

from ..bags.definitions import Definition
from ..bags.errors import BagError
from ..bags.raw_messages import RawMessage, raw_records
from ..numerics.units import NANO
from ..scene.frames import frame_name
from ..scene.poses import Pose
from ..scene.road_strips import way_of
from ..vehicle.body_tree import SIDES, build_body_table

_DEEPEST = 64  # of frames below frames; a ring has no end
_TYPES = {topics.TF: topics.TF_TYPE, topics.TRACK_LINKS: topics.TRACK_LINKS_TYPE}


def read_recorded_poses(recording, vehicle, span):
    """Return times (k,) [ns] and k `Pose`s of a `motion.Span` of a bag, as often as it has them but no more often.

    Raises
    ------
    BagError
        The bag has none, or they do not fit its vehicle.
    """
    bodies = [frame_name(body.name) for body in build_body_table(vehicle)]
    links = [int(count) for count in vehicle.tracks.links]
    pending, frames, due = {}, [], span.start * NANO
    try:
        for topic, message in _messages(recording.path):
            stamp, part = _transforms(message) if topic == topics.TF else _pins(message, links)
            if not due <= stamp <= span.end * NANO:
                continue
            pending.setdefault(stamp, {})[topic] = part
            if len(pending[stamp]) == len(_TYPES):
                parts = pending.pop(stamp)
                frames.append((stamp, Pose(*_placed(parts[topics.TF], bodies), parts[topics.TRACK_LINKS])))
                due = stamp + (1.0 - 1e-6) * NANO / span.rate
                pending.clear()
    except (LayoutError, LookupError, ValueError) as error:
        raise BagError(f"the poses in bag {str(recording.path)!r} are not those of its vehicle: {error}") from None
    if not frames:
        raise BagError(
            f"bag {str(recording.path)!r} holds no poses on {topics.TF} and {topics.TRACK_LINKS}, which a run that "
            "followed the wall clock needs: record it with the simulator's view_rate"
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
        end = next((end for end in _TYPES if f"/{record.topic}".endswith(f"/{end.lstrip('/')}")), None)
        if end is None or record.type_name != _TYPES[end]:
            continue
        key = (record.schema.name, record.schema.data)
        if key not in definitions:
            definitions[key] = Definition(record.schema.name, record.schema.encoding, record.schema.data)
        yield end, definitions[key].message(record.message.data)


def _transforms(message):
    """Return the stamp [ns] of a message of /tf, and by frame its parent, place (3,) and attitude (4,)."""
    found, stamp = {}, -1
    for each in message.transforms:
        place, turn = each.transform.translation, each.transform.rotation
        found[each.child_frame_id] = each.header.frame_id, (place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w)
        stamp = each.header.stamp.sec * NANO + each.header.stamp.nanosec
    return stamp, found


def _placed(found, bodies):
    """Return places (n, 3) and attitudes (n, 4) of frames from those of their parents."""
    known = {topics.ROAD_FRAME: (np.zeros(3), Rotation.identity())}

    def of(frame, depth=0):
        if frame not in known:
            if depth > _DEEPEST:
                raise ValueError(f"frames more than {_DEEPEST} deep")
            parent, place, turn = found[frame]
            origin, axes = of(parent, depth + 1)
            known[frame] = origin + axes.apply(place), axes * Rotation.from_quat(turn)
        return known[frame]

    placed = [of(frame) for frame in bodies]
    place = np.array([place for place, _ in placed])
    if not np.isfinite(place).all():
        raise ValueError("a place is not finite")
    return place, np.array([turn.as_quat() for _, turn in placed])


def _pins(message, links):
    """Return the stamp [ns] of the track links, and the pins (links, 3) of both tracks."""
    if len(message.markers) != len(SIDES):
        raise ValueError(f"{len(message.markers)} tracks")
    pins = tuple(np.array([(p.x, p.y, p.z) for p in each.points[::2]]) for each in message.markers)
    if [len(each) for each in pins] != links:
        raise ValueError(f"tracks of {[len(each) for each in pins]} links, not {links}")
    if not all(np.isfinite(each).all() for each in pins):
        raise ValueError("a place is not finite")
    stamp = message.markers[0].header.stamp
    return stamp.sec * NANO + stamp.nanosec, pins
