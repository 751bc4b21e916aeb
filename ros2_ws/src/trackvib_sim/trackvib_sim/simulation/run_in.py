"""The state in which a run begins: tracks laid at pretension, then rolled in on level road until all is settled."""

import numpy as np

from ..road.store import Road
from ..vehicle.coil import settle_coils
from ..vehicle.engine import angle_before
from ..vehicle.mount_energy import start_mount_energy
from ..vehicle.mount_law import lay_fields
from ..vehicle.system import new_state, new_work
from ..vehicle.tracks.initial import assemble_tracks
from ..vehicle.tracks.nodes import STRIDE, NodeOffset
from .sensing import points_of
from .step import REASONS, Status, advance, new_sample

DURATION = 3.0  # s; the slowest motion, of the driver's speed control, has a time constant of 0.9 s
_SPACING = 1.0  # m
_AROUND = 10.0  # m


class CannotRoll(ValueError):
    """The vehicle does not survive its run-in on a level road."""


def run_in(vehicle, system, settings):
    """Return the state of a vehicle that rolls steadily on a level road at height zero, its hull's origin at x = y = 0.

    Raises
    ------
    CannotRoll
        The state leaves what the model can describe.
    """
    state, work = new_state(system), new_work(system)
    settle_coils(system.coil, state.coils, settings.passive_current)
    lay_fields(system.mounts, state.coils.field, state.fields)
    speed, run_up = settings.operation.speed, settings.operation.run_up
    if run_up:
        state.crank_angle[0] = angle_before(system.engine, DURATION + run_up.begin)
    assemble_tracks(vehicle, system, state, speed, settings.operation.track_phase)
    way = 1.5 * DURATION * speed
    samples = int((2.0 * _AROUND + abs(way)) / _SPACING) + 2
    road = Road(int((min(way, 0.0) - _AROUND) / _SPACING), _SPACING, np.zeros((2, samples)))
    points = points_of((), (), {}, settings.rates)
    steps = round(DURATION / system.dt)
    demanded = np.full(system.mounts.coils, settings.passive_current)
    sample = new_sample(points, 0, system.mounts)
    status = advance(system, state, road, demanded, steps, work, points, sample)
    if status != Status.GOOD:
        raise CannotRoll(
            f"the vehicle cannot roll at {speed:g} m/s on a level road: {REASONS[status]}; check the vehicle file"
        )
    start_mount_energy(state.mount_energy)
    state.driven[:] = 0.0
    return _back_at_start(state)


def _back_at_start(state):
    """Shift everything by the hull's x and y."""
    nodes = state.tracks.nodes.reshape(2, -1, STRIDE)
    for axis in range(2):
        way = state.tree.position[0, axis]
        nodes[:, NodeOffset.PLACE + axis] -= way
        state.tree.position[1:, axis] -= way
        state.tree.position[0, axis] = 0.0
    return state
