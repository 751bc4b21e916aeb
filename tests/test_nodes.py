"""Each node alone: start, waiting, bad parameters, clean end."""

import itertools
import signal

import pytest

from .conftest import PACKAGES

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="starts nodes in every order")

WAITING = {
    "simulator": "waiting for a road",
    "road_excitation": "waiting for a vehicle",
    "controller": "waiting for accelerations",
    "recorder": "waiting for",
}


@SLOW
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("name", WAITING)
def test_waits_and_ends_cleanly(start_node, tmp_path, name, number):
    """Alone, a node says once what it waits for, and ends with code 0 on the first signal, even if two come."""
    node = start_node(name, **({"bag": tmp_path / "bag"} if name == "recorder" else {}))
    node.wait_for(WAITING[name])
    node.signal(number)
    node.signal(number)
    assert node.wait() == 0, node.output
    assert node.output.count("waiting for") == 1
    assert "Traceback" not in node.output


@SLOW
@pytest.mark.parametrize(
    ("name", "parameters", "words"),
    [
        ("simulator", {"speed": 80.0}, ["'speed'", "80.0", "-25 to 25 m/s"]),
        ("simulator", {"speed": "fast"}, ["'speed'", "'fast'", "a number"]),
        ("simulator", {"sped": 5.0}, ["'sped'", "known are", "speed"]),
        ("simulator", {"pace": "slow"}, ["'pace'", "'slow'", "lockstep, realtime"]),
        ("simulator", {"control_rate": 3000}, ["physics_rate 5000", "control_rate 3000", "conflict"]),
        ("simulator", {"view_rate": 300}, ["control_rate 1000", "view_rate 300", "conflict"]),
        ("simulator", {"engine_speed": 200.0}, ["'engine_speed'", "200.0", "450 to 2100"]),
        ("simulator", {"vehicle_file": "/nowhere.yaml"}, ["'vehicle_file'", "/nowhere.yaml"]),
        ("road_excitation", {"road": "Q"}, ["'road'", "'Q'", "A, B, C, D, E, F, G, H"]),
        ("road_excitation", {"seed": -1}, ["'seed'", "-1", "0 to"]),
        ("controller", {"law": "magic"}, ["'law'", "'magic'", "passive", "skyhook"]),
        ("controller", {"law": "json:JSONDecoder"}, ["'law'", "json:JSONDecoder", "ControlLaw"]),
        ("controller", {"law": "skyhook", "firm_current": 9.0}, ["'firm_current'", "9.0", "0.7 to 4 A"]),
        ("controller", {"law": "hybrid", "soft_current": 2.0, "firm_current": 1.0}, ["'soft_current'", "2.0", "1 A"]),
        ("recorder", {"bag": "/proc/none/bag"}, ["/proc/none/bag", "cannot be created"]),
        ("recorder", {"topics": "['bad topic']"}, ["'topics'", "bad topic"]),
        ("recorder", {"pattern": "'['"}, ["'pattern'", "'['", "regular expressions"]),
        ("recorder", {"compression": "gzip"}, ["'compression'", "'gzip'", "zstd, none"]),
        ("recorder", {"topicz": 3}, ["'topicz'", "known are", "topics"]),
        ("controller", {"sample_rate": 3}, ["'sample_rate'", "3.0", "10 to 10000 Hz"]),
        ("simulator", {"use_sim_time": 3}, ["simulator: parameter 'use_sim_time' is 3", "true or false"]),
        ("player", {"use_sim_time": 3}, ["player: parameter 'use_sim_time' is 3", "true or false"]),
        ("player", {"start_type_description_service": " "}, ["'start_type_description_service'", "true or false"]),
        ("player", {"bag": "x" * 300}, ["xx' cannot be read: File name too long"]),
        ("simulator", {"speed": "9" * 5000}, ["'speed'", "99 ... 99", "-25 to 25 m/s"]),
    ],
)
def test_bad_parameter_is_refused_by_name(start_node, tmp_path, name, parameters, words):
    """One error names the parameter, its value and what is accepted; the exit code is not 0."""
    node = start_node(name, **parameters)
    assert node.wait() != 0
    for word in words:
        assert word in node.output
    assert node.output.count("error:") == 1 and "Traceback" not in node.output
    assert list(tmp_path.glob("bag*")) == []


