"""What nodes are given by several files and one by one: the last counts, in one file that ROS 2 reads the same way."""

import pytest
import rclpy
import yaml
from mr_mount_controller.node_base.parameter_files import given_by_wildcard
from mr_mount_controller.node_base.parameters import ParameterError
from trackvib_sim.nodes.loop_arguments import CONTROLLER, NODES, SIMULATOR, loop_parameters
from trackvib_sim.nodes.namespace import full_namespace
from trackvib_sim.nodes.node_parameters import NodeParameters

FIRST = """
/lab/simulator: {ros__parameters: {speed: 1.0, gears: true}}
/**: {ros__parameters: {speed: 2.0, seed: 3, name: "1", of_nobody: [1, 2]}}
/other/simulator: {ros__parameters: {speed: 9.0}}
"""
SECOND = """
/*/simulator: {ros__parameters: {duration: 1e1}}
lab: {"**": {ros__parameters: {inner: {left: 4}}}}
"""


@pytest.fixture
def parameters(tmp_path):
    """Of two nodes in a namespace, from two files and by one value."""
    given = NodeParameters(["simulator", "road"], "/lab")
    for name, text in (("first", FIRST), ("second", SECOND)):
        (tmp_path / name).write_text(text)
        given.read(tmp_path / name)
    given.give("road", seed=5)
    return given


@pytest.mark.property
def test_the_last_counts(parameters):
    """Of sections in one file, of files, and of values one by one; sections for others are skipped."""
    names = ("speed", "seed", "duration", "gears")
    assert [parameters.get("simulator", name) for name in names] == [2.0, 3, 10.0, True]
    assert [parameters.get("road", name) for name in ("speed", "seed", "inner.left")] == [2.0, 5, 4]
    assert parameters.get("road", "duration", 7.0) == 7.0


@pytest.mark.property
def test_sections_for_no_node_are_named(parameters, tmp_path):
    """Once, with the nodes that there are; a file with no others is refused."""
    words = "has sections for /other/simulator, but the nodes here are /lab/simulator, /lab/road"
    assert [note.split("' ", 1)[1] for note in parameters.notes] == [words]
    (tmp_path / "nested").write_text("right: {simulator: {ros__parameters: {speed: 3.0}}}")
    with pytest.raises(
        ParameterError, match="nested' has sections for /right/simulator, but the nodes here are /lab/s"
    ):
        parameters.read(tmp_path / "nested")
    assert parameters.get("simulator", "speed") == 2.0


@pytest.mark.cross_engine
def test_ros_reads_the_same(parameters, tmp_path):
    """Real nodes, told the file that is written, have these values and types; what came by wildcards is still known."""
    file = tmp_path / "all.yaml"
    parameters.write(file)
    arguments = ["node", "--ros-args", "--params-file", str(file), "-r", "__ns:=/lab"]
    context = rclpy.Context()
    rclpy.init(args=arguments, context=context)
    try:
        for name, further in (("simulator", ("duration", "gears")), ("road", ())):
            node = rclpy.create_node(name, context=context, automatically_declare_parameters_from_overrides=True)
            for key in ("speed", "seed", "name", "of_nobody", "inner.left", *further):
                told, expected = node.get_parameter(key).value, parameters.get(name, key)
                told = list(told) if isinstance(expected, list) else told
                assert told == expected and type(told) is type(expected), key
            node.destroy_node()
    finally:
        rclpy.try_shutdown(context=context)
    assert given_by_wildcard(arguments) == {"speed", "seed", "name", "of_nobody", "duration", "inner.left"}
    assert yaml.safe_load(file.read_text())["/lab/road"]["ros__parameters"] == {"seed": 5}


@pytest.mark.property
@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no section"),
        ("[1]", "has no section"),
        ("simulator: {speed: 1.0}", "has no section"),
        ("a: {ros__parameters: {b: [[1]]}}", r"b of /a is \[\[1\]\], accepted:"),
        ("a: {ros__parameters: {b: }}", "b of /a is None, accepted:"),
        ("a: {ros__parameters: 5}", "has no section"),
        ("a: [", "not a YAML file"),
    ],
)
def test_a_file_that_is_none(tmp_path, text, said):
    """One error that names it."""
    (tmp_path / "file").write_text(text)
    with pytest.raises(ParameterError, match=said):
        NodeParameters(["a"]).read(tmp_path / "file")


@pytest.mark.property
@pytest.mark.parametrize("name", ["/", "", "lab", "/lab/left_2", "_a/b"])
def test_namespaces(name):
    """Those that ROS 2 takes, with or without the slash in front."""
    assert full_namespace(name) == f"/{name.strip('/')}"


@pytest.mark.property
@pytest.mark.parametrize("name", ["2a", "a/", "a//b", "a b", "ä", "//", "a/2", "~", "a" * 101, "a\x1b"])
def test_names_that_are_no_namespaces(name):
    """Refused with what is accepted."""
    with pytest.raises(ParameterError, match="accepted:"):
        full_namespace(name)


def test_priority_and_core_are_of_both_that_take_turns():
    """Simulator and controller get them from one option; the others keep what they have."""
    parameters, _ = loop_parameters({"realtime_priority": 20, "core": 1})
    for node in NODES:
        told = [parameters.get(node, name) for name in ("realtime_priority", "core")]
        assert told == ([20, 1] if node in (SIMULATOR, CONTROLLER) else [None, None])
