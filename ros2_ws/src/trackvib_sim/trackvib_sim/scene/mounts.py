"""Mounts as springs that stand on their body's parent, and sensors as marks."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..vehicle.body_tree import bodies_on_hinges
from ..vehicle.mounts import mounts_in_order
from ..vehicle.sensors import sensors_of

_HEIGHT = 0.26  # m of a spring, as in the drawing
# of a spring from its base up: parts of its height, and of its width to either side
_UP = np.array([0.0, 0.16, 0.22, 0.34, 0.46, 0.58, 0.70, 0.82, 0.88, 1.0])
_ASIDE = 0.05 * np.array([0, 0, -1, 1, -1, 1, -1, 1, 0, 0])  # m


class MountPlaces(NamedTuple):
    """Where m mounts hold on, those with coils first."""

    names: list
    coils: int  # how many have one
    body: np.ndarray  # (m,) numbers of the bodies in the vehicle's table
    parent: np.ndarray  # (m,)
    upper: np.ndarray  # (m, 3) on the body, m
    base: np.ndarray  # (m, 3) of the spring, on the parent, m
    highest: float  # current of the coils, A

    def springs(self, pose):
        """Return the lines (m, 10, 3) of the springs in a `poses.Pose` [m]."""
        turn = Rotation.from_quat(pose.attitude)
        low = pose.place[self.parent] + turn[self.parent].apply(self.base)
        high = pose.place[self.body] + turn[self.body].apply(self.upper)
        across = turn[self.parent].apply(np.tile((0.0, 1.0, 0.0), (len(low), 1)))
        return low[:, None] + _UP[:, None] * (high - low)[:, None] + _ASIDE[:, None] * across[:, None]


class SensorPlace(NamedTuple):
    """A sensor on its body."""

    name: str
    body: str
    place: np.ndarray  # (3,) body axes, m
    attitude: np.ndarray  # (4,) of its axes in the body's, quaternion x, y, z, w


def mount_places(vehicle, names):
    """Return the `MountPlaces` of a vehicle whose bodies are called `names`, in the order of its table."""
    listed, bodies, number = mounts_in_order(vehicle), bodies_on_hinges(vehicle), names.index
    upper = np.array([mount.place for _, mount in listed], dtype=float).reshape(-1, 3)
    origin = np.array([bodies[mount.body].place for _, mount in listed], dtype=float).reshape(-1, 3)
    kinds = [vehicle.mount_types[mount.type] for _, mount in listed]
    return MountPlaces(
        names=[name for name, _ in listed],
        coils=sum(kind.kind == "mr" for kind in kinds),
        body=np.array([number(mount.body) for _, mount in listed], dtype=np.int64),
        parent=np.array([number(bodies[mount.body].parent) for _, mount in listed], dtype=np.int64),
        upper=upper,
        base=upper + origin - (0.0, 0.0, _HEIGHT),
        highest=max((kind.current_range[1] for kind in kinds if kind.kind == "mr"), default=1.0),
    )


def sensor_places(vehicle):
    """Return the `SensorPlace` of every sensor of a vehicle, chassis and powertrain first."""
    return [
        SensorPlace(each.name, each.body, np.array(each.place, dtype=float), Rotation.from_matrix(each.turn).as_quat())
        for each in sensors_of(vehicle)
    ]
