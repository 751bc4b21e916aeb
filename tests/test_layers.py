"""Imports point downwards: the tables of docs/architecture.md name the rooms in their order, the code keeps to it."""

import ast
import re
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "ros2_ws" / "src"
ARCHITECTURE = Path(__file__).parents[1] / "docs" / "architecture.md"
PACKAGES = ("mr_mount_controller", "trackvib_sim")  # the second may import the first
ROS = {"rclpy", "rcl_interfaces", "builtin_interfaces", "launch", "launch_ros"}
ROS_SUFFIX = "_msgs"
IMPORTING_ROS = re.compile(
    r"trackvib_sim\.nodes\..*|mr_mount_controller\.(node|node_base\.(descriptors|listener|loop_node|node_process|packed_message|qos))"
)

pytestmark = pytest.mark.property


def files():
    """Give all modules of both packages with their paths."""
    for package in PACKAGES:
        root = SOURCE / package
        for path in sorted((root / package).rglob("*.py")):
            yield ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"), path


each_file = pytest.mark.parametrize(("module", "path"), [pytest.param(*file, id=file[0]) for file in files()])


def rooms():
    """Return the rooms of each package in the order in which the document has them, the lowest first."""
    tables = re.findall(r"\| room \| holds \|\n\|[-| ]+\|\n((?:\|.*\n)+)", ARCHITECTURE.read_text(encoding="utf-8"))
    return dict(zip(PACKAGES, (re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE) for table in tables), strict=True))


def imports(module, path):
    """Return the full names that a module imports, wherever in it."""
    package = module.split(".") if path.name == "__init__.py" else module.split(".")[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: len(package) - node.level + 1] if node.level else []
            base = ".".join([*start, *([node.module] if node.module else [])])
            yield from (f"{base}.{alias.name}" for alias in node.names)


def test_the_document_names_every_room():
    """Folders and files at the top of each package are the rooms of its table."""
    for package, named in rooms().items():
        found = (path for path in (SOURCE / package / package).iterdir() if path.is_dir() or path.suffix == ".py")
        there = {path.stem for path in found if path.name[0] != "_"}
        assert there == set(named) and len(named) == len(set(named))


@each_file
def test_imports_point_downwards(module, path):
    """A module imports from its own room and from those below; never the simulator from the controller's package."""
    order = rooms()
    package, _, rest = module.partition(".")
    own = rest.partition(".")[0]
    if not own:
        return  # the package's page of names
    for name in imports(module, path):
        other, _, rest = name.partition(".")
        room = rest.partition(".")[0]
        if other == package and room in order[package]:
            assert order[package].index(room) <= order[package].index(own), f"imports {name}, which lies above it"
        assert not (package == PACKAGES[0] and other == PACKAGES[1]), f"imports {name}"


@each_file
def test_only_nodes_import_ros(module, path):
    """ROS and its messages are imported by nodes, and by what only nodes need."""
    found = {name.partition(".")[0] for name in imports(module, path)}
    needs_ros = sorted(name for name in found if name in ROS or name.endswith(ROS_SUFFIX))
    assert not needs_ros or IMPORTING_ROS.fullmatch(module), f"imports {needs_ros}"
