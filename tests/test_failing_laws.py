"""A law that fails, in each way of running: one sentence with time, file and line, and an exit code."""

import re

import pytest

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="starts a loop for each way of running")]

LAW = """
from mr_mount_controller.laws import ControlLaw


class Late(ControlLaw):
    def update(self, sample):
        return 1.0 if sample.time < 0.1 else 1 / 0


class Unmade(ControlLaw):
    def __init__(self, period, **values):
        raise OSError("no \\x1b[31m\\ndevice")
"""
LATE = r"law Late failed at t = 0\.100 s: ZeroDivisionError: division by zero \(.*/failing_laws\.py, line 7\)$"
UNMADE = r"law Unmade cannot be made: OSError: no \\x1b\[31m\\ndevice \(.*/failing_laws\.py, line 12\)$"


@pytest.fixture(autouse=True)
def failing_laws(user_module):
    """A module with such laws on the Python path of the processes."""
    user_module("failing_laws", LAW)


def one_sentence(output, words):
    """Assert that the only error is that sentence."""
    (error,) = (line for line in output.splitlines() if line.startswith("error: "))
    assert re.search(words, error), error
    assert "Traceback" not in output and "Error occurred at" not in output and output.count("ZeroDivision") <= 1, output


@pytest.mark.parametrize("node", [["controller"], ["one_process", "--one-process"]])
def test_a_run(start_cli, tmp_path, node):
    """The traceback is in the log alone; what was recorded until then is kept."""
    run = start_cli("run", "--law", "failing_laws:Late", "--out", "out", *node[1:])
    assert run.wait() == 1
    one_sentence(run.output, f"^error: '{node[0]}' ended with exit code 1: {LATE}")
    assert run.output.splitlines()[-1] == "kept in out: bag, log"
    log = (tmp_path / "out" / "log" / f"{node[0]}.log").read_text()
    assert "Traceback" in log and "return 1.0 if sample.time < 0.1 else 1 / 0" in log


LAW_OF = {
    "run": ["run", "--one-process", "--law"],
    "rerun": ["replay", "BAG", "--law"],
    "replay": ["replay", "BAG", "--controller"],
    "study": ["study", "controllers", "--scenarios", "bump", "--seeds", "1", "--laws"],
}


@pytest.mark.parametrize(
    ("way", "law"), [*((way, "Unmade") for way in LAW_OF), *((way, "Late") for way in ("rerun", "replay", "study"))]
)
def test_other_ways(start_cli, recorded_run, tmp_path, way, law):
    """What a replay began is taken away; a law that cannot be made leaves nothing anywhere."""
    words = [recorded_run / "bag" if word == "BAG" else word for word in LAW_OF[way]]
    verb = start_cli(*words, f"failing_laws:{law}", "--out", "out")
    assert verb.wait() == 1
    one_sentence(verb.output, LATE if law == "Late" else UNMADE)
    assert way == "study" and law == "Late" or not (tmp_path / "out").exists()


def test_nodes_started_by_hand(start_node):
    """The controller says it once; with `--log-level debug` the traceback comes before."""
    start_node("road_excitation")
    for level in ((), ("--ros-args", "--log-level", "debug", "--")):
        controller = start_node("controller", *level, law="failing_laws:Late")
        simulator = start_node("simulator", duration=1.0)
        assert controller.wait() == 1
        assert re.search(f"^error: {LATE}", controller.output, re.MULTILINE)
        assert ("Traceback" in controller.output) == bool(level)
        assert "Error occurred at" not in controller.output
        simulator.clean_up()
    refused = start_node("controller", law="failing_laws:Unmade")
    assert refused.wait() == 2
    assert re.search(f"^error: {UNMADE}", refused.output, re.MULTILINE) and "Traceback" not in refused.output
