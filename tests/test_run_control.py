"""Pause, resume, single step and reset of a running simulator, by its services and real processes."""

import signal

import pytest
from mcap.reader import make_reader
from trackvib_sim.bags.reading import read_recording

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each test is a loop of real processes")]

LOOP_TOPICS = ("/chassis/imu", "/powertrain/imu", "/coil_current", "/mount_state")
ODOMETRY_PERIOD = 10_000_000  # ns


@pytest.fixture
def loop(start_node, observer):
    """Start road, controller and simulator: `loop(**simulator_parameters)`; returns them by name."""

    def make(**parameters):
        controller = start_node("controller", law="skyhook")
        simulator = start_node("simulator", **parameters)
        observer.wait_for(state="waiting")  # else it may find the simulator only when the run is over
        return {"road": start_node("road_excitation"), "controller": controller, "simulator": simulator}

    return make


def stream(bag, topic):
    """Return stamps and bytes of a topic's messages."""
    with next(bag.glob("*.mcap")).open("rb") as file:
        return [(message.log_time, message.data) for _, _, message in make_reader(file).iter_messages([topic])]


@pytest.mark.parametrize("pace", ["lockstep", "realtime"])
def test_pause_step_resume(loop, observer, pace):
    """A paused run stands still, a step takes it one period further, and it goes on where it stood."""
    nodes = loop(pace=pace, answer_timeout=UNHURRIED)
    observer.wait_for(state="running")
    assert not observer.call("step").success
    assert observer.call("pause").success
    stood = observer.wait_for(state="paused")
    for k in range(1, 4):
        assert observer.call("step").success
        observer.wait_for(state="paused", time=str(round(stood * 1000 + k) / 1000))
    assert observer.call("resume").success
    observer.wait_until(lambda: observer.values["state"] == "running" and float(observer.values["time"]) > stood + 0.1)
    assert observer.values["silent_periods"] == "0"
    nodes["simulator"].signal(signal.SIGINT)
    assert nodes["simulator"].wait() == 0
    observer.wait_for(state="stopped")


def test_a_paused_run_ends_cleanly(loop, observer):
    """SIGTERM ends a run that stands."""
    simulator = loop()["simulator"]
    observer.wait_for(state="running")
    observer.call("pause")
    observer.wait_for(state="paused")
    simulator.signal(signal.SIGTERM)
    assert simulator.wait() == 0


def test_reset_gives_the_first_run_again(start_node, loop, observer, tmp_path):
    """After a reset stamps and counts begin anew, the law is reset, and every byte is that of the first epoch."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    nodes = loop(duration=1.5, wait_for_recorder=True, answer_timeout=UNHURRIED)
    observer.client("reset")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.5)
    assert observer.call("reset").success
    assert nodes["simulator"].wait() == 0, nodes["simulator"].output
    assert "epoch 2: the run restarts" in nodes["simulator"].output
    assert "the sample stamps start again: law reset" in nodes["controller"].output
    assert observer.wait_for(state="finished", epoch="2") == 1.5
    assert observer.values["accepted"] == "1500"
    recorder.signal(signal.SIGINT)
    assert recorder.wait() == 0, recorder.output
    first, second = tmp_path / "bag", tmp_path / "bag_epoch_2"
    for topic in LOOP_TOPICS:
        cut, whole = stream(first, topic), stream(second, topic)
        assert 500 <= len(cut) < len(whole) == 1500
        assert cut == whole[: len(cut)], topic
    drive = read_recording(second)
    # a simulator that waits for road tells again where it is, whenever that is
    regular = {stamp for stamp in drive.odometry.stamp.tolist() if stamp % ODOMETRY_PERIOD == 0}
    assert len(regular) == 151 and drive.counts["/vehicle_description"] == 1
    assert drive.counts["/road_profile"] > 10
    assert drive.provenance["parameters of /controller"]["law"] == "skyhook"


def test_reset_of_a_paused_run_stays_paused(loop, observer):
    """Also right after the first period, whose sample then comes a second time and is answered as before."""
    loop()
    observer.wait_for(state="running")
    observer.call("pause")
    observer.wait_for(state="paused")
    for epoch in ("2", "3"):
        assert observer.call("reset").success
        assert observer.wait_for(state="paused", epoch=epoch) == 0.0
        assert observer.values["accepted"] == "0"
        observer.call("step")
        assert observer.wait_for(state="paused", time="0.001", accepted="1") == 0.001


def test_reset_in_real_time(loop, observer):
    """The schedule begins anew as well: the run neither stands still nor hurries."""
    loop(pace="realtime")
    observer.wait_until(lambda: float(observer.values.get("time", 0.0)) > 0.3)
    observer.call("reset")
    observer.wait_for(epoch="2")
    assert float(next(values["time"] for values in observer.told if values["epoch"] == "2")) < 0.3
    observer.wait_until(lambda: float(observer.values["time"]) > 0.5)
    assert float(observer.values["real_time_factor"]) < 1.1


def test_reset_ends_the_wait_for_road(start_node, loop, observer):
    """A run that waits for road can be reset, and goes on once there is road."""
    nodes = loop(duration=8.0, speed=20.0)
    observer.wait_for(state="running")
    nodes["road"].signal(signal.SIGKILL)
    nodes["simulator"].wait_for("no road ahead")
    observer.wait_for(state="waiting")
    assert observer.call("reset").success
    observer.wait_for(epoch="2", state="waiting")
    start_node("road_excitation")
    observer.wait_for(epoch="2", state="running")


def test_before_the_start_there_is_nothing_to_reset(start_node, observer):
    """A simulator that waits for its partners says so, and refuses."""
    start_node("simulator")
    observer.wait_for(state="waiting")
    assert not observer.call("reset").success
    assert observer.values["epoch"] == "1"
