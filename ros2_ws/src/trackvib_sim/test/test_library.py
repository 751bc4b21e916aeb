"""The library's page of names: each is documented, has an example that runs, and needs no ROS."""

import doctest
import importlib
import pkgutil
import subprocess
import sys
from importlib.util import find_spec

import mr_mount_controller
import mr_mount_controller.laws
import pytest
import trackvib_sim
import trackvib_sim.rui

from .bags.made_bags import write_bag

pytestmark = pytest.mark.property

DOORS = (trackvib_sim, trackvib_sim.rui, mr_mount_controller.laws)
NAMES = [(door, name) for door in DOORS for name in door.__all__ if name != "rui"]
# Only these import ROS, or what starts its nodes.
OF_ROS = {
    "mr_mount_controller.node",
    "mr_mount_controller.node_base.descriptors",
    "mr_mount_controller.node_base.listener",
    "mr_mount_controller.node_base.loop_node",
    "mr_mount_controller.node_base.node_process",
    "mr_mount_controller.node_base.packed_message",
    "mr_mount_controller.node_base.qos",
    "trackvib_sim.commands.replay_controller",
    "trackvib_sim.commands.replay_law",
    "trackvib_sim.view.live",
}
# Rooms, and what they need that is installed on demand.
ON_DEMAND = {"trackvib_sim.view": "rerun", "trackvib_sim.learning": "gymnasium", "trackvib_sim.fmu": "pythonfmu"}
# What a bare installation has not.
EXTRAS = ("click", "cma", "distributed", "gymnasium", "jinja2", "matplotlib", "pinocchio", "plotly", "pyarrow", "rich")
BASE = ("rui", "numerics", "road", "vehicle", "simulation", "bags", "analysis.analyse", "data")


@pytest.fixture(scope="module")
def measured_bag(tmp_path_factory):
    """A bag long enough to be measured."""
    path = tmp_path_factory.mktemp("library") / "bag"
    write_bag(path, 4000)
    return path


@pytest.mark.parametrize("door, name", NAMES, ids=lambda each: each if isinstance(each, str) else each.__name__)
def test_every_name_has_an_example_that_runs(door, name, measured_bag):
    """The docstring's own."""
    thing = getattr(door, name)
    found = doctest.DocTestFinder(recurse=False).find(thing, name, globs={"bag": str(measured_bag)})
    examples = [test for test in found if test.examples]
    assert examples, f"{name} has no example"
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.IGNORE_EXCEPTION_DETAIL)
    for test in examples:
        assert runner.run(test).failed == 0


def _modules(package):
    return [each.name for each in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")]


def _blocked(script, names):
    """Run a script in a process that has none of some packages."""
    block = (
        "import sys\n"
        "class Block:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        f"        if name.partition('.')[0] in {names!r} or name.partition('.')[0].endswith('_msgs'):\n"
        "            raise ImportError(f'{name} is blocked')\n"
        "sys.meta_path.insert(0, Block())\n"
    )
    return subprocess.run([sys.executable, "-c", block + script], capture_output=True, text=True)


@pytest.mark.slow(reason="imports every module in processes of its own")
def test_only_nodes_import_ros():
    """Every other module of both packages is imported in a process without ROS; rooms that lack their extra are not."""
    modules = _modules(trackvib_sim) + _modules(mr_mount_controller)
    left_out = ("trackvib_sim.nodes", *(room for room, needs in ON_DEMAND.items() if not find_spec(needs)))
    free = [name for name in modules if name not in OF_ROS and not name.startswith(left_out)]
    assert len(free) > 100
    script = f"import importlib\nfor name in {free!r}:\n    importlib.import_module(name)\n"
    done = _blocked(script, ("rclpy", "ament_index_python", "rcl_interfaces", "std_srvs", "builtin_interfaces"))
    assert done.returncode == 0, done.stderr


@pytest.mark.slow(reason="imports every module in processes of its own")
def test_the_list_of_modules_with_ros_is_true():
    """None of them could be imported without."""
    script = (
        "import importlib\n"
        f"for name in {sorted(OF_ROS)!r}:\n"
        "    try:\n"
        "        importlib.import_module(name)\n"
        "    except ImportError:\n"
        "        continue\n"
        "    print(name)\n"
    )
    done = _blocked(script, ("rclpy", "ament_index_python", "rcl_interfaces", "std_srvs", "builtin_interfaces"))
    assert done.stdout == "" and done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow(reason="imports every module in processes of its own")
def test_the_base_needs_no_extra():
    """Method, vehicle, roads, simulation, reading and measuring bags."""
    names = [name for part in BASE for name in _below(f"trackvib_sim.{part}")]
    done = _blocked(f"import importlib\nfor name in {names!r}:\n    importlib.import_module(name)\n", EXTRAS)
    assert done.returncode == 0, done.stderr


def _below(name):
    module = importlib.import_module(name)
    return [name, *(_modules(module) if hasattr(module, "__path__") else ())]
