"""What the simulator publishes for viewers, as it comes: for a view of a run that goes on."""

import contextlib
import time
from typing import NamedTuple

import numpy as np
import rclpy
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.listener import whole_message
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_QOS
from rclpy.experimental import EventsExecutor
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage
from trackvib_msgs.msg import MountState
from visualization_msgs.msg import Marker, MarkerArray

from ..numerics.units import NANO
from ..scene.pose_messages import PoseAssembly


class LiveFrame(NamedTuple):
    """A pose, with the latest of all else."""

    time: int  # ns
    pose: object  # scene.poses.Pose
    specific_force: dict  # by sensor, (3,) m/s^2
    current: np.ndarray  # (coils,) A
    force: np.ndarray  # (m,) of the mounts upwards, N


class LivePoses:
    """Listens to a simulator with a view rate, in a ROS context of its own.

    Attributes
    ----------
    frames : list of LiveFrame
        That have come and were not taken away.
    roads : list
        Stamps [ns], corners (n, 3) [m] and colours (n, 3) of triangles of road that were not taken away.
    """

    def __init__(self, vehicle, names, namespace):
        """Listen in a namespace for a vehicle (`parameters.Vehicle`) whose sensors are called `names`."""
        self.frames, self.roads, self._sensors, self._mounts = [], [], {}, None
        self._names = list(names)
        self._assembly, self._context = PoseAssembly(vehicle), rclpy.Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        name = f"live_view_{time.monotonic_ns()}"
        self._node = rclpy.create_node(name, namespace=namespace, context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._listen(TFMessage, topics.TF, self._on_frames)
        self._listen(MarkerArray, topics.TRACK_LINKS, self._on_tracks)
        self._listen(Marker, topics.ROAD_STRIPS, self._on_road, LATCHED_QOS)
        self._listen(MountState, topics.MOUNT_STATE, self._on_mounts)
        for name in names:
            self._listen(Imu, topics.imu_topic(name), lambda message, name=name: self._on_sensor(name, message))

    def look(self, seconds):
        """Take in what comes within some time."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            self._executor.spin_once(timeout_sec=left)

    def close(self):
        """End listening."""
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def _listen(self, kind, topic, take, qos=LOOP_QOS):
        read = whole_message(kind)

        def on_bytes(data):
            # what does not fit is somebody else's
            with contextlib.suppress(LayoutError, ValueError, LookupError):
                take(read(data))

        self._node.create_subscription(kind, topic, on_bytes, qos, raw=True)

    def _on_frames(self, message):
        self._keep(self._assembly.take_frames(message))

    def _on_tracks(self, message):
        self._keep(self._assembly.take_tracks(message))

    def _keep(self, done):
        if done and self._mounts and len(self._sensors) == len(self._names):
            self.frames.append(LiveFrame(*done, dict(self._sensors), *self._mounts))

    def _on_road(self, message):
        corners = np.array([(p.x, p.y, p.z) for p in message.points])
        colours = np.array([(c.r, c.g, c.b) for c in message.colors])
        if len(corners) % 3 == 0 and corners.shape == colours.shape and np.isfinite(corners).all():
            self.roads.append((_time(message), corners, colours))

    def _on_sensor(self, name, message):
        a = message.linear_acceleration
        self._sensors[name] = np.array([a.x, a.y, a.z])

    def _on_mounts(self, message):
        self._mounts = np.array(message.current), np.array([force.z for force in message.force])


def _time(message):
    return message.header.stamp.sec * NANO + message.header.stamp.nanosec
