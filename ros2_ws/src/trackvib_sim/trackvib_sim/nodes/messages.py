"""From records of the simulation to messages; each translator keeps one message and fills it anew."""

import re
from importlib import import_module

from ament_index_python.packages import get_package_share_directory
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Vector3
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.packed_message import PackedMessage
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import DriveState, Mount, MountDescription, MountState

from ..numerics.units import NANO, RPM
from ..vehicle.drive.path import path_heading

_MESSAGE_TYPE = re.compile(r"[a-z][a-z0-9_]*/msg/[A-Z][A-Za-z0-9]*")


def message_type(name):
    """Return the class of a message type such as `sensor_msgs/msg/Imu`.

    Raises
    ------
    ValueError
        It is not installed here, or is a part of a service or an action, of which there is no definition to go along.
    """
    if not _MESSAGE_TYPE.fullmatch(name):
        raise ValueError(f"{name} is not a message type")
    package, kind, message = name.split("/")
    try:
        get_package_share_directory(package)  # nothing but packages of ROS is imported by a name from outside
        return getattr(import_module(f"{package}.{kind}"), message)
    except (LookupError, ImportError, AttributeError):
        raise ValueError(f"message type {name} is not installed") from None


def set_stamp(message, nanoseconds):
    """Write simulated time [ns] to a message's header."""
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(nanoseconds, NANO)


def set_vector(vector, values):
    """Write three numbers to a Vector3 or Point."""
    vector.x, vector.y, vector.z = values


class ImuMessage:
    """Specific force and angular velocity of one sensor (REP-145); attitude is not measured."""

    def __init__(self, frame):
        message = Imu()
        message.header.frame_id = frame
        message.orientation_covariance[0] = -1.0
        self._packed = PackedMessage(message, {"linear_acceleration": (3,), "angular_velocity": (3,)})

    def fill(self, stamp, specific_force, rate):
        """Return the message's bytes; vectors (3,) in body axes, m/s^2 and rad/s."""
        return self._packed.fill(stamp, linear_acceleration=specific_force, angular_velocity=rate)


class MountMessage:
    """State of all mounts.

    Parameters
    ----------
    sample : vehicle.mounts.MountSample
        One of those that it will be filled with; tells how many coils and mounts there are.
    """

    def __init__(self, sample):
        message = MountState()
        message.header.frame_id = topics.HULL_FRAME
        for name, values in sample._asdict().items():
            setattr(message, name, [0.0 if values.ndim == 1 else Vector3() for _ in values])
        self._packed = PackedMessage(message, {name: values.shape for name, values in sample._asdict().items()})

    def fill(self, stamp, sample):
        """Return the message's bytes."""
        return self._packed.fill(stamp, **sample._asdict())


def mount_description(mounting):
    """Return the message that describes a `mr_mount_controller.mounting.Mounting`."""
    message = MountDescription(turning=[bool(axis) for axis in mounting.turning])
    message.header.frame_id = topics.CHASSIS_FRAME
    for mount in mounting.mounts:
        message.mounts.append(Mount(name=mount.name, kind=int(mount.kind)))
        set_vector(message.mounts[-1].place, mount.place)
    for name, value in mounting.carried._asdict().items():
        setattr(message.carried, name, value)
    curve = mounting.curve._asdict()
    message.curve.current_range = [curve.pop("lowest"), curve.pop("highest")]
    for name, value in curve.items():
        setattr(message.curve, name, value)
    return message


class DriveMessage:
    """How the vehicle is driven."""

    def __init__(self):
        message = DriveState()
        message.header.frame_id = topics.HULL_FRAME
        numbers = ("distance", "offset", "wanted_speed", "curvature", "engine_speed", "gear")
        fields = dict.fromkeys(numbers, ()) | {"sprocket_speed": (2,), "sprocket_torque": (2,)}
        self._packed = PackedMessage(message, fields)

    def fill(self, stamp, system, state):
        """Return the message's bytes for a `vehicle.system.System` and its `State` at a time [ns]."""
        drive = state.drive
        return self._packed.fill(
            stamp,
            distance=drive.path.distance[0],
            offset=drive.path.offset[0],
            wanted_speed=drive.wanted.speed[0],
            curvature=path_heading(drive.path)[1],
            engine_speed=drive.crank.speed[0] / RPM,
            gear=drive.shaft.gear[0],
            sprocket_speed=state.tree.hinge_rate[system.drive.driver.sprocket],
            sprocket_torque=drive.driving.torque,
        )


class OdometryMessage:
    """Pose of the hull on the road and its velocity in its own axes."""

    _POSITION, _ORIENTATION = "pose.pose.position", "pose.pose.orientation"
    _LINEAR, _ANGULAR = "twist.twist.linear", "twist.twist.angular"

    def __init__(self):
        message = Odometry()
        message.header.frame_id = topics.ROAD_FRAME
        message.child_frame_id = topics.HULL_FRAME
        vectors = dict.fromkeys((self._POSITION, self._LINEAR, self._ANGULAR), (3,))
        self._packed = PackedMessage(message, vectors | {self._ORIENTATION: (4,)})

    def fill(self, stamp, state, sample):
        """Return the message's bytes for a `rui.state.TreeState` and the `simulation.step.Sample` of that instant."""
        w, x, y, z = state.attitude[0].tolist()
        values = {
            self._POSITION: state.position[0],
            self._ORIENTATION: (x, y, z, w),
            self._LINEAR: sample.hull_velocity[0],
            self._ANGULAR: sample.hull_angular_velocity[0],
        }
        return self._packed.fill(stamp, **values)


def diagnostics(stamp, level, text, values):
    """Return a DiagnosticArray with the one status "simulator"; `values` is written out as text."""
    levels = {"ok": DiagnosticStatus.OK, "warning": DiagnosticStatus.WARN, "error": DiagnosticStatus.ERROR}
    status = DiagnosticStatus(level=levels[level], name="simulator", message=text, hardware_id="trackvib")
    status.values = [KeyValue(key=key, value=str(value)) for key, value in values.items()]
    message = DiagnosticArray(status=[status])
    set_stamp(message, stamp)
    return message
