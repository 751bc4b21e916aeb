"""The standard simulation interfaces of a running simulator: answered when done, as the standard says."""

import json
from pathlib import Path

import pytest
from action_msgs.msg import GoalStatus
from ament_index_python.packages import get_package_share_directory
from rclpy.action import ActionClient
from rclpy.qos import QoSProfile
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Result, SimulationState, SimulatorFeatures
from simulation_interfaces.srv import (
    GetEntityState,
    GetSimulationState,
    GetSimulatorFeatures,
    ResetSimulation,
    SetSimulationState,
    StepSimulation,
)
from trackvib_sim.numerics.units import NANO

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="loops of real processes")]

# of 2.1.0, as its own build tells them
HASHES = {
    "action/SimulateSteps": "RIHS01_f0837c898e1219cd73bf4c041feab41e8c533e8e1057e982744dba7b093467eb",
    "srv/GetEntityState": "RIHS01_749c91f2a2353d98367b64f2995a0f5842ce92a08ec1ffb3e185540a91557fb5",
    "srv/GetSimulationState": "RIHS01_3362dcebee4b1afebbf9c4beee5c79c1455385aded62092a892d61fde8644f30",
    "srv/GetSimulatorFeatures": "RIHS01_abb9439c8cf196722a469fb6c68b44b484f198c2a1356ac38849a29c2a20a794",
    "srv/ResetSimulation": "RIHS01_4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646",
    "srv/SetSimulationState": "RIHS01_a868b916dce49974f637ba252141258c4b07b0c06858b88af560e3eb6bfbcb30",
    "srv/StepSimulation": "RIHS01_913fe0653690ce6bf8f09f316e6a626747012e9fca31e26719910d417aa8565c",
}
STOPPED, PLAYING, PAUSED, QUITTING = range(4)


@pytest.fixture
def call(observer):
    """Call a service of the simulator: `call(type, name, **fields)`; returns its response."""

    def ask(kind, name, **fields):
        client = observer.node.create_client(kind, f"simulator/{name}")
        observer.wait_for_service(client.service_is_ready)
        future = client.call_async(kind.Request(**fields))
        observer.wait_until(future.done)
        return future.result()

    return ask


@pytest.fixture
def simulator(start_node, observer):
    """A simulator that runs, its partners beside it."""
    start_node("road_excitation")
    start_node("controller", law="skyhook")
    node = start_node("simulator", answer_timeout=UNHURRIED)
    observer.wait_for(state="running")
    return node


def state(number):
    return {"state": SimulationState(state=number)}


def test_states_steps_and_entities(simulator, call):
    """Pause, exact steps, where the hull is after them, reset, stop, play and quit."""
    features = call(GetSimulatorFeatures, "get_simulator_features").features.features
    assert len(features) == 8 and SimulatorFeatures.SIMULATION_RESET in features
    assert not {SimulatorFeatures.SIMULATION_RESET_TIME, SimulatorFeatures.SIMULATION_RESET_STATE} & set(features)
    assert call(GetSimulationState, "get_simulation_state").state.state == PLAYING
    refused = call(StepSimulation, "step_simulation").result
    assert refused.result == Result.RESULT_OPERATION_FAILED and "steps need a paused run" in refused.error_message
    set_state = lambda number: call(SetSimulationState, "set_simulation_state", **state(number)).result.result  # noqa: E731
    assert set_state(PAUSED) == Result.RESULT_OK
    assert set_state(PAUSED) == SetSimulationState.Response.ALREADY_IN_TARGET_STATE
    before = hull(call)
    assert call(StepSimulation, "step_simulation", steps=200).result.result == Result.RESULT_OK
    after = hull(call)
    assert after[0] - before[0] == 200_000_000  # ns, of 200 periods: done when it answers
    assert after[1] - before[1] == pytest.approx(0.1 * (before[2] + after[2]), rel=0.02)
    unknown = call(GetEntityState, "get_entity_state", entity="no\x1bbody").result
    assert unknown.result == Result.RESULT_NOT_FOUND and unknown.error_message.isprintable()
    scope = ResetSimulation.Request
    for alone in (scope.SCOPE_TIME, scope.SCOPE_STATE, scope.SCOPE_SPAWNED, scope.SCOPE_TIME | scope.SCOPE_SPAWNED):
        refused = call(ResetSimulation, "reset_simulation", scope=alone).result
        assert refused.result == Result.RESULT_FEATURE_UNSUPPORTED and "accepted: 0, 3 and 255" in refused.error_message
        assert hull(call)[0] == after[0]
    for whole in (scope.SCOPE_DEFAULT, scope.SCOPE_TIME | scope.SCOPE_STATE, scope.SCOPE_ALL):
        assert call(StepSimulation, "step_simulation", steps=1).result.result == Result.RESULT_OK
        assert call(ResetSimulation, "reset_simulation", scope=whole).result.result == Result.RESULT_OK
        assert hull(call)[0] == 0
    assert call(GetSimulationState, "get_simulation_state").state.state == PAUSED
    assert set_state(PLAYING) == Result.RESULT_OK
    assert set_state(STOPPED) == Result.RESULT_OK
    assert call(GetSimulationState, "get_simulation_state").state.state == STOPPED and hull(call)[0] == 0
    assert set_state(QUITTING) == Result.RESULT_OK
    assert simulator.wait() == 0, simulator.output


def hull(call):
    """Return time [ns], place along x [m] and speed along x [m/s] of the hull."""
    told = call(GetEntityState, "get_entity_state", entity="base_link").state
    stamp = told.header.stamp
    return stamp.sec * NANO + stamp.nanosec, told.pose.position.x, told.twist.linear.x


def test_steps_as_an_action(simulator, call, observer):
    """Word of each step, a result when all are done; a goal can be cancelled."""
    call(SetSimulationState, "set_simulation_state", **state(PAUSED))
    every = QoSProfile(depth=100)  # word, however slow this side is
    client = ActionClient(observer.node, SimulateSteps, "simulator/simulate_steps", feedback_sub_qos_profile=every)
    told = []
    observer.wait_for_service(client.server_is_ready)

    def goal(steps):
        future = client.send_goal_async(
            SimulateSteps.Goal(steps=steps), lambda message: told.append(message.feedback.completed_steps)
        )
        observer.wait_until(future.done)
        return future.result()

    def result(handle):
        future = handle.get_result_async()
        observer.wait_until(future.done)
        return future.result()

    began = hull(call)[0]
    assert result(goal(30)).status == GoalStatus.STATUS_SUCCEEDED
    assert hull(call)[0] - began == 30_000_000
    observer.wait_until(lambda: told == list(range(1, 31)))
    endless = goal(10**12)
    observer.wait_until(lambda: len(told) > 40)
    endless.cancel_goal_async()
    cancelled = result(endless)
    assert cancelled.status == GoalStatus.STATUS_CANCELED and "cancelled after" in cancelled.result.result.error_message
    client.destroy()


def test_types_are_the_standard_ones():
    """Built here or installed, they are those of the standard, so that others' tools understand them."""
    share = Path(get_package_share_directory("simulation_interfaces"))
    for name, expected in HASHES.items():
        told = json.loads((share / f"{name}.json").read_text())["type_hashes"]
        assert {each["type_name"]: each["hash_string"] for each in told}[f"simulation_interfaces/{name}"] == expected
