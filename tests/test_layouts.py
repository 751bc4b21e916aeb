"""The layouts for RViz, Foxglove and PlotJuggler: they load, and name topics and fields that there are."""

import json
import re
from importlib import import_module
from xml.etree import ElementTree

import pytest
import yaml
from ament_index_python.packages import get_package_share_directory
from mr_mount_controller.node_base import topics
from mr_mount_controller.node_base.topic_table import TOPICS

from .documents import ROOT

pytestmark = pytest.mark.system
FOLDER = ROOT / "ros2_ws" / "src" / "trackvib_sim" / "layouts"
TYPES = {f"/{topic.name.removeprefix('/')}": topic.type for topic in TOPICS}


def require_field(path):
    """Make sure that a path such as `/mount_state.force[0].z` leads from a topic to a number."""
    found = {name: re.match(re.escape(name).replace(r"\*", "[^./]+"), path) for name in TYPES}
    topic = max((name for name, match in found.items() if match), key=lambda name: found[name].end())
    kind, words = TYPES[topic], re.split(r"[./]", path[found[topic].end() :].lstrip("./").replace(":", "0"))
    if topic == "/joint_states":  # by the joint's name
        assert words[0].endswith("_joint") and words[1:] == ["position"], path
        return
    for word in words:
        package, message = kind.split("/")[0], kind.split("/")[-1]
        fields = getattr(import_module(f"{package}.msg"), message).get_fields_and_field_types()
        name, _, index = word.partition("[")
        kind = fields[name]
        if index:
            kind = re.fullmatch(r"sequence<([^,>]+).*>|([^\[]+)\[\d+\]", kind)
            kind = kind[1] or kind[2]
    assert kind == "double", f"{path} is a {kind}"


def test_layouts_are_installed():
    """`ros2 pkg prefix` leads to them."""
    share = [path.name for path in sorted((ROOT / get_package_share_directory("trackvib_sim") / "layouts").iterdir())]
    assert share == ["trackvib.foxglove.json", "trackvib.plotjuggler.xml", "trackvib.rviz"]
    assert share == sorted(path.name for path in FOLDER.iterdir())


def test_rviz():
    """Displays are of the plugins that come with RViz; their topics have types that these show."""
    layout = yaml.safe_load((FOLDER / "trackvib.rviz").read_text(encoding="utf-8"))
    manager = layout["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == topics.ROAD_FRAME
    shown = {"RobotModel": "std_msgs/msg/String", "MarkerArray": "visualization_msgs/msg/MarkerArray",
             "Marker": "visualization_msgs/msg/Marker", "Odometry": "nav_msgs/msg/Odometry"}  # fmt: skip
    seen = set()
    for display in manager["Displays"]:
        plugin, _, name = display["Class"].partition("/")
        assert plugin == "rviz_default_plugins"
        topic = display.get("Topic") or display.get("Description Topic")
        if topic:
            assert TYPES[f"/{topic['Value']}"] == shown[name]
            latched = topic["Value"] in (topics.ROBOT_DESCRIPTION, topics.ROAD_STRIPS)
            assert topic["Durability Policy"] == ("Transient Local" if latched else "Volatile")
            seen.add(name)
    assert {"RobotModel", "MarkerArray", "Marker"} <= seen
    # panels, tools and views that RViz brings (its `default.rviz` and the description of its plugins)
    assert {panel["Class"] for panel in layout["Panels"]} <= {"rviz_common/Displays", "rviz_common/Time"}
    tools = {tool["Class"].removeprefix("rviz_default_plugins/") for tool in manager["Tools"]}
    assert tools <= {"Interact", "MoveCamera", "FocusCamera", "Measure", "Select"}
    assert manager["Views"]["Current"]["Class"] == "rviz_default_plugins/Orbit"


def test_foxglove():
    """Every panel of the layout is described, every description is in it, every path leads to a number."""
    layout = json.loads((FOLDER / "trackvib.foxglove.json").read_text(encoding="utf-8"))

    def panels(node):
        return [node] if isinstance(node, str) else [*panels(node["first"]), *panels(node["second"])]

    assert sorted(panels(layout["layout"])) == sorted(layout["configById"])
    # the kinds of panels as Foxglove names them in layouts that it exports
    assert {name.split("!")[0] for name in layout["configById"]} <= {"3D", "Plot", "DiagnosticSummary"}
    paths = [path["value"] for each in layout["configById"].values() for path in each.get("paths", ())]
    assert len(paths) == 4
    for path in paths:
        require_field(path)
    scene = layout["configById"]["3D!vehicle"]
    assert set(scene["topics"]) <= set(TYPES) and scene["followTf"] == topics.HULL_FRAME


def test_plotjuggler():
    """It is XML as PlotJuggler has it, and every curve leads to a number."""
    root = ElementTree.parse(FOLDER / "trackvib.plotjuggler.xml").getroot()
    assert root.find("tabbed_widget/Tab/Container/DockSplitter/DockArea/plot") is not None
    for splitter in root.iter("DockSplitter"):
        sizes = [float(size) for size in splitter.get("sizes").split(";")]
        assert len(sizes) == int(splitter.get("count")) == len(splitter) and sum(sizes) == pytest.approx(1.0)
    curves = [curve.get("name") for curve in root.iter("curve")]
    assert len(curves) >= 8
    for name in curves:
        require_field(name)
