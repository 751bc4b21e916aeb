"""The stand-in for the `ros2` command, beside a running loop: what it prints, and how it ends."""

import os
import re
import signal
import sys
import time
from pathlib import Path

import pytest
import yaml
from mr_mount_controller.node_base.qos import LATCHED_QOS
from mr_mount_controller.node_base.topic_table import TOPICS
from rcl_interfaces.srv import ListParameters, SetParameters
from rclpy.node import NodeNameNonExistentError
from sensor_msgs.msg import Imu
from std_msgs.msg import String

from .processes import PATIENCE

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[1]
STAND_IN = [sys.executable, ROOT / "environment" / "bin" / "ros2"]
SLOW = pytest.mark.slow(reason="a loop of real processes, and a process for every call")
HOSTILE = "a\x1b]0;title\x07\x9b31m\u202eb\nc"

sys.path.append(str(ROOT))  # the stand-in is no installed package

from environment.ros2_stand_in import message_text  # noqa: E402
from environment.ros2_stand_in.arguments import parser  # noqa: E402
from environment.ros2_stand_in.terminal import Failure  # noqa: E402


@pytest.fixture
def ros2(start):
    """Call the stand-in until it prints something: `ros2(words, *expected)`; returns its output.

    Nodes are found a moment after their start, and on a busy machine later than a call looks for them.
    """

    def call(words, *expected, code=0):
        end = time.monotonic() + PATIENCE
        while True:
            process = start([*STAND_IN, *words])
            ended, output = process.wait(), process.output
            if ended == code and all(each in output for each in expected):
                return output
            assert time.monotonic() < end, f"{words} ended with {ended} and printed:\n{output}"

    return call


@pytest.fixture
def loop(start_node, observer):
    """Road, controller and a simulator that stands after its first periods."""
    start_node("road_excitation")
    start_node("controller", law="skyhook")
    start_node("simulator")
    observer.wait_for(state="running")
    observer.call("pause")
    observer.wait_for(state="paused")


@SLOW
def test_reading_verbs(loop, ros2):
    """Names, types, values, counts and a message, as ros2cli prints them."""
    every = ros2(["topic", "list", "-t"], "/coil_current [trackvib_msgs/msg/CoilCurrent]\n")
    assert "/chassis/imu [sensor_msgs/msg/Imu]\n" in every and every.splitlines() == sorted(every.splitlines())
    nodes = ros2(["node", "list"], "/controller\n", "/observer\n", "/road_excitation\n", "/simulator\n")
    assert len(nodes.splitlines()) == 4
    info = ros2(["topic", "info", "-v", "/coil_current"], "Type: trackvib_msgs/msg/CoilCurrent\n\nPublisher count: 1\n")
    assert "Node name: controller\n" in info and "  Reliability: RELIABLE\n" in info
    assert ros2(["param", "get", "/simulator", "speed"]) == "Double value is: 10.0\n"
    described = ros2(["param", "describe", "/simulator", "speed"])
    assert "  Type: double\n" in described and "    Min value: -25.0\n    Max value: 25.0\n" in described
    dumped = yaml.safe_load(ros2(["param", "dump", "/road_excitation"]))
    assert dumped["/road_excitation"]["ros__parameters"]["road"] == "E"
    printed = ros2(["topic", "echo", "--once", "/odometry"], "child_frame_id: base_link\n")
    where = yaml.safe_load(printed.removesuffix("---\n"))
    assert list(where["pose"]["pose"]["position"]) == ["x", "y", "z"]
    part = ros2(["topic", "echo", "--once", "/odometry", "--field", "pose.covariance[0]"])
    assert part == "0.0\n---\n"
    trigger = ros2(["service", "call", "/simulator/step", "std_srvs/srv/Trigger"], "response:\n")
    assert "std_srvs.srv.Trigger_Response(success=True, message='one period, from t = " in trigger


@SLOW
def test_changes_and_fixed_parameters(loop, ros2):
    """A law's parameter is set, any other says that it is fixed."""
    assert ros2(["param", "set", "/controller", "firm_current", "2"]) == "Set parameter successful\n"
    assert ros2(["param", "get", "/controller", "firm_current"]) == "Double value is: 2.0\n"
    for node, name, value, reason in (
        ("/controller", "firm_current", "9", "'firm_current' is 9.0, accepted: a number from 0.7 to 4 A"),
        ("/controller", "soft_current", "2.5", "accepted: at most firm_current, 2 A"),
        ("/controller", "law", "hybrid", "'law' is fixed while the node runs"),
        ("/simulator", "speed", "5", "'speed' is fixed while the node runs"),
    ):
        said = ros2(["param", "set", node, name, value], reason, code=1)
        assert said.startswith("Setting parameter failed: ") and len(said.splitlines()) == 1


def subscriptions(observer, node):
    """Topics that a node hears, as far as the observer's side of the graph knows it already."""
    try:
        found = observer.get_subscriber_names_and_types_by_node(node, "/")
    except NodeNameNonExistentError:
        return set()
    return {name.removeprefix("/") for name, _ in found}


@SLOW
def test_listeners_are_those_of_the_table(loop, observer):
    """Topics that the nodes' help names as heard are those to which they subscribe."""
    for node in ("simulator", "road_excitation", "controller"):
        told = {each.name.removeprefix("/") for each in TOPICS if node in each.readers}
        told -= {topic for topic in told if topic.startswith("recorder/")}  # with wait_for_recorder only
        observer.wait_until(lambda told=told, node=node: subscriptions(observer.node, node) == told)