@SLOW
@pytest.mark.parametrize(
    ("name", "arguments", "words"),
    [
        ("road_excitation", ("--nonsense",), "arguments ['--nonsense'] are not known"),
        ("simulator", ("-p", "speed:=1"), "arguments ['-p', 'speed:=1'] are not known"),
        ("player", ("bag:=here",), "arguments ['bag:=here'] are not known"),
        ("controller", ("--ros-args", "--bogus"), "['--bogus'] are not known"),
        ("recorder", ("--ros-args", "-p", "bag"), "parameter override rule: '-p bag'"),
        ("one_process", ("--ros-args", "-r", "__ns:=bad"), "remap rule: '-r __ns:=bad'"),
        ("player", ("--ros-args", "--params-file", "/nowhere"), "params file: '--params-file /nowhere'"),
        ("simulator", ("--ros-args", "-p", "vehicle_file:=\udcff"), "is not UTF-8 text"),
    ],
)
def test_bad_argument_is_refused_in_one_line(start_node, name, arguments, words):
    """What is no argument of ROS 2 ends a node with one line: what it is, and what is accepted."""
    node = start_node(name, *arguments)
    assert node.wait() == 2
    (line,) = node.output.splitlines()
    assert line.startswith("error: ") and words in line and "accepted: --ros-args" in line


@SLOW
def test_help_tells_all_and_starts_nothing(fork, observer):
    """Parameters with defaults and ranges, topics and services; no node appears, and the end is in order."""
    asked = {name: fork(name, ["--help"]) for name in PACKAGES}
    words = {
        "simulator": (
            "speed:=10.0\n",
            "from -25 to 25 m/s",
            "mount_state  (trackvib_msgs/msg/MountState, 1 kHz)",
            "/pause",
        ),
        "road_excitation": ("seed:=1\n", "road_excitation subscribes to:\n  drive_state"),
        "recorder": ("chunk_size:=1024\n", "from 16 to 65536 KiB"),
        "player": ("rate:=1.0\n", "player/reset  (std_srvs/srv/Trigger)"),
        "controller": ("sample_rate:=1000.0\n", "with law:=skyhook, may change while it runs:\n  soft_current:=0.8"),
        "one_process": ("simulator:speed:=10.0\n", "controller:law:=passive\n"),
    }
    for name, node in asked.items():
        assert node.wait() == 0, node.output
        assert node.output.startswith(f"usage: {name} ") and "waiting" not in node.output
        for each in words[name]:
            assert each in node.output or each in " ".join(node.output.split()), (name, each)
    assert observer.node.get_node_names() == ["observer"]


@SLOW
@pytest.mark.parametrize("order", list(itertools.permutations(("simulator", "road_excitation", "controller"))))
def test_any_start_order(start_node, order):
    """Whatever starts first, the loop runs; each node is waited for before the next starts."""
    nodes = {}
    for name in order:
        parameters = {"duration": 0.3} if name == "simulator" else {}
        nodes[name] = start_node(name, **parameters)
        nodes[name].wait_for("waiting for")
    assert nodes["simulator"].wait() == 0, nodes["simulator"].output
    assert "0.3 s simulated" in nodes["simulator"].output


@SLOW
def test_two_simulators_do_not_mix(start_node, observer):
    """A second simulator in the same domain says so and ends; the first goes on."""
    start_node("road_excitation")
    start_node("controller")
    first = start_node("simulator")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 1.0)  # the one that is behind gives way
    second = start_node("simulator")
    assert second.wait() != 0
    assert "another simulator" in second.output and "ROS_DOMAIN_ID" in second.output
    assert first.running


@SLOW
def test_names_can_be_remapped_into_a_namespace(start_node, tmp_path):
    """All nodes in one namespace find each other."""
    inside = ("--ros-args", "-r", "__ns:=/left_lab", "--")
    start_node("road_excitation", *inside)
    start_node("controller", *inside)
    simulator = start_node("simulator", *inside, duration=0.3)
    assert simulator.wait() == 0, simulator.output


def test_what_a_node_is_told_is_shown_as_signs(start_node, tmp_path):
    """What it waits for and where it records never move the cursor."""
    recorder = start_node("recorder", pattern=r'"\x1bred"', bag=rf'"{tmp_path}/ba\x1bg"')
    recorder.wait_for(r"topics matching '\x1bred'")
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    assert r"ba\x1bg" in recorder.output and "\x1b" not in recorder.output


def test_existing_bag_is_not_overwritten(start_node, tmp_path):
    """A recorder pointed at an existing folder refuses and leaves it as it was."""
    (tmp_path / "bag").mkdir()
    (tmp_path / "bag" / "kept").write_text("precious")
    recorder = start_node("recorder", bag=tmp_path / "bag")
    assert recorder.wait() != 0
    assert "already exists" in recorder.output
    assert [path.name for path in (tmp_path / "bag").iterdir()] == ["kept"]
