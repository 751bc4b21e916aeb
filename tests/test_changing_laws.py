"""Parameters of a law that change while the loop runs: applied between two samples, recorded, replayed to the bit."""

import signal

import numpy as np
import pytest
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.parameter import Parameter
from trackvib_msgs.msg import CoilCurrent
from trackvib_sim.bags.reading import read_recording

from .conftest import UNHURRIED
from .processes import trackvib

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="a loop of real processes and two replays")]


def changed(observer, **values):
    """Set parameters of the controller together; returns the node's result."""
    client = observer.node.create_client(SetParametersAtomically, "controller/set_parameters_atomically")
    observer.wait_for_service(client.service_is_ready)
    wanted = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
    future = client.call_async(SetParametersAtomically.Request(parameters=wanted))
    observer.wait_until(future.done)
    return future.result().result


def test_a_run_with_changes_is_replayed(start_node, observer, tmp_path):
    """`--verify` and a replay under the recorded law give the recorded bits; what is refused changes nothing."""
    recorder = start_node("recorder", bag=tmp_path / "bag")
    start_node("road_excitation")
    start_node("controller", law="skyhook", firm_current=2.5)
    simulator = start_node("simulator", wait_for_recorder=True, answer_timeout=UNHURRIED)
    answered = set()
    observer.node.create_subscription(CoilCurrent, "coil_current", lambda answer: answered.update(answer.current), 10)
    for time, values, accepted in (
        (1.0, {"firm_current": 3.5, "soft_current": 1.0}, True),
        (1.3, {"soft_current": 3.0, "firm_current": 2.0}, False),
        (1.3, {"firm_current": 2.0, "law": "passive"}, False),
        (1.6, {"corner": 1}, True),
    ):
        observer.wait_until(lambda time=time: float(observer.values.get("time", 0.0)) > time)
        result = changed(observer, **values)
        assert result.successful is accepted, result.reason
        assert accepted or result.reason
        observer.wait_until(lambda: answered & {1.0, 3.5})  # a loop that stands still takes both between two samples
    observer.wait_until(lambda: float(observer.values["time"]) > 3.0)
    for process in (simulator, recorder):
        process.signal(signal.SIGINT)
        assert process.wait() == 0, process.output
    bag = read_recording(tmp_path / "bag")
    stamps, values = zip(*bag.law_changes, strict=True)
    assert list(values) == [{"firm_current": 3.5, "soft_current": 1.0}, {"corner": 1.0}]
    assert 0 < stamps[0] < stamps[1] and np.isin(stamps, bag.chassis.stamp).all()
    assert set(np.unique(bag.answers.current)) == {0.8, 1.0, 2.5, 3.5}
    assert "identical to the last bit" in trackvib("replay", tmp_path / "bag", "--verify")
    trackvib("replay", tmp_path / "bag", "--law", "skyhook", "--out", tmp_path / "again")
    again = read_recording(tmp_path / "again" / "bag")
    assert again.law_changes == bag.law_changes
    printed = trackvib("replay", tmp_path / "bag", "--controller", "skyhook", "--out", tmp_path / "asked")
    assert "identical to the recorded ones to the last bit" in printed
    last = len(again.answers.current)
    assert last > 2900 and again.answers.current.tobytes() == bag.answers.current[:last].tobytes()
