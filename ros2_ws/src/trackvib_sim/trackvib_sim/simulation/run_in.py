"""The state in which a run begins: tracks laid at pretension, then rolled in on level road until all is settled."""

import numpy as np

from ..road.store import Road
from ..vehicle.coil import settle_coils
from ..vehicle.drive.drive import begin_drive
from ..vehicle.drive.engine import CYCLE
from ..vehicle.drive.schedule import Schedule
from ..vehicle.mount_energy import start_mount_energy
from ..vehicle.mount_law import lay_fields
from ..vehicle.system import new_state, new_work
from ..vehicle.tracks.initial import assemble_tracks
from ..vehicle.tracks.nodes import STRIDE, NodeOffset
from .sensing import points_of
from .step import REASONS, Status, control_periods, new_sample, one_row

DURATION = 3.0  # s; the slowest motion, of the driver's speed control, has a time constant of 0.9 s
CALMED = 2.0  # s of it, in which a standing vehicle's tracks are brought to rest
CALMING_DAMPING = 20.0  # N m s/rad of a pin, a bushing of high loss
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
    schedule = system.drive.schedule
    speed = float(schedule.speed[0])
    if len(schedule.at) > 1:  # whatever is wanted from then on, the crank's angle is zero at the start of the run
        state.drive.crank.angle[0] = -DURATION * state.drive.crank.speed[0] % CYCLE
    system = system._replace(drive=system.drive._replace(schedule=_first(schedule)))
    state = state._replace(drive=begin_drive(system.drive, state.drive))
    assemble_tracks(vehicle, system, state, speed, settings.operation.track_phase)
    way = 1.5 * DURATION * speed
    samples = int((2.0 * _AROUND + abs(way)) / _SPACING) + 2
    road = Road(int((min(way, 0.0) - _AROUND) / _SPACING), _SPACING, np.zeros((2, samples)))
    points = points_of((), (), {}, settings.rates)
    demanded = np.full(system.mounts.coils, settings.passive_current)
    samples = new_sample(points, 0, system.mounts), new_sample(points, 0, system.mounts)
    parts = ((calmed(system), CALMED), (system, DURATION - CALMED)) if speed == 0.0 else ((system, DURATION),)
    status = Status.GOOD
    for now, duration in parts:
        if status == Status.GOOD:
            steps, rows = round(duration / now.dt), one_row(samples[0])
            status = next(control_periods(now, state, road, demanded, steps, work, points, *samples, rows))
    if status != Status.GOOD:
        raise CannotRoll(
            f"the vehicle cannot roll at {speed:g} m/s on a level road: {REASONS[status]}; check the vehicle file"
        )
    start_mount_energy(state.mount_energy)
    return _back_at_start(state, system.drive._replace(schedule=schedule))


def _first(schedule):
    """Return a schedule of what is wanted first, straight on."""
    begin = {name: values[:1] for name, values in schedule._asdict().items() if name != "by_distance"}
    return Schedule(False, **begin | {"curvature": np.zeros(1)})


def calmed(system):
    """Return a system whose pins are so stiff to turn that the upper runs, which nothing else damps, come to rest.

    For a standing vehicle only: one that moves shakes its tracks itself.
    """
    tracks = system.tracks
    chain = tracks.chain._replace(pin_damping=max(tracks.chain.pin_damping, CALMING_DAMPING))
    return system._replace(tracks=tracks._replace(chain=chain))


def _back_at_start(state, drive):
    """Shift everything by the hull's x and y, and begin time, path and what the drive has done."""
    nodes = state.tracks.nodes.reshape(2, -1, STRIDE)
    for axis in range(2):
        way = state.tree.position[0, axis]
        nodes[:, NodeOffset.PLACE + axis] -= way
        state.tree.position[1:, axis] -= way
        state.tree.position[0, axis] = 0.0
    return state._replace(drive=begin_drive(drive, state.drive))
