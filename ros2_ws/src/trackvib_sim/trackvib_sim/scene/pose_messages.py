"""Poses from what the simulator publishes for viewers on /tf and as track links, from ROS or out of a bag."""

import numpy as np
from mr_mount_controller.node_base.topics import ROAD_FRAME
from scipy.spatial.transform import Rotation

from ..numerics.units import NANO
from ..vehicle.body_tree import SIDES, build_body_table
from .frames import frame_name
from .poses import Pose

_DEEPEST = 64  # of frames below frames; a ring has no end


class PoseAssembly:
    """Puts poses of a vehicle (`parameters.Vehicle`) together from messages of one stamp.

    What it takes may come from anywhere: `ValueError` or `LookupError` where it does not fit the vehicle.
    """

    def __init__(self, vehicle):
        self._bodies = [frame_name(body.name) for body in build_body_table(vehicle)]
        self._links = [int(count) for count in vehicle.tracks.links]
        self._frames, self._tracks = (-1, None), (-1, None)

    def take_frames(self, message):
        """Take a message of /tf; returns stamp [ns] and `Pose` if that completes one, else None."""
        found = {}
        for each in message.transforms:
            t, q = each.transform.translation, each.transform.rotation
            found[each.child_frame_id] = each.header.frame_id, (t.x, t.y, t.z), (q.x, q.y, q.z, q.w)
            self._frames = _stamp(each), found
        return self._complete()

    def take_tracks(self, message):
        """Take the track links; returns as `take_frames` does."""
        if len(message.markers) != len(SIDES):
            raise ValueError(f"{len(message.markers)} tracks")
        pins = tuple(np.array([(p.x, p.y, p.z) for p in each.points[::2]]) for each in message.markers)
        if [len(each) for each in pins] != self._links:
            raise ValueError(f"tracks of {[len(each) for each in pins]} links, not {self._links}")
        if not all(np.isfinite(each).all() for each in pins):
            raise ValueError("a place is not finite")
        self._tracks = _stamp(message.markers[0]), pins
        return self._complete()

    def _complete(self):
        (stamp, found), (other, pins) = self._frames, self._tracks
        if stamp != other or found is None:
            return None
        return stamp, Pose(*_placed(found, self._bodies), pins)


def _stamp(message):
    return message.header.stamp.sec * NANO + message.header.stamp.nanosec


def _placed(found, bodies):
    """Return places (n, 3) and attitudes (n, 4) of frames from those of their parents."""
    row, place, turn = {ROAD_FRAME: 0}, np.zeros((1, 3)), Rotation.identity(1)
    for _ in range(_DEEPEST):
        if row.keys() >= set(bodies):
            break
        new = [name for name, (parent, *_) in found.items() if parent in row and name not in row]
        if not new:
            raise ValueError("frames that are not connected")
        parents, places, turns = zip(*(found[name] for name in new), strict=True)
        below = [row[name] for name in parents]
        place = np.concatenate((place, place[below] + turn[below].apply(places)))
        turn = Rotation.concatenate((turn, turn[below] * Rotation.from_quat(turns)))
        row |= {name: len(row) + k for k, name in enumerate(new)}
    chosen = [row[name] for name in bodies]
    if not np.isfinite(place[chosen]).all():
        raise ValueError("a place is not finite")
    return place[chosen], turn[chosen].as_quat()
