"""Follows a running simulator from outside, for whoever shows its progress."""

import time
from math import isfinite

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from mr_mount_controller.node_base.interrupts import put_off_interrupts
from mr_mount_controller.node_base.listener import Listener, Refused
from mr_mount_controller.node_base.node_process import start_ros
from mr_mount_controller.node_base.topics import CHASSIS_IMU, DIAGNOSTICS
from rclpy.experimental import EventsExecutor

_NUMBERS = ("time", "real_time_factor")
_LISTENING = 0.7  # s in which nodes that are there make themselves known


class Watch:
    """Latest diagnostics of the simulator in a namespace; use as a context manager."""

    def __init__(self, namespace="/"):
        self._namespace, self._values = namespace, {}

    def __enter__(self):
        start_ros()
        self._node = rclpy.create_node("trackvib_watch", namespace=self._namespace)
        Listener(self._node, DiagnosticArray, DIAGNOSTICS, self._on_diagnostics, 1)
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        return self

    def __exit__(self, *_):
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown()

    def simulator_is_there(self):
        """Listen for a moment; returns whether a simulator already runs in this ROS domain and namespace."""
        end = time.monotonic() + _LISTENING
        while time.monotonic() < end:
            self._spin(_LISTENING / 10)
            if self._node.count_publishers(CHASSIS_IMU):
                return True
        return False

    def look(self, timeout):
        """Wait at most `timeout` seconds for news; returns the latest values as text, empty before the first."""
        self._spin(timeout)
        return self._values

    def _spin(self, timeout):
        with put_off_interrupts():
            self._executor.spin_once(timeout_sec=timeout)

    def _on_diagnostics(self, message):
        for status in message.status:
            if status.name != "simulator":
                continue
            values = {pair.key: pair.value for pair in status.values}
            if not (values.get("state", "").isalpha() and all(map(_is_number, map(values.get, _NUMBERS)))):
                raise Refused(f"its state and {', '.join(_NUMBERS)} must be a word and numbers")
            self._values = values


def _is_number(text):
    try:
        return isfinite(float(text))
    except (TypeError, ValueError):
        return False
