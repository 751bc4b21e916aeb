"""Where everything of a vehicle is at one moment, from the state of its simulation."""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from ..rui.sweeps.cells import columns
from ..rui.sweeps.kinematics import MotionOffset, new_motion, update_motion
from ..vehicle.body_tree import SIDES, build_body_table, idler_name
from ..vehicle.tracks.nodes import STRIDE


class Pose(NamedTuple):
    """All bodies, in the order of the vehicle's table, and the pins of both tracks; global axes."""

    place: np.ndarray  # (n, 3) of the bodies' origins, m
    attitude: np.ndarray  # (n, 4) of the bodies, quaternions x, y, z, w
    pins: tuple  # of the left track and the right one, (links, 3) each, in the order of `vehicle.tracks.nodes`, m


class PoseReader:
    """Reads poses of one vehicle.

    Attributes
    ----------
    names : list of str
        Of the bodies.
    """

    def __init__(self, vehicle, system):
        self.names = [body.name for body in build_body_table(vehicle)]
        self._system, self._motion = system, new_motion(system.tree)
        self._idlers = [self.names.index(idler_name(side)) for side in SIDES]

    def read(self, state):
        """Return the `Pose` of a `vehicle.system.State`."""
        tree, motion = self._system.tree, self._motion
        update_motion(tree, state.tree, motion)
        place = columns(motion, MotionOffset.ORIGIN, 3)[tree.row]
        turns = columns(motion, MotionOffset.ROTATION, 9)[tree.row].reshape(-1, 3, 3)
        place[self._idlers] += state.tracks.tensioner.travel[:, None] * turns[0, :, 0]  # along the hull's x axis
        nodes = (each.reshape(-1, STRIDE)[:3] for each in state.tracks.nodes)
        links = self._system.tracks.chain.links
        pins = tuple(each[:, 1 : count + 1].T.copy() for each, count in zip(nodes, links, strict=True))
        return Pose(place, Rotation.from_matrix(turns).as_quat(), pins)

    def velocities(self, state):
        """Return velocities of the bodies' origins [m/s] and angular velocities [rad/s], (n, 3) each, in global axes.

        Those of the `vehicle.system.State` that was read last.
        """
        row = self._system.tree.row
        velocity = columns(self._motion, MotionOffset.VELOCITY, 3)[row]
        turning = columns(self._motion, MotionOffset.ANGULAR_VELOCITY, 3)[row]
        forward = columns(self._motion, MotionOffset.ROTATION, 9)[row].reshape(-1, 3, 3)[0, :, 0]
        travel, rate = (
            each[:, None] * forward for each in (state.tracks.tensioner.travel, state.tracks.tensioner.rate)
        )
        velocity[self._idlers] += rate + np.cross(turning[0], travel)
        return velocity, turning


def link_poses(pins, left):
    """Return middles (k, 3) and attitudes (k, 4) of the links between pins (k, 3) of a closed track.

    Each has its x axis from its pin to the next, its z axis upright to that and to `left` (3,), the hull's y axis.
    """
    following = np.roll(pins, -1, axis=0)
    x = following - pins
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    z = np.cross(x, left)
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    turns = np.stack((x, np.cross(z, x), z), axis=-1)
    return 0.5 * (pins + following), Rotation.from_matrix(turns).as_quat()


def left_axis(pose):
    """Return the hull's y axis (3,)."""
    return Rotation.from_quat(pose.attitude[0]).as_matrix()[:, 1]
