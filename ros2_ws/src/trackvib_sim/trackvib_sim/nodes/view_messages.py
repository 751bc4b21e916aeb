"""Messages for viewers; each translator keeps one message and fills it anew."""

import numpy as np
from geometry_msgs.msg import Point, TransformStamped
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.packed_message import PackedMessage
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from ..numerics.units import NANO
from ..scene.colours import SHOE
from ..scene.road_strips import road_strips, way_held
from ..vehicle.body_tree import SIDE_NAMES
from .messages import set_stamp

_THICK = 0.05  # m, of the lines that stand for links
_BEHIND, _AHEAD = 12.0, 25.0  # m of road around the hull's origin
_SAMPLES = 400  # of it, at most


def transforms(stamp, frames):
    """Return the message of frames, each its parent, name, place (3,) [m] and attitude (4,), at a time [ns]."""
    message = TFMessage()
    for parent, child, place, attitude in frames:
        each = TransformStamped(child_frame_id=child)
        each.header.frame_id = parent
        each.header.stamp.sec, each.header.stamp.nanosec = divmod(stamp, NANO)
        _fill(each.transform, list(map(float, place)), list(map(float, attitude)))
        message.transforms.append(each)
    return message


def _fill(transform, place, attitude):
    t, q = transform.translation, transform.rotation
    t.x, t.y, t.z = place
    q.x, q.y, q.z, q.w = attitude


class TransformsMessage:
    """Frames of the children of some joints (`scene.frames.Joint`) on their parents."""

    def __init__(self, joints):
        here = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
        self._message = transforms(0, [(joint.parent, joint.child, *here) for joint in joints])

    def fill(self, stamp, place, attitude):
        """Return the message with places (k, 3) [m] and attitudes (k, 4) at a time [ns]."""
        seconds, nanoseconds = divmod(stamp, NANO)
        for each, *pose in zip(self._message.transforms, place.tolist(), attitude.tolist(), strict=True):
            each.header.stamp.sec, each.header.stamp.nanosec = seconds, nanoseconds
            _fill(each.transform, *pose)
        return self._message


class JointStateMessage:
    """Positions and rates of joints."""

    def __init__(self, names):
        message = JointState(name=names, position=[0.0] * len(names), velocity=[0.0] * len(names))
        self._packed = PackedMessage(message, {"position": (len(names),), "velocity": (len(names),)})

    def fill(self, stamp, position, rate):
        """Return the message's bytes."""
        return self._packed.fill(stamp, position=position, velocity=rate)


class TrackLinksMessage:
    """Every link of both tracks as a line from its pin to the next."""

    def __init__(self, links):
        self._markers = []
        for side, name in SIDE_NAMES.items():
            marker = _marker(f"{name}_track", Marker.LINE_LIST, SHOE)
            marker.scale.x = _THICK
            marker.points = [Point() for _ in range(2 * links[side])]
            self._markers.append(marker)

    def fill(self, stamp, pins):
        """Return the message for the pins of both tracks, (links, 3) each [m]."""
        for marker, side in zip(self._markers, pins, strict=True):
            set_stamp(marker, stamp)
            places = side.tolist()
            for k, (x, y, z) in enumerate(places):
                point = marker.points[2 * k]
                point.x, point.y, point.z = x, y, z
                # the same place ends the link behind
                point = marker.points[2 * k - 1]
                point.x, point.y, point.z = x, y, z
        return MarkerArray(markers=self._markers)


class RoadMessage:
    """The road around the vehicle as triangles."""

    def __init__(self, vehicle):
        self._track_y = vehicle.road_wheels.y

    def fill(self, stamp, road, path):
        """Return the message for a `road.store.Road` along a `vehicle.drive.path.Path` at a time [ns]."""
        here, last = float(path.distance[0]), road.first + road.height.shape[1] - 1
        first = max(int((here - _BEHIND) / road.spacing), road.first)
        last = min(int((here + _AHEAD) / road.spacing), last)
        samples = np.arange(first, last + 1, 1 + (last - first) // _SAMPLES)
        heights = road.height[:, samples - road.first]
        strips = road_strips(road.spacing * samples, heights, way_held(path), self._track_y)
        marker = _marker("road", Marker.TRIANGLE_LIST, (255, 255, 255))
        set_stamp(marker, stamp)
        marker.scale.x = marker.scale.y = marker.scale.z = 1.0
        corners = [Point(x=x, y=y, z=z) for x, y, z in strips.corners.reshape(-1, 3).tolist()]
        colours = (strips.colours.reshape(-1, 3) / 255.0).tolist()
        colours = [ColorRGBA(r=r, g=g, b=b, a=1.0) for r, g, b in colours]
        numbers = strips.triangles.ravel().tolist()
        marker.points, marker.colors = [corners[k] for k in numbers], [colours[k] for k in numbers]
        return marker


def _marker(name, kind, colour):
    marker = Marker(ns=name, type=kind, action=Marker.ADD)
    marker.header.frame_id = topics.ROAD_FRAME
    marker.pose.orientation.w = 1.0
    marker.color.r, marker.color.g, marker.color.b = (value / 255.0 for value in colour)
    marker.color.a = 1.0
    return marker
