"""One's own controller: the ten lines of docs/controllers.md, and one's own law on the stock node."""

import re
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.system
SLOW = pytest.mark.slow(reason="each controller is a loop of real processes")

ROOT = Path(__file__).parents[1]
LAW = '''
from mr_mount_controller.laws.base import ControlLaw
from mr_mount_controller.node_base.parameters import Parameter


class Mine(ControlLaw):
    """Firm only while the powertrain goes up."""

    parameters = (Parameter("firm", 2.5, "Current on the way up.", "A", 0.0, 5.0),)

    def update(self, sample):
        return self.firm if sample.powertrain_force[2] > 9.81 else 1.0


class Broken(ControlLaw):
    def update(self, sample):
        return float("nan")
'''


@pytest.fixture
def my_laws(user_module):
    """A module with one's own laws on the Python path of the processes."""
    user_module("my_laws", LAW)


@pytest.mark.slow(reason="a whole loop in real processes")
def test_ten_lines_of_the_document(start, start_node, tmp_path):
    """The controller printed in docs/controllers.md closes the loop as it stands there."""
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "controllers.md").read_text(), re.DOTALL)
    controller = next(block for block in blocks if "coil_current" in block)
    assert len([line for line in controller.splitlines() if line.strip()]) <= 12
    (tmp_path / "my_controller.py").write_text(controller)
    start_node("road_excitation")
    start([sys.executable, tmp_path / "my_controller.py"])
    simulator = start_node("simulator", duration=0.5)
    assert simulator.wait() == 0, simulator.output
    assert "answers: 500 accepted" in simulator.output


@SLOW
def test_own_law_in_a_whole_run(start, tmp_path):
    """`PYTHONPATH=. ./trackvib run --law module:Class` finds a law beside the user, as the README says."""
    (tmp_path / "my_laws.py").write_text(LAW)
    options = "--law my_laws:Mine --duration 3 --out run"
    outside = "env -u TRACKVIB_ENVIRONMENT PYTHONPATH=."  # as from a shell that knows nothing of the environment
    run = start(["sh", "-c", f"{outside} {ROOT / 'trackvib'} run {options}"])
    assert run.wait() == 0, run.output
    assert "law my_laws:Mine" in run.output


@SLOW
def test_own_law_on_the_stock_node(my_laws, start_node):
    """`law:=module:Class` runs a law from anywhere, with its own parameters."""
    start_node("road_excitation")
    controller = start_node("controller", law="my_laws:Mine", firm=3.5)
    simulator = start_node("simulator", duration=0.5)
    assert simulator.wait() == 0, simulator.output
    assert "law 'my_laws:Mine'" in controller.output


@SLOW
def test_law_that_answers_nonsense_ends_its_node(my_laws, start_node):
    """The controller says what the law answered and when, and ends with an error; the loop is told nothing."""
    start_node("road_excitation")
    controller = start_node("controller", law="my_laws:Broken")
    start_node("simulator")
    assert controller.wait() != 0
    assert "error: law Broken answered nan at t = 0.001 s" in controller.output
    assert "Traceback" not in controller.output
