"""Messages of every type that something of ours listens to, harmed, straight into the callbacks of its subscriptions.

All listeners are there in one process: simulator, road, controller and recorder, then whoever follows a run, then
whoever replays to a controller. Numbers become odd ones, lengths wild, bytes flip, are cut or added.
"""

import math
import struct
import tempfile
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

import rclpy
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from mr_mount_controller.mounting import PAIR
from mr_mount_controller.node import ControllerNode
from mr_mount_controller.node_base.loop_node import NodeError
from mr_mount_controller.node_base.node_process import start_ros
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

from .trial import Wrong, captured, flaw

REFUSALS = (NodeError,)
FLOATS = (0.0, -0.0, 5e-324, 1e-300, 1.0, 1e6, 1e300, -1e308, math.nan, math.inf, -math.inf)
DOUBLES = tuple(struct.pack("<d", number) for number in FLOATS)
INTEGERS = tuple(struct.pack("<I", n) for n in (0, 1, 2, 255, 10**9 - 1, 10**9, 2**16, 2**31 - 1, 2**31, 2**32 - 1))
LENGTHS = (0, 1, 2, 255, 2**16, 2**24, 2**31 - 1, 2**31, 2**32 - 1)
LARGE = 1 << 20  # bytes that are added now and then


def _whole(chance):
    """Return messages as they might come, by their types; of the other types empty ones do."""
    heights = [chance.uniform(-0.1, 0.1) for _ in range(chance.choice((0, 1, 2, 100)))]
    values = {"state": "running", "time": "0.5", "real_time_factor": "1.0"}
    status = DiagnosticStatus(name="simulator", values=[KeyValue(key=k, value=v) for k, v in values.items()])
    return {
        Imu: Imu(),
        CoilCurrent: CoilCurrent(current=[0.5, 1.5]),
        MountState: MountState(),
        Clock: Clock(),
        Time: Time(),
        Odometry: Odometry(child_frame_id="base_link"),
        String: String(data="vehicle: {}"),
        RoadProfile: RoadProfile(start=5.0 * chance.randrange(-4, 40), spacing=0.05, left=heights, right=heights),
        DiagnosticArray: DiagnosticArray(status=[status] * chance.choice((0, 1, 3))),
    }


def trials(chance, count):
    """Yield so many messages, nine in ten to the nodes of the loop."""
    for session, share in ((_loop, 0.9), (lambda _: Watch(), 0.05), (lambda _: ControllerTrial(PAIR), 0.05)):
        taken = []
        with _subscriptions(taken), session(taken):
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


@contextmanager
def _loop(taken):
    """Make the nodes of the loop, with a recorder that has subscribed to all, whose bag must be sound in the end."""
    with tempfile.TemporaryDirectory() as folder:
        start_ros(["loop", "--ros-args", "-p", f"recorder:bag:={folder}/bag"])
        executor = SingleThreadedExecutor()
        nodes = [RoadExcitationNode(), ControllerNode(), SimulatorNode(), RecorderNode()]
        complete = lambda: any(name.startswith("recorder ") for _, name, _ in taken)  # noqa: E731  it takes all at once
        for node in nodes:
            node.prepare(lambda timeout: executor.spin_once(timeout_sec=timeout), complete)
            executor.add_node(node)
        try:
            nodes[-1].run()
            yield
        finally:
            for node in reversed(nodes):
                node.close()
                node.destroy_node()
            executor.shutdown()
            rclpy.try_shutdown()
        for file in Path(folder).glob("bag*/*.mcap"):  # one an epoch
            assert not examine(file).flaw, examine(file).flaw


def _harmed(kind, chance):
    """Return the bytes of a message of a type with up to four harms done, and what was done."""
    data = bytearray(serialize_message(_whole(chance).get(kind) or kind()))
    done = [chance.choice(("numbers", "flip", "length", "cut", "insert", "order")) for _ in range(chance.randint(0, 4))]
    for harm in done:
        place = chance.randrange(len(data) + 1)
        four, eight = place - place % 4, place - place % 8 + 4
        if harm == "numbers":
            for _ in range(chance.choice((1, 1, 8))):
                _write(data, *chance.choice(((four, chance.choice(INTEGERS)), (eight, chance.choice(DOUBLES)))))
        elif harm == "flip" and place < len(data):
            data[place] ^= 1 << chance.randrange(8)
        elif harm == "length":
            _write(data, four, chance.choice(LENGTHS).to_bytes(4, chance.choice(("little", "big"))))
        elif harm == "cut":
            del data[place:]
        elif harm == "insert":
            data[place:place] = chance.randbytes(chance.choice((*(1, 4, 8, 100) * 5, LARGE)))
        elif harm == "order":
            data[:2] = chance.choice((b"\0\0", b"\0\1", b"\0\7", b"\xff\xff"))
    return bytes(data), done


def _write(data, place, new):
    if place + len(new) <= len(data):
        data[place : place + len(new)] = new


def _attempt(callback, data):
    listener = callback.__self__
    listener.refused = 0  # so that it says what it refuses every time
    with captured() as said:
        callback(data)
    if wrong := said.text and flaw(said.text.rstrip("\n")):
        raise Wrong(wrong)
    if listener.refused and "refused" not in said.text:
        raise Wrong("refused without words")
    return "refused" if listener.refused else "taken"
