"""A vehicle's frames as ROS names them, in one tree: `odom` of REP-105, the hull as `base_link`, all else below.

An idler hangs on its tensioner, a slide of its own. Behind an elastic hinge, or between mounts only, a body floats.
"""

from typing import NamedTuple

import numpy as np
from mr_mount_controller.node_base.topics import HULL_FRAME, ROAD_FRAME, imu_frame
from scipy.spatial.transform import Rotation

from ..vehicle.body_tree import HULL, SIDE_NAMES, build_body_table, running_gear_kind
from .mounts import sensor_places

_KINDS = {"revolute": "continuous", "prismatic": "prismatic", "locked": "fixed", "elastic": "floating"}
_ALONG_X = (1.0, 0.0, 0.0)
_NOT_TURNED = np.array([0.0, 0.0, 0.0, 1.0])


class Joint(NamedTuple):
    """What holds one frame on another."""

    kind: str  # "continuous", "prismatic", "fixed" or "floating", as URDF has them
    parent: str  # frame
    child: str  # frame
    place: tuple  # of the child on the parent with the joint's coordinate at zero, m
    axis: tuple = _ALONG_X  # of one with a coordinate, in the parent
    attitude: np.ndarray = _NOT_TURNED  # (4,) of the child at zero, quaternion x, y, z, w

    @property
    def name(self):
        """Name of the joint."""
        return f"{self.child}_joint"

    @property
    def moves(self):
        """Whether it has a coordinate."""
        return self.kind in ("continuous", "prismatic")


def frame_name(body):
    """Return the frame of a body by its name in the table; one that is a frame of ours already gets an ending."""
    if body == HULL:
        return HULL_FRAME
    return f"{body}_body" if body in (HULL_FRAME, ROAD_FRAME) or body.endswith(imu_frame("")) else body


def tensioner_frame(side):
    """Return the frame of a tensioner."""
    return f"{SIDE_NAMES[side]}_tensioner"


def body_joints(vehicle):
    """Return the `Joint`s of all bodies but the hull, parents before children, tensioners before idlers."""
    sides = {name: side for side, name in SIDE_NAMES.items()}
    for body in build_body_table(vehicle):
        hinge = body.hinge
        if hinge is None:
            continue
        parent, place = frame_name(hinge.parent), tuple(map(float, hinge.place))
        if running_gear_kind(body.name) == "idler":
            slide = tensioner_frame(sides[body.name.partition("_")[0]])
            yield Joint("prismatic", parent, slide, place)
            parent, place = slide, (0.0, 0.0, 0.0)
        kind = _KINDS[hinge.kind]
        axis = tuple(map(float, hinge.axis)) if kind in ("continuous", "prismatic") else _ALONG_X
        yield Joint(kind, parent, frame_name(body.name), place, axis)


def sensor_joints(vehicle):
    """Return the fixed `Joint`s of all inertial sensors."""
    for sensor in sensor_places(vehicle):
        place = tuple(sensor.place.tolist())
        yield Joint("fixed", frame_name(sensor.body), imu_frame(sensor.name), place, attitude=sensor.attitude)


class FrameTree:
    """Turns `poses.Pose`s of a vehicle into places of its frames on their parents.

    Attributes
    ----------
    joints : list of Joint
        Those of `body_joints`, behind the one from the road to the hull.
    """

    def __init__(self, vehicle):
        self.joints = [Joint("floating", ROAD_FRAME, HULL_FRAME, (0.0, 0.0, 0.0)), *body_joints(vehicle)]
        names = [frame_name(body.name) for body in build_body_table(vehicle)]
        # a tensioner is where its idler is, turned as the hull is
        origins = [name.replace("tensioner", "idler") if name not in names else name for name in self._children]
        number = {name: row for row, name in enumerate(self._children)}
        self._place = np.array([names.index(name) for name in origins])
        self._turn = np.array([names.index(name) if name in names else 0 for name in self._children])
        self._parent = np.array([number[joint.parent] for joint in self.joints[1:]])

    @property
    def _children(self):
        return [joint.child for joint in self.joints]

    def relative(self, pose):
        """Return places (k, 3) [m] and attitudes (k, 4) of the children of all joints on their parents."""
        place, attitude = pose.place[self._place], pose.attitude[self._turn]
        turn = Rotation.from_quat(attitude)
        back = turn[self._parent].inv()
        on_parent = back.apply(place[1:] - place[self._parent]), (back * turn[1:]).as_quat()
        return np.concatenate((place[:1], on_parent[0])), np.concatenate((attitude[:1], on_parent[1]))


class JointReader:
    """Reads the coordinates of a vehicle's joints from its state.

    Attributes
    ----------
    names : list of str
        Of the joints that have a coordinate.
    """

    def __init__(self, vehicle, system):
        moving = [joint for joint in body_joints(vehicle) if joint.moves]
        rows = dict(zip((frame_name(body.name) for body in build_body_table(vehicle)), system.tree.row, strict=True))
        sides = {tensioner_frame(side): side for side in SIDE_NAMES}
        self.names = [joint.name for joint in moving]
        # the tensioners' coordinates behind those of all hinges
        behind = len(system.tree.lanes) * len(system.tree.parent)
        frames = [joint.child for joint in moving]
        self._places = np.array([behind + sides[name] if name in sides else rows[name] for name in frames])

    def read(self, state):
        """Return positions and rates of a `vehicle.system.State`, in the order of the names [rad, m, rad/s, m/s]."""
        tree, tensioner = state.tree, state.tracks.tensioner
        position = np.concatenate((tree.hinge, tensioner.travel))[self._places]
        return position, np.concatenate((tree.hinge_rate, tensioner.rate))[self._places]
