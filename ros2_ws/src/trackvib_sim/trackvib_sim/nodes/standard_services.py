"""The standard simulation interfaces (`simulation_interfaces` 2.1) of the simulator, beside its own services.

Other than those they answer when what was asked for is done.
"""

from functools import partial

from mr_mount_controller.node_base.plain_text import shortened
from mr_mount_controller.node_base.qos import LOOP_WRITER_QOS
from rclpy.action import ActionServer, CancelResponse
from rclpy.task import Future
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

from ..bags.versions import versions
from .entities import Entities

_FEATURES = (
    SimulatorFeatures.ENTITY_STATE_GETTING,
    SimulatorFeatures.SIMULATION_RESET,
    SimulatorFeatures.SIMULATION_STATE_GETTING,
    SimulatorFeatures.SIMULATION_STATE_SETTING,
    SimulatorFeatures.SIMULATION_STATE_PAUSE,
    SimulatorFeatures.STEP_SIMULATION_SINGLE,
    SimulatorFeatures.STEP_SIMULATION_MULTIPLE,
    SimulatorFeatures.STEP_SIMULATION_ACTION,
)
_TOGETHER = ResetSimulation.Request.SCOPE_TIME | ResetSimulation.Request.SCOPE_STATE
_STATES = {
    SimulationState.STATE_STOPPED: "stopped",
    SimulationState.STATE_PLAYING: "playing",
    SimulationState.STATE_PAUSED: "paused",
    SimulationState.STATE_QUITTING: "quitting",
}
_SERVICES = (
    (GetSimulatorFeatures, "get_simulator_features", "The features of the standard that it supports."),
    (GetSimulationState, "get_simulation_state", "Whether it is stopped, playing or paused."),
    (SetSimulationState, "set_simulation_state", "Play, pause, stop (pause and restart) or quit."),
    (StepSimulation, "step_simulation", "Advances a paused run by a number of periods; answered when they are done."),
    (ResetSimulation, "reset_simulation", "Restarts the run; answered when done."),
    (GetEntityState, "get_entity_state", "Pose and twist of a body, by the name of its frame."),
)
SERVICES = (
    *((name, f"simulation_interfaces/srv/{kind.__name__}", meaning) for kind, name, meaning in _SERVICES),
    (
        "simulate_steps",
        "simulation_interfaces/action/SimulateSteps",
        "The same as an action, with feedback after each period.",
    ),
)


