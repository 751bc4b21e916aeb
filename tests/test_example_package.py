"""The example package of docs/controllers.md, built with colcon outside the workspace and run in each way it shows."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="builds and installs a package")]

DOCUMENT = Path(__file__).parents[1] / "docs" / "controllers.md"
EXAMPLE = DOCUMENT.parent / "examples" / "my_controller"
COLCON = "import sys; from colcon_core.command import main; sys.exit(main())"


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Prefix of the package, built from a copy."""
    folder = tmp_path_factory.mktemp("workspace")
    shutil.copytree(EXAMPLE, folder / "src" / "my_controller")
    env = {**os.environ, "COLCON_HOME": str(folder / "home"), "COLCON_LOG_PATH": str(folder / "log")}
    build = subprocess.run([sys.executable, "-c", COLCON, "build"], cwd=folder, env=env, text=True,
                           capture_output=True)  # fmt: skip
    assert build.returncode == 0, build.stdout + build.stderr
    return folder / "install" / "my_controller"


@pytest.fixture
def sourced(built, env):
    """The environment of the test's processes as after `source install/setup.bash`."""
    shell = f'. "{built.parent / "setup.bash"}" && env -0'
    words = subprocess.run(["bash", "-c", shell], env=env, check=True, capture_output=True).stdout.decode()
    env.update(word.split("=", 1) for word in words.split("\0") if word)


def test_law_is_known_by_its_name(sourced, start_node):
    """The entry point brings the law and its parameters to the stock node."""
    start_node("road_excitation")
    controller = start_node("controller", law="busy_firm", slope=80.0)
    simulator = start_node("simulator", duration=0.5)
    assert simulator.wait() == 0, simulator.output
    assert "law 'busy_firm'" in controller.output
    assert "answers: 500 accepted" in simulator.output


def test_law_is_found_by_its_place(sourced, start_node):
    """`law:=package.module:Class` runs the same law; its ranges hold."""
    controller = start_node("controller", law="my_controller.busy_firm:BusyFirm", memory=20.0)
    assert controller.wait() != 0
    for words in ("'memory' is 20.0", "from 0.01 to 10 s"):
        assert words in controller.output


def test_law_in_the_command_line(sourced, start_cli):
    """`run --help` lists the law beside ours."""
    help_text = start_cli("run", "--help")
    assert help_text.wait() == 0
    assert "busy_firm" in help_text.output


def test_node_of_ones_own(sourced, built, start, start_node):
    """The node closes the loop without any of our Python."""
    start_node("road_excitation")
    start([built / "lib" / "my_controller" / "own_node", "--ros-args", "-p", "firm_current:=2.0"])
    simulator = start_node("simulator", duration=0.5)
    assert simulator.wait() == 0, simulator.output
    assert "answers: 500 accepted" in simulator.output


def test_document_names_what_there_is():
    """Every file of the example that the document names is there, and the commands name its law and its node."""
    text = DOCUMENT.read_text(encoding="utf-8")
    for name in ("setup.py", "my_controller/busy_firm.py", "my_controller/own_node.py"):
        assert f"`{name}`" in text and (EXAMPLE / name).is_file()
    for command in ("law:=busy_firm", "law:=my_controller.busy_firm:BusyFirm", "ros2 run my_controller own_node"):
        assert command in text
