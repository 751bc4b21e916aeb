"""Further faults of the loop, with real processes: the rows of docs/loop.md that test_loop_faults.py leaves."""

import re
import signal
import sys
from pathlib import Path

import pytest
from trackvib_sim.bags.reading import read_recording

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each fault is a loop of real processes that waits")]

CONTROLLERS = Path(__file__).parent / "controllers"
PROPER = 2.0  # A, what the unruly controller answers properly
PASSIVE = 1.0  # A
# s, short enough to wait for, long enough that a busy machine keeps nobody silent for so long
NOTICED = 2.0


def counted(simulator):
    """Return what a simulator has counted, by its last line."""
    return {name: int(n) for n, name in re.findall(r"(\d+) (\w+)", simulator.output.split("answers: ")[1])}


@pytest.fixture
def unruly(start):
    """Start the unruly controller: `unruly(kind, sample)`."""
    return lambda *arguments: start([sys.executable, CONTROLLERS / "unruly.py", *arguments])


@pytest.mark.parametrize(
    ("policy", "current", "kind"),
    [("hold", PROPER, "not_finite"), ("passive", PASSIVE, "late"), ("stop", PROPER, "not_finite")],
)
def test_nothing_but_nonsense_is_silence(start_node, unruly, observer, policy, current, kind):
    """Who answers nothing useful is silent: what then flows, and whether the run goes on, is on_silence's choice."""
    unruly(kind, 200)
    simulator = start_node("simulator", duration=0.5, answer_timeout=NOTICED, on_silence=policy)
    observer.wait_for(state="waiting")  # who comes later may miss the end of a run as short as this
    start_node("road_excitation")
    code = simulator.wait()
    if policy == "stop":
        assert code != 0 and "no answer to the sample at t = 0.200 s" in simulator.output
    else:
        assert code == 0, simulator.output
        assert counted(simulator)["accepted"] == 199 and counted(simulator)["silent_periods"] == 301
    observer.wait_for(
        state="failed" if policy == "stop" else "finished", current_left=str(current), current_right=str(current)
    )


def test_answers_out_of_order(start_node, unruly):
    """An answer that comes behind the next one is late, and changes nothing."""
    start_node("road_excitation")
    unruly("out_of_order")
    simulator = start_node("simulator", duration=0.5, answer_timeout=UNHURRIED)
    assert simulator.wait() == 0, simulator.output
    assert counted(simulator)["accepted"] == 500 and counted(simulator)["late"] >= 498


def test_a_slow_answer_is_late_and_its_controller_heard_again(start_node, unruly):
    """One answer beyond the timeout: the last current is held, the answer is late, then the lock-step closes again."""
    start_node("road_excitation")
    unruly("slow", 200)
    simulator = start_node("simulator", duration=0.0, answer_timeout=NOTICED)
    simulator.wait_for("no answer to the sample at t = 0.200 s; holding the last current")
    simulator.wait_for("answers again, waiting for every answer")
    assert simulator.running


def test_two_controllers_at_once(start_node, observer):
    """Of two answers the first counts, the other is a duplicate or late; both are told."""
    for current in (1.5, 2.5):
        start_node("controller", current=current)
    simulator = start_node("simulator", duration=1.0, answer_timeout=UNHURRIED)
    observer.wait_for(state="waiting")
    start_node("road_excitation")
    assert simulator.wait() == 0, simulator.output
    assert "2 nodes answer on coil_current; the first answer is used" in simulator.output
    counts = counted(simulator)
    assert counts["accepted"] == 1000
    # whoever is slower may not even get to see every sample
    assert 0 < counts.get("duplicate", 0) + counts.get("late", 0) <= 1000
    assert set(counts) <= {"accepted", "duplicate", "late"}
    observer.wait_for(state="finished", controllers="2")
    assert observer.values["current_left"] in ("1.5", "2.5")