class StandardServices:
    """Services and action under the node's name; what they want is done by its `run_control.RunControl`."""

    def __init__(self, node, control, simulation, vehicle_text):
        self._control, self._entities = control, Entities(simulation, vehicle_text)
        self._stopped = False
        for kind, name, _ in _SERVICES:
            self._offer(node, kind, name)
        self._goals = {}  # what each goal's cancellation sets done
        self._action = ActionServer(
            node, SimulateSteps, "~/simulate_steps", self._simulate_steps, cancel_callback=self._cancel,
            feedback_pub_qos_profile=LOOP_WRITER_QOS,  # a word a step, and a client may be slow for a moment
        )  # fmt: skip

    def close(self):
        """Give back what the action takes."""
        self._action.destroy()

    def _offer(self, node, kind, name):
        """Offer a service whose method is a coroutine; the response is sent when that ends."""
        work = getattr(self, f"_{name}")
        service = node.create_service(kind, f"~/{name}", lambda request, response: work(request, response))
        send = service.send_response

        def send_later(coroutine, header):  # the executor hands on whatever the callback has returned
            self._go_on(coroutine, lambda response: send(response, header))

        service.send_response = send_later

    def _go_on(self, coroutine, end):
        """Let a coroutine run up to the next thing that it waits for, and so on; `end` takes what it returns."""
        try:
            condition = coroutine.send(None)
        except StopIteration as ended:
            end(ended.value)
            return
        self._control.when(condition, partial(self._go_on, coroutine, end))

    async def _get_simulator_features(self, _request, response):
        told = ", ".join(f"{name} {version}" for name, version in versions().items() if name.startswith("trackvib"))
        response.features = SimulatorFeatures(features=_FEATURES, custom_info=told)
        return response

    async def _get_simulation_state(self, _request, response):
        response.state.state, response.result = self._state(), _ok()
        return response

    def _state(self):
        if not self._control.paused:
            return SimulationState.STATE_PLAYING
        return SimulationState.STATE_STOPPED if self._stopped else SimulationState.STATE_PAUSED

    async def _set_simulation_state(self, request, response):
        control, wanted = self._control, request.state.state
        if wanted not in _STATES:
            response.result = _failed("there is no world to unload or load", Result.RESULT_FEATURE_UNSUPPORTED)
            return response
        if wanted == self._state():
            already = SetSimulationState.Response.ALREADY_IN_TARGET_STATE
            response.result = _failed(f"it is already {_STATES[wanted]}", already)
            return response
        if wanted == SimulationState.STATE_QUITTING:
            control.quit()
        elif wanted == SimulationState.STATE_PLAYING:
            self._stopped = False
            control.resume()
        else:
            control.pause()
            self._stopped = wanted == SimulationState.STATE_STOPPED
            if self._stopped and control.begun:
                await self._reset()
            elif control.state == "running":
                await _Happened(lambda: control.state != "running" or not control.paused)
        response.result = _ok()
        return response

    async def _step_simulation(self, request, response):
        response.result = await self._steps(request.steps)
        return response

    async def _simulate_steps(self, goal):
        total, cancelled = goal.request.steps, []
        self._goals[bytes(goal.goal_id.uuid)] = cancelled

        def tell(done):
            goal.publish_feedback(SimulateSteps.Feedback(completed_steps=done, remaining_steps=total - done))

        steps = Future()
        self._go_on(self._steps(total, tell, cancelled), steps.set_result)
        result = await steps
        del self._goals[bytes(goal.goal_id.uuid)]
        end = goal.canceled if cancelled else goal.succeed if result.result == Result.RESULT_OK else goal.abort
        end()
        return SimulateSteps.Result(result=result)

    def _cancel(self, goal):
        self._goals[bytes(goal.goal_id.uuid)].append(True)
        self._control.look()
        return CancelResponse.ACCEPT

    async def _steps(self, count, tell=lambda done: None, cancelled=()):
        """Do periods of a paused run one by one; returns the `Result` when they are done, or no more can be."""
        control = self._control
        if not control.paused:
            return _failed("steps need a paused run")
        if count < 1:
            return _failed(f"steps is {count}, accepted: a whole number from 1 on")
        self._stopped, epoch = False, control.epoch
        for done in range(1, count + 1):
            last = control.periods
            control.add_steps(1)
            await _Happened(lambda last=last: control.periods > last or self._is_over(epoch, cancelled))
            if control.periods == last:
                control.drop_steps(1)
                why = "cancelled" if cancelled else "the run was resumed or reset"
                return _failed(f"{why} after {done - 1} of {count} steps")
            tell(done)
        return _ok()

    def _is_over(self, epoch, cancelled):
        return self._control.epoch != epoch or not self._control.paused or bool(cancelled)

    async def _reset_simulation(self, request, response):
        if request.scope and request.scope & _TOGETHER != _TOGETHER:
            # a jump of one alone would tear path, drive and recording apart, and no replay could follow
            told = f"scope is {request.scope}, accepted: 0, {_TOGETHER} and 255: time and state are reset together"
            response.result = _failed(told, Result.RESULT_FEATURE_UNSUPPORTED)
        elif not self._control.begun:
            response.result = _failed("the run has not started", Result.RESULT_INCORRECT_STATE)
        else:
            await self._reset()
            response.result = _ok()
        return response

    async def _reset(self):
        epoch = self._control.epoch
        self._control.reset()
        await _Happened(lambda: self._control.epoch != epoch)

    async def _get_entity_state(self, request, response):
        try:
            response.state, response.result = self._entities.state(request.entity), _ok()
        except KeyError:
            known = ", ".join(self._entities.names)
            response.result = _failed(
                f"unknown entity {shortened(repr(request.entity))}, known are: {known}", Result.RESULT_NOT_FOUND
            )
        return response


class _Happened:
    """What a coroutine waits for; `StandardServices._go_on` gets the condition."""

    def __init__(self, condition):
        self._condition = condition

    def __await__(self):
        yield self._condition


def _ok():
    return Result(result=Result.RESULT_OK)


def _failed(message, code=Result.RESULT_OPERATION_FAILED):
    return Result(result=code, error_message=message)
