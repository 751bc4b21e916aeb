"""Parameters and arguments of every node, as on its command line: through ROS 2's parser and the node's own checks.

The node is made, as `run_node` does, but not run.
"""

import tempfile
from math import isfinite
from pathlib import Path

import rclpy
from mr_mount_controller.laws import find_law, known_laws
from mr_mount_controller.node import PARAMETERS as CONTROLLER
from mr_mount_controller.node import ControllerNode
from mr_mount_controller.node_base.loop_node import NodeError
from mr_mount_controller.node_base.node_process import start_ros
from mr_mount_controller.node_base.parameters import ParameterError
from mr_mount_controller.node_base.plain_text import plain_line
from rclpy._rclpy_pybind11 import RCLError
from trackvib_sim.nodes.player import PARAMETERS as PLAYER
from trackvib_sim.nodes.player import PlayerNode
from trackvib_sim.nodes.recorder import PARAMETERS as RECORDER
from trackvib_sim.nodes.recorder import RecorderNode
from trackvib_sim.nodes.road_excitation import PARAMETERS as ROAD
from trackvib_sim.nodes.road_excitation import RoadExcitationNode
from trackvib_sim.nodes.simulator import SimulatorNode
from trackvib_sim.nodes.simulator_parameters import PARAMETERS as SIMULATOR

from .bags import made
from .odd_values import CONTROL, LAWS, NUMBERS, PLACES, TEXTS
from .trial import Wrong, captured

REFUSALS = (ParameterError, NodeError, RCLError)
NODES = (
    (SimulatorNode, SIMULATOR),
    (ControllerNode, CONTROLLER),
    (RoadExcitationNode, ROAD),
    (RecorderNode, RECORDER),
    (PlayerNode, PLAYER),
)
OTHERS = ("[]", "[1, a]", "['']", "['a b']", "[1.0]", "{a: b}", "*a", "&a x", "!!int x", "!!binary x", "(", "[a-",
          "^a*b?$", "(a+)+$", "2001-01-01", "on", "[" * 60, "'", '"', "|", "a: b: c", "# x", "[chassis/imu, /x, x/]",
          "['~/x', '{x}']")  # fmt: skip
NAMES = ("nonsense", "use_sim_time", "start_type_description_service", "qos_overrides./x", "", " ", "a b", "a.b", "a:",
         "/a", "**", CONTROL, "speed.speed", "x" * 300)  # fmt: skip
ARGUMENTS = (["x"], ["--nonsense"], ["--ros-args", "--nonsense"], ["--ros-args", "-p"], ["--ros-args", "-p", "x"],
             ["--ros-args", "-r"], ["--ros-args", "-r", "a:=b c"], ["--ros-args", "-r", "__node:=a b"],
             ["--ros-args", "-r", "__ns:=x"], ["--ros-args", "-r", "__ns:=/a b"], ["--ros-args", "-r", "chassis/imu:="],
             ["--ros-args", "--log-level", "loud"], ["--ros-args", "--params-file", "nowhere"],
             ["--ros-args", "--params-file", "/dev/null"], ["--ros-args", "--enclave", "x"], ["--ros-args", CONTROL],
             ["--ros-args", "-e", "/a b"], ["--ros-args", "--", CONTROL])  # fmt: skip


def trials(chance, count):
    """Yield so many command lines of nodes."""
    laws = known_laws()
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        bag.mkdir()
        (bag / made.NAME).write_bytes(made.sound_file())
        for _ in range(count):
            make, known = chance.choice(NODES)
            words = [] if make is not PlayerNode else _given("bag", bag)
            if make is ControllerNode and chance.random() < 0.7:
                words, known = _given("law", law := chance.choice(laws)), (*known, *find_law(law).parameters)
            for _ in range(chance.randint(1, 3)):
                words += _wild(known, chance)
            if chance.random() < 0.1:
                words += chance.choice(ARGUMENTS)
            done = f"{make.__name__} {' '.join(ascii(word)[:60] for word in words)}"
            yield done, lambda make=make, words=words: _attempt(make, words)


def _wild(known, chance):
    """Return a parameter with a value that is odd, or at the edge of what is accepted."""
    parameter = chance.choice(known)
    name = parameter.name if chance.random() < 0.95 else chance.choice(NAMES)
    edges = [parameter.default, *parameter.choices]
    if name == "law":
        edges += [*LAWS, *known_laws()] * 3
    if name in ("vehicle_file", "bag"):
        edges += PLACES * 3
    if parameter.low is not None:
        low, high, kind = parameter.low, parameter.high, type(parameter.default)
        edges += [kind(each) for each in (low, high, low - 1, high + 1, 2 * high)]
        edges += [kind(chance.uniform(low, high)), kind(low + (high - low) * chance.random() ** 8)] * 5
    value = chance.choice(edges if chance.random() < 0.6 else (*TEXTS, *NUMBERS, *OTHERS))
    return _given(name, str(value).lower() if isinstance(value, bool) else value)


def _given(name, value):
    return ["--ros-args", "-p", f"{name}:={value}", "--"]


def _attempt(make, words):
    node = None
    with captured() as said:
        try:
            start_ros(["node", *words])
            node = make()
            node.refuse_unknown_parameters([])
            made_of = [value for value in node.settings.values() if isinstance(value, float)]
        except REFUSALS as error:
            raise type(error)(plain_line(str(error))) from None  # as `run_node` prints it
        finally:
            if isinstance(node, PlayerNode):
                node.close()
            if node is not None:
                node.destroy_node()
            rclpy.try_shutdown()
    if said.control:
        raise Wrong(f"control character: {said.text[:200]!r}")
    if not all(map(isfinite, made_of)):
        raise Wrong(f"a node with {made_of}")
    return f"a {make.__name__}"
