"""What the loop does when a partner falls silent, dies or answers nonsense."""

import re
import signal
import sys
from pathlib import Path

import pytest

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each fault is a loop of real processes that waits")]

UNRULY = Path(__file__).parent / "controllers" / "unruly.py"


@pytest.fixture
def loop(start_node):
    """Start road, controller and simulator, wait until they run: `loop(**simulator_parameters)`."""

    def make(**parameters):
        start_node("road_excitation")
        controller = start_node("controller", law="skyhook")
        simulator = start_node("simulator", **parameters)
        simulator.wait_for("running")
        return controller, simulator

    return make


@pytest.mark.parametrize(("policy", "words"), [("hold", "holding the last current"), ("passive", "falling back")])
def test_loop_runs_on_when_the_controller_dies(loop, policy, words):
    """The silence is said once, counted, and the run goes on to its end."""
    controller, simulator = loop(duration=4.0, answer_timeout=2.0, on_silence=policy)
    controller.signal(signal.SIGKILL)
    assert simulator.wait() == 0, simulator.output
    assert simulator.output.count(words) == 1
    assert re.search(r"answers: .*\d+ silent_periods", simulator.output)


def test_loop_stops_when_asked_to(loop):
    """With on_silence 'stop' the simulator ends with an error that says when."""
    controller, simulator = loop(duration=60.0, answer_timeout=0.2, on_silence="stop")
    controller.signal(signal.SIGKILL)
    assert simulator.wait() != 0
    assert re.search(r"error: no answer to the sample at t = \d+\.\d+ s; on_silence is 'stop'", simulator.output)


def test_a_new_controller_is_heard_again(loop, start_node):
    """After a controller died, another one takes over and the lock-step closes again."""
    controller, simulator = loop(duration=0.0, answer_timeout=0.2)
    controller.signal(signal.SIGKILL)
    simulator.wait_for("holding the last current")
    start_node("controller").wait_for("first sample")
    simulator.wait_for("answers again, waiting for every answer")
    simulator.signal(signal.SIGINT)
    assert simulator.wait() == 0


@pytest.mark.parametrize("kind", ["late", "early", "not_finite", "infinite", "duplicate", "saturated"])
def test_nonsense_never_satisfies_the_wait(start, start_node, kind):
    """Each useless answer is counted by its kind, one a sample, and the proper one beside it keeps the loop going."""
    start_node("road_excitation")
    start([sys.executable, UNRULY, kind])
    simulator = start_node("simulator", duration=0.5, answer_timeout=UNHURRIED)
    assert simulator.wait() == 0, simulator.output
    counted = dict((name, int(n)) for n, name in re.findall(r"(\d+) (\w+)", simulator.output.split("answers: ")[1]))
    outcome = "not_finite" if kind == "infinite" else kind
    assert counted["accepted"] == 500
    # the last duplicate may come after the end
    assert counted[outcome] in (499, 500)
    assert set(counted) == {"accepted", outcome}


def test_road_node_may_start_again(start_node):
    """A road node that dies is waited for, and a new one feeds the run on from where it is."""
    road = start_node("road_excitation", horizon=10.0)
    start_node("controller")
    simulator = start_node("simulator", duration=4.0, speed=20.0)
    simulator.wait_for("running")
    road.signal(signal.SIGKILL)
    simulator.wait_for("no road ahead")
    start_node("road_excitation", horizon=10.0)
    assert simulator.wait() == 0, simulator.output
    assert "4 s simulated" in simulator.output


def test_real_time_follows_the_wall_clock(start_node, observer):
    """At half real time samples go on, and every answer is used, late or not."""
    start_node("road_excitation")
    start_node("controller")
    start_node("simulator", pace="realtime", real_time_factor=0.5, duration=0.0)
    observer.wait_until(lambda: sum(int(observer.values.get(name, 0)) for name in ("accepted", "late")) >= 1000)
    assert {observer.values[name] for name in ("early", "duplicate", "not_finite")} == {"0"}
    # it cannot be faster than asked for; how much slower is the machine's affair
    assert 0.0 < float(observer.values["real_time_factor"]) <= 0.51


def test_real_time_falls_silent_as_well(start_node):
    """In real time a dead controller is noticed by the wall clock, said once and counted."""
    start_node("road_excitation")
    controller = start_node("controller")
    simulator = start_node("simulator", pace="realtime", duration=4.0, answer_timeout=2.0, on_silence="passive")
    simulator.wait_for("running")
    controller.wait_for("first sample")
    controller.signal(signal.SIGKILL)
    assert simulator.wait() == 0, simulator.output
    assert simulator.output.count("falling back to the passive current") == 1
    assert re.search(r"answers: .*\d+ silent_periods", simulator.output)


def test_overturned_vehicle_fails_the_run(start_node):
    """A road beyond the valid range ends the simulator with an error that names reason and time."""
    start_node("road_excitation", road="H")
    start_node("controller")
    simulator = start_node("simulator", speed=25.0)
    assert simulator.wait() != 0
    assert re.search(r"error: run failed: .* after t = \d+\.\d+ s", simulator.output), simulator.output


def test_rates_of_simulator_and_controller_must_agree(start_node):
    """A controller that expects another rate ends itself and names both."""
    start_node("road_excitation")
    controller = start_node("controller", sample_rate=1000)
    start_node("simulator", control_rate=500)
    assert controller.wait() != 0
    assert "500 Hz" in controller.output and "sample_rate is 1000 Hz" in controller.output


def test_shortest_run_is_one_period(start_node):
    """A duration below a period gives one period, not an endless run."""
    start_node("road_excitation")
    start_node("controller")
    simulator = start_node("simulator", duration=0.0004)
    assert simulator.wait() == 0
    assert "answers: 1 accepted" in simulator.output


def test_real_time_without_road_stops_with_the_distance(start_node):
    """In real time a missing road ends the run with an error that names the distance."""
    road = start_node("road_excitation", horizon=10.0)
    start_node("controller")
    simulator = start_node("simulator", pace="realtime", speed=20.0)
    simulator.wait_for("running")
    road.signal(signal.SIGKILL)
    assert simulator.wait() != 0
    assert re.search(r"error: no road ahead at \d+\.\d m", simulator.output)
