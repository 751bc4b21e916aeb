"""A hidden node of the stand-in among the others: what it sees of them, and a wait that Ctrl-C ends in order."""

import os
import re
import signal
import time
from importlib import import_module

import rclpy
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from mr_mount_controller.node_base.node_process import start_ros
from rclpy.experimental import EventsExecutor

from environment.ros2_stand_in.terminal import Failure

_TICK = 0.05  # s
_PATIENCE = 5.0  # s for a topic that is asked for by its name
_LONGEST_LOOK = 20.0  # times the quiet time: a graph that never rests is told as it is
_INTERFACE = re.compile(r"([a-zA-Z]\w*)/(?:(msg|srv)/)?([A-Za-z]\w*)")


class Session:
    """Use as a context manager; signals that ask to end raise KeyboardInterrupt out of `spin` only."""

    def __enter__(self):
        self._stop = []
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: self._stop.append(True))
        start_ros()
        self.node = rclpy.create_node(f"_ros2cli_{os.getpid()}", start_parameter_services=False, enable_rosout=False)
        self._executor = EventsExecutor()
        self._executor.add_node(self.node)
        return self

    def __exit__(self, *_):
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown()

    def spin(self, seconds=_TICK):
        """Serve callbacks for a moment."""
        self._executor.spin_once(timeout_sec=seconds)
        if self._stop:
            raise KeyboardInterrupt

    def wait_until(self, condition, timeout=None):
        """Return whether a condition has come true within some seconds."""
        end = None if timeout is None else time.monotonic() + timeout
        while not condition():
            if end is not None and time.monotonic() > end:
                return False
            self.spin()
        return True

    def settle(self, quiet):
        """Look until nothing new has been found for `quiet` seconds."""
        seen, since, end = None, time.monotonic(), time.monotonic() + _LONGEST_LOOK * max(quiet, _TICK)
        while time.monotonic() - since < quiet and time.monotonic() < end:
            now = self.node_names(), self.node.get_topic_names_and_types(), self.node.get_service_names_and_types()
            if now != seen:
                seen, since = now, time.monotonic()
            self.spin()

    def find_topic(self, topic, quiet):
        """Return the types of a topic by its full name, none if it is not found; its ends are known, too."""
        types = lambda: dict(self.node.get_topic_names_and_types()).get(topic, [])  # noqa: E731
        if self.wait_until(types, _PATIENCE):
            self.settle(quiet)
        return types()

    def node_names(self):
        """Return the full names of all nodes but this one, sorted; one for each that is there."""
        pairs = self.node.get_node_names_and_namespaces()
        names = [f"{space.rstrip('/')}/{name}" for name, space in pairs]
        return sorted(name for name in names if name != self.node.get_fully_qualified_name())

    def require_node(self, name, timeout):
        """Return the full name of a node; raises `Failure` if it does not appear within some seconds."""
        name = name if name.startswith("/") else f"/{name}"
        if not self.wait_until(lambda: name in self.node_names(), timeout):
            raise Failure("Node not found")
        return name


def absolute(name):
    """Return the full name of a topic or service."""
    return name if name.startswith("/") else f"/{name}"


def shown(names_and_types, hidden):
    """Return names with their types as text, in order; with those that begin with an underscore if wanted."""
    return [(name, ", ".join(types)) for name, types in sorted(names_and_types) if hidden or not is_hidden(name)]


def is_hidden(name):
    """Return whether a part of a name begins with an underscore."""
    return any(part.startswith("_") for part in name.split("/"))


def interface(name, kind):
    """Return the class of a type such as `sensor_msgs/msg/Imu`, of the kind "msg" or "srv"; raises `Failure`."""
    found = _INTERFACE.fullmatch(name)
    if not found or found[2] not in (None, kind):
        raise Failure(f"The passed {'service' if kind == 'srv' else 'message'} type is invalid: {name}")
    package, _, type_name = found.groups()
    try:
        get_package_share_directory(package)  # nothing but packages of ROS is imported by a name from outside
        return getattr(import_module(f"{package}.{kind}"), type_name)
    except (PackageNotFoundError, ImportError, AttributeError):
        raise Failure(f"type {name} is not installed here") from None
