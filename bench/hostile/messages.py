"""Messages of every type that something of ours listens to, harmed, straight into the callbacks of its subscriptions.

All listeners are there in one process: simulator, road, controller and recorder, then whoever follows a run, then whoever
replays to a controller. Numbers become odd ones, lengths wild, bytes flip, are cut or added.
"""

import struct
import tempfile
from contextlib import ExitStack, closing
from pathlib import Path
from unittest.mock import patch

import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from mr_mount_controller.node import ControllerNode
from mr_mount_controller.node_base.loop_node import NodeError, start_ros
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu
from std_msgs.msg import String
from trackvib_msgs.msg import CoilCurrent, MountState, RoadProfile
from trackvib_sim.bags.mcap_summary import examine
from trackvib_sim.nodes.controller_trial import ControllerTrial
from trackvib_sim.nodes.recorder import RecorderNode
from trackvib_sim.nodes.road_excitation import RoadExcitationNode
from trackvib_sim.nodes.simulator import SimulatorNode
from trackvib_sim.nodes.watch import Watch

from .trial import Wrong, captured

REFUSALS = (NodeError,)
DOUBLES = tuple(struct.pack("<d", x) for x in (0.0, -0.0, 5e-324, 1e-300, 1.0, 1e6, 1e300, -1e308, *map(float, ("nan", "inf", "-inf"))))
INTEGERS = tuple(struct.pack("<I", n) for n in (0, 1, 2, 255, 10**9 - 1, 10**9, 2**16, 2**31 - 1, 2**31, 2**32 - 1))
LENGTHS = (0, 1, 2, 255, 2**16, 2**24, 2**31 - 1, 2**31, 2**32 - 1)
LARGEST = 1 << 20  # bytes added at most


def _whole(chance):
    """Return a message of each type, as it might come."""
    heights = [chance.uniform(-0.1, 0.1) for _ in range(chance.choice((0, 1, 2, 100)))]
    values = {"state": "running", "time": "0.5", "real_time_factor": "1.0"}
    status = DiagnosticStatus(name="simulator", values=[KeyValue(key=k, value=v) for k, v in values.items()])
    return {
        Imu: Imu(), CoilCurrent: CoilCurrent(current=[0.5, 1.5]), MountState: MountState(), Clock: Clock(), Time: Time(),
        Odometry: Odometry(child_frame_id="base_link"), String: String(data="vehicle: {}"),
        RoadProfile: RoadProfile(start=5.0 * chance.randrange(-4, 40), spacing=0.05, left=heights, right=heights),
        DiagnosticArray: DiagnosticArray(status=[status] * chance.choice((0, 1, 3))),
    }  # fmt: skip


def trials(chance, count):
    """Yield so many messages, nine in ten to the nodes of the loop."""
    for session, share in ((_loop, 0.9), (Watch, 0.05), (ControllerTrial, 0.05)):
        taken = []
        with _subscriptions(taken), session():
            for _ in range(round(share * count)):
                kind, topic, callback = chance.choice(taken)
                data, done = _harmed(kind, chance)
                yield f"{topic}, {', '.join(done)}", lambda callback=callback, data=data: _attempt(callback, data)


def _subscriptions(taken):
    """Note type, topic and callback of every subscription, which is made all the same."""
    create = Node.create_subscription

    def noting(node, message_type, topic, callback, *arguments, **options):
        if options.get("raw"):
            taken.append((message_type, f"{node.get_name()} {topic}", callback))
        return create(node, message_type, topic, callback, *arguments, **options)

    return patch.object(Node, "create_subscription", noting)


class _loop:  # noqa: N801, a context manager like its siblings
    """The nodes of the loop, the recorder with its subscriptions and a bag, which must be sound in the end."""

    def __enter__(self):
        start_ros()
        self._folder = tempfile.TemporaryDirectory()
        self._executor = SingleThreadedExecutor()
        made = [RoadExcitationNode(), ControllerNode(), SimulatorNode(), RecorderNode()]
        self._nodes, recorder = made, made[-1]