def test_simulator_killed_and_restarted(start_node, observer, tmp_path):
    """Road, controller and recorder go on with the new simulator as with the first run of a new one."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("road_excitation")
    controller = start_node("controller", law="skyhook", wait_for_recorder=True)
    simulator = start_node("simulator", wait_for_recorder=True)
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.3)
    simulator.signal(signal.SIGKILL)
    again = start_node("simulator", duration=0.5, speed=12.0, wait_for_recorder=True, answer_timeout=UNHURRIED)
    assert again.wait() == 0, again.output
    assert counted(again) == {"accepted": 500}
    assert "the sample stamps start again: law reset" in controller.output
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    drive = read_recording(tmp_path / "bag_epoch_2")
    assert len(drive.chassis.stamp) == len(drive.answers.sample_stamp) == 500
    assert drive.provenance["parameters of /simulator"]["speed"] == "12.0"


def test_recorder_killed(start_node, observer, tmp_path):
    """A run that waits for its recorder gives up on one that was killed, says so once, and goes on."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("controller")
    simulator = start_node("simulator", duration=2.0, wait_for_recorder=True, answer_timeout=UNHURRIED)
    observer.wait_for(state="waiting")  # else it may find the simulator only when the run is over
    start_node("road_excitation")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.2)
    recorder.signal(signal.SIGKILL)
    assert simulator.wait() == 0, simulator.output
    assert simulator.output.count("the recorder does not keep up") == 1
    assert counted(simulator) == {"accepted": 2000}


def relayed(name):
    """Arguments that let a controller's topic go over a relay."""
    return "--ros-args", "-r", f"{name}:=relayed", "--"


def test_dropped_samples(start, start_node, observer):
    """A sample that a relay drops is not answered: the silence is counted and the controller tells the gap."""
    start_node("road_excitation")
    start([sys.executable, CONTROLLERS / "relay.py", "Imu", "powertrain/imu", "relayed", "drop", 0, 200])
    controller = start_node("controller", *relayed("powertrain/imu"))
    simulator = start_node("simulator", duration=0.0, answer_timeout=NOTICED)
    # while nobody is waited for the run is as fast as it can be: it must not end meanwhile
    simulator.wait_for("answers again, waiting for every answer")
    assert simulator.output.index("holding the last current") < simulator.output.index("answers again")
    controller.wait_for("s apart")
    # of a period of 0.001 s; how far the run gets until an answer arrives is the machine's affair
    apart = round(1000.0 * float(re.search(r"samples (\S+) s apart", controller.output)[1]))
    assert apart >= 2

    def count(name):
        return int(observer.values.get(name, 0))

    observer.wait_until(lambda: count("silent_periods") >= max(4, apart - 1) and count("accepted") > 0)
    told = observer.values
    periods = round(1000.0 * float(told["time"]))
    # diagnostics are told before the answer to their own sample, or after its silence
    assert periods - 1 <= int(told["accepted"]) + int(told["silent_periods"]) <= periods


@pytest.mark.parametrize(("seconds", "timeout", "silent"), [(0.1, UNHURRIED, False), (2.5 * NOTICED, NOTICED, True)])
def test_delayed_answers(start, start_node, seconds, timeout, silent):
    """A delay within the timeout changes nothing; beyond it the loop holds the current until it hears an answer."""
    start_node("road_excitation")
    words = ("CoilCurrent", "relayed", "coil_current", "delay", seconds, 200)
    relay = start([sys.executable, CONTROLLERS / "relay.py", *words])
    start_node("controller", *relayed("coil_current"))
    relay.wait_for("found its source")  # to find each other may take longer than the timeout of the first answer
    simulator = start_node("simulator", duration=0.9, answer_timeout=timeout)
    assert simulator.wait() == 0, simulator.output
    counts = counted(simulator)
    if silent:
        assert counts["silent_periods"] > 0 and counts["accepted"] + counts["silent_periods"] == 900
        assert "holding the last current" in simulator.output
    else:
        assert counts == {"accepted": 900}
