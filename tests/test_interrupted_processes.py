"""Nodes that do not run for a while: they do not take their own absence for the silence of others."""

import signal
import time

import pytest
from trackvib_sim.analysis.completeness import missing
from trackvib_sim.bags.reading import read_recording

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="stops processes for longer than they wait for each other")]

AWAY = 3.0  # s
TIMEOUT = 2.0  # s, of answers: less than AWAY, more than a busy machine needs for one


@pytest.fixture
def loop(start_node, observer, tmp_path):
    """A whole loop with a recorder, by the names of its nodes."""
    nodes = {"recorder": start_node("recorder", bag=tmp_path / "bag")}
    nodes["controller"] = start_node("controller", law="skyhook", wait_for_recorder=True)
    nodes["simulator"] = start_node("simulator", duration=4.0, wait_for_recorder=True, answer_timeout=TIMEOUT)
    observer.wait_for(state="waiting")  # else it may find the simulator only when the run is over
    nodes["road_excitation"] = start_node("road_excitation")
    return nodes


def freeze(process, seconds):
    """Stop a process for so long: what is tested is that time itself."""
    process.signal(signal.SIGSTOP)
    time.sleep(seconds)
    process.signal(signal.SIGCONT)


@pytest.mark.parametrize("name", ["simulator", "recorder"])
def test_a_stopped_node_blames_nobody(loop, observer, tmp_path, name):
    """Wherever in its period the simulator stands, or its recorder, every sample has its answer, and the bag all."""
    for begin in (0.3, 1.0, 1.7):
        observer.wait_until(lambda begin=begin: float(observer.values.get("time", 0.0)) > begin)
        freeze(loop[name], AWAY)
    assert loop["simulator"].wait() == 0, loop["simulator"].output
    said = loop["simulator"].output
    assert "no answer" not in said and "keep up" not in said and said.strip().endswith("answers: 4000 accepted"), said
    loop["recorder"].signal(signal.SIGINT)
    assert loop["recorder"].wait() == 0
    assert missing(read_recording(tmp_path / "bag")) == []


def test_a_stopped_controller_is_silent(loop, observer):
    """For the simulator ran, and waited."""
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.3)
    loop["controller"].signal(signal.SIGSTOP)
    loop["simulator"].wait_for("holding the last current")
    loop["controller"].signal(signal.SIGCONT)
    loop["simulator"].wait_for("answers again")
    assert loop["simulator"].wait() == 0, loop["simulator"].output