@SLOW
def test_text_from_outside_is_shown_as_text(observer, ros2):
    """What would move the cursor, turn the text or forge a line comes as its escape sequence."""
    publisher = observer.node.create_publisher(String, "told", LATCHED_QOS)
    publisher.publish(String(data=HOSTILE))
    for option in ([], ["--field", "data"], ["--csv"]):
        output = ros2(["topic", "echo", "--once", "/told", *option], "title")
        assert all(line.isprintable() for line in output.splitlines())
        assert "\nc" not in output


@SLOW
def test_rate_until_interrupted(start, observer):
    """`hz` reports over its window, and Ctrl-C ends it in order."""
    publisher = observer.node.create_publisher(Imu, "beat", 10)
    process = start([*STAND_IN, "topic", "hz", "-w", "5", "/beat"])

    def reported():
        publisher.publish(Imu())
        return "window: 5" in process.output

    observer.wait_until(reported)
    assert re.search(r"^average rate: \d+\.\d{3}\n\tmin: \d+\.\d{3}s max: ", process.output, re.MULTILINE)
    process.signal(signal.SIGINT)
    assert process.wait() == 0 and "Traceback" not in process.output


@SLOW
def test_launch_runs_the_loop(ros2, tmp_path):
    """The package's launch file runs to the end of the simulation, with a parameter file, and leaves a bag."""
    (tmp_path / "my.yaml").write_text(
        "/**:\n  ros__parameters: {duration: 0.5, wait_for_recorder: true}\n"
        "/recorder:\n  ros__parameters: {bag: my_bag}\n"
    )
    output = ros2(["launch", "trackvib_sim", "closed_loop.launch.py", f"params_file:={tmp_path / 'my.yaml'}"])
    assert output.count("process has finished cleanly") == 4
    assert "[simulator-4] [INFO]" in output and (tmp_path / "my_bag" / "metadata.yaml").is_file()


@SLOW
def test_launch_ends_its_nodes(start):
    """Ctrl-C reaches every node once, and all end in order."""
    process = start([*STAND_IN, "launch", "trackvib_sim", "closed_loop.launch.py"])
    process.wait_for("[simulator-4] [INFO]")
    process.signal(signal.SIGINT)
    assert process.wait() == 0
    assert process.output.count("process has finished cleanly") == 4, process.output


@pytest.mark.slow(reason="waits for several commands")
def test_launch_says_what_it_lacks(ros2, tmp_path):
    """A launch file that needs more of ROS 2's launch is refused before anything starts; so is a wrong argument."""
    file = tmp_path / "my.launch.py"
    file.write_text("from launch.actions import TimerAction\n")
    assert "cannot import name 'TimerAction'" in ros2(["launch", str(file)], "a part of ROS 2's launch", code=1)
    ros2(["launch", "trackvib_sim", "closed_loop.launch.py", "speed=3"], "expected format '<name>:=<value>'", code=1)
    ros2(["launch", "trackvib_sim", "nothing.launch.py"], "it has: closed_loop.launch.py", code=1)
    shown = ros2(["launch", "trackvib_sim", "closed_loop.launch.py", "-s"])
    assert "'params_file':" in shown and "process started" not in shown


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["topic", "echo", "/x", "--bogus"], "unrecognized arguments: --bogus"),
        (["topic", "hz", "/x", "--window", "0"], "'0', accepted: a whole number from 1 on"),
        (["topic", "fly"], "invalid choice: 'fly'"),
        (["service", "call", "/x", "std_srvs/srv/SetBool", "{nope: 1}"], "SetBool_Request has no 'nope'"),
        (["service", "call", "/x", "std_srvs/srv/SetBool", "{data: 3}"], "data is 3"),
        (["service", "call", "/x", "os/srv/path"], "is not installed here"),
    ],
)
def test_bad_words_are_refused(start, words, said):
    """One line that says what is wrong, and an exit code that is not 0."""
    process = start([*STAND_IN, *words])
    assert process.wait() in (1, 2)
    assert said in process.output.splitlines()[-1] and "Traceback" not in process.output


def test_every_verb_is_there_and_light():
    """Each verb's module has its function; reading the arguments loads no ROS."""
    chosen = parser().parse_args(["topic", "echo", "--once", "/x", "--field", "a.b"])
    assert (chosen.module, chosen.function, chosen.field) == ("echo", "echo", "a.b")
    code = "import sys, environment.ros2_stand_in.main; sys.exit('rclpy' in sys.modules)"
    assert os.spawnve(os.P_WAIT, sys.executable, ["python", "-c", code], {**os.environ, "PYTHONPATH":
                      os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}) == 0  # fmt: skip


def test_messages_as_text():
    """Long arrays and texts are cut, parts are found by their path, requests are filled with the right types."""
    imu = Imu()
    imu.orientation_covariance[0] = 2.5
    cut = message_text.plain(imu, longest=2)
    assert cut["orientation_covariance"] == [2.5, 0.0, "..."]
    assert message_text.plain(imu, no_arr=True)["orientation_covariance"] == "<array type: double[9]>"
    assert message_text.part_of(imu, "orientation_covariance[0]") == 2.5
    with pytest.raises(Failure, match="'nothing' is not a field of Imu"):
        message_text.part_of(imu, "header.nothing".removeprefix("header."))
    with pytest.raises(Failure, match=r"there is no \[9\]"):
        message_text.part_of(imu, "orientation_covariance[9]")
    request = SetParameters.Request()
    message_text.fill(request, {"parameters": [{"name": "speed", "value": {"type": 3, "double_value": 5}}]})
    assert request.parameters[0].value.double_value == 5.0
    message_text.fill(listing := ListParameters.Request(), {"prefixes": ["a"], "depth": 1})
    assert listing.prefixes == ["a"]
    assert message_text.to_csv(message_text.plain(imu.header)) == "0,0,"
