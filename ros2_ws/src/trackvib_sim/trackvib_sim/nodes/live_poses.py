"""What the simulator publishes, poses and every sample, as it comes: for a view of a run that goes on."""

import contextlib
import time
from typing import NamedTuple

import numpy as np
import rclpy
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.cdr import LayoutError
from mr_mount_controller.node_base.listener import whole_message
from mr_mount_controller.node_base.packed_message import MessageReader
from mr_mount_controller.node_base.qos import LATCHED_QOS
from rclpy.experimental import EventsExecutor
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage
from trackvib_msgs.msg import MountState
from visualization_msgs.msg import Marker, MarkerArray

from ..numerics.units import NANO
from ..scene.pose_messages import PoseAssembly
from .partners import LIVE_VIEW

_QOS = QoSProfile(depth=10_000)  # some seconds of samples, as a view that draws is slow for a moment
_MOUNTS = ""  # no sensor has that name
_REST = 0.02  # s between looks; waking for every message would take the processor from the loop


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

    def __init__(self, vehicle, names, mounts, namespace):
        """Listen in a namespace for a vehicle (`parameters.Vehicle`).

        Its sensors are called `names`, and it has as many coils and mounts as the pair `mounts` says.
        """
        self.frames, self.roads = [], []
        (self._coils, self._mounts), self._received = mounts, 0
        self._samples = {name: [] for name in (*names, _MOUNTS)}
        self._latest = {}
        self._assembly, self._context = PoseAssembly(vehicle), rclpy.Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        name = f"{LIVE_VIEW}_{time.monotonic_ns()}"
        self._node = rclpy.create_node(name, namespace=namespace, context=self._context)
        self._executor = EventsExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._listen(TFMessage, topics.TF, self._on_frames)
        self._listen(MarkerArray, topics.TRACK_LINKS, self._on_tracks)
        self._listen(Marker, topics.ROAD_STRIPS, self._on_road, qos=LATCHED_QOS)
        fields = {"current": mounts[0], "force": 3 * mounts[1]}
        self._follow(MountState, topics.MOUNT_STATE, _MOUNTS, fields)
        for name in names:
            self._follow(Imu, topics.imu_topic(name), name, {"linear_acceleration": 3})

    def look(self, seconds):
        """Take in what comes within some time; returns whether anything did."""
        first, end = self._received, time.monotonic() + seconds
        while time.monotonic() < end:
            time.sleep(_REST)
            before = None
            while self._received != before and time.monotonic() < end:  # one callback each
                before = self._received
                self._executor.spin_once(timeout_sec=0.0)
        return self._received > first

    def take_sensor(self, name):
        """Return times (k,) [ns] and specific forces (k, 3) [m/s^2] that came since the last call."""
        return self._take(name, 3)

    def take_mounts(self):
        """Return times (k,) [ns], currents (k, coils) [A] and forces upwards (k, m) [N] since the last call."""
        stamps, values = self._take(_MOUNTS, self._coils + 3 * self._mounts)
        return stamps, *self._split(values)

    def close(self):
        """End listening."""
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._context)

    def _listen(self, kind, topic, take, read=None, qos=_QOS):
        read = read or whole_message(kind)

        def on_bytes(data):
            self._received += 1
            # what does not fit is somebody else's
            with contextlib.suppress(LayoutError, ValueError, LookupError):
                take(read(data))

        self._node.create_subscription(kind, topic, on_bytes, qos, raw=True)

    def _follow(self, kind, topic, name, fields):
        """Keep every sample of a topic under a name."""

        def take(sample):
            self._samples[name].append(sample)
            self._latest[name] = sample[1]

        self._listen(kind, topic, take, MessageReader(kind, "header.stamp", fields).read)

    def _take(self, name, count):
        """Return times (k,) [ns] and the `count` numbers (k, count) of the samples that came since the last call."""
        samples, self._samples[name] = self._samples[name], []
        stamps = np.array([stamp for stamp, _ in samples], dtype=np.int64)
        return stamps, np.array([numbers for _, numbers in samples]).reshape(-1, count)

    def _on_frames(self, message):
        self._keep(self._assembly.take_frames(message))

    def _on_tracks(self, message):
        self._keep(self._assembly.take_tracks(message))

    def _keep(self, done):
        if done and len(self._latest) == len(self._samples):
            others = {name: np.array(numbers) for name, numbers in self._latest.items()}
            mounts = others.pop(_MOUNTS)
            self.frames.append(LiveFrame(*done, others, *self._split(mounts)))

    def _split(self, mounts):
        """Return currents and forces upwards of numbers (..., coils + 3 m)."""
        return mounts[..., : self._coils], mounts[..., self._coils + 2 :: 3]

    def _on_road(self, message):
        corners = np.array([(p.x, p.y, p.z) for p in message.points])
        colours = np.array([(c.r, c.g, c.b) for c in message.colors])
        if len(corners) % 3 == 0 and corners.shape == colours.shape and np.isfinite(corners).all():
            self.roads.append((_time(message), corners, colours))


def _time(message):
    return message.header.stamp.sec * NANO + message.header.stamp.nanosec
