"""Gives recorded samples to a live controller in lock-step, in place of the simulator."""

from typing import NamedTuple

import numpy as np
import rclpy
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.interrupts import put_off_interrupts
from mr_mount_controller.node_base.listener import Listener
from mr_mount_controller.node_base.node_process import start_ros
from mr_mount_controller.node_base.patience import Patience
from mr_mount_controller.node_base.qos import LATCHED_QOS, LOOP_WRITER_QOS
from mr_mount_controller.node_base.taken_up import taken_up
from rclpy.experimental import EventsExecutor
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import MountDescription

from ..simulation.lockstep import Lockstep
from .answers import Answers, DeafListeners
from .messages import mount_description
from .partners import Gathering

_ANSWER_TIMEOUT = 1.0  # s of wall time after which the controller is silent
_CHANGE_TIMEOUT = 30.0  # s
_TICK = 0.1  # s


class Answer(NamedTuple):
    """A controller's answer to a sample."""

    current: tuple  # (coils,) A
    data: bytes  # the message


class ControllerTrial:
    """A node that speaks to the controller as the simulator does; use as a context manager.

    Parameters
    ----------
    mounting : mr_mount_controller.mounting.Mounting
        What the controller is told.
    """

    def __init__(self, mounting):
        self._mounting = mounting

    def __enter__(self):
        start_ros()
        self._node = rclpy.create_node("replay")
        self._imus = [self._node.create_publisher(Imu, topic, LOOP_WRITER_QOS)
                      for topic in (topics.CHASSIS_IMU, topics.POWERTRAIN_IMU)]  # fmt: skip
        listen = lambda *how: Listener(self._node, *how).subscription  # noqa: E731
        self._answers = Answers(self._node, self._mounting.coils, self._on_answer, listen)
        self._executor = EventsExecutor()
        self._executor.add_node(self._node)
        self._patience = Patience(self._spin)
        self._lockstep = Lockstep(self._mounting.coils, 0.0, (-np.inf, np.inf))
        self._description = self._node.create_publisher(MountDescription, topics.MOUNT_DESCRIPTION, LATCHED_QOS)
        self._description.publish(mount_description(self._mounting))
        self._latest = None
        self._heard, self._given_up = -1, None  # latest sample answered, now and when silence fell, ns
        return self

    def __exit__(self, *_):
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown()

    def wait_for_controller(self, check):
        """Wait until a controller listens and answers; `check()` is called meanwhile and may raise."""
        gathering, deaf = Gathering(self._present), DeafListeners(self._node, self._imus)
        while not gathering.complete():
            check()
            deaf.tell()
            self._patience.look(_TICK)

    def type_hash(self):
        """Return the hash of the answers' type, as bags note it; nothing if the controller has just gone."""
        infos = self._node.get_publishers_info_by_topic(self._answers.topic)
        return str(infos[0].topic_type_hash) if infos else ""

    def answer(self, stamp, chassis, powertrain):
        """Publish both Imu messages (bytes) of a sample; returns the `Answer`, or None if none comes in time.

        Who is silent is no longer waited for until he is heard again.
        """
        lockstep = self._lockstep
        lockstep.publish(stamp)
        for publisher, data in zip(self._imus, (chassis, powertrain), strict=True):
            publisher.publish(data)
        self._patience.look(0.0)
        if self._given_up is None or self._heard > self._given_up:
            self._given_up = None
            if not self._patience.wait_until(lambda: lockstep.answered, _ANSWER_TIMEOUT):
                self._given_up = self._heard
        return self._latest if lockstep.answered else None

    def change(self, values):
        """Change parameters of the stock controller's law, by name; raises ValueError if it does not take them."""
        client = AsyncParameterClient(self._node, "controller")
        self._patience.wait_until(taken_up(self._node))
        future = client.set_parameters_atomically([Parameter(name, value=value) for name, value in values.items()])
        if not self._patience.wait_until(future.done, _CHANGE_TIMEOUT):
            raise ValueError("the controller does not respond to a recorded change of its law's parameters")
        if not future.result().result.successful:
            raise ValueError(f"the controller rejects a recorded change: {future.result().result.reason}")

    def _spin(self, timeout):
        with put_off_interrupts():
            self._executor.spin_once(timeout_sec=timeout)

    def _present(self):
        listeners = sum(publisher.get_subscription_count() for publisher in self._imus)
        return self._answers.count(), listeners

    @property
    def counts(self):
        """How often each outcome of an answer happened."""
        return self._lockstep.counts

    def _on_answer(self, answer):
        data, stamp, current = answer
        outcome = self._lockstep.offer(stamp, current)
        if outcome == "accepted":
            self._latest = Answer(tuple(current), bytes(data))
        if outcome in ("accepted", "late"):
            self._heard = max(self._heard, stamp)
