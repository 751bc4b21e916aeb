"""The closed loop in one process: the same simulation, road and law as the nodes run, without any transport."""

from collections import deque
from typing import NamedTuple

import numpy as np
from mr_mount_controller.laws.base import ControlLaw, Sample
from mr_mount_controller.laws.running import answer, changed_law, run_law_on

from ..numerics.units import NANO
from ..road.feeder import HasHeights, RoadFeeder
from .lockstep import Lockstep
from .open_loop import joined
from .readings import Readings
from .simulation import HORIZON, POWERTRAIN, Simulation


class Record(NamedTuple):
    """The signals of a run, one row per control period; for probes one per physics step.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Record._fields[:3]
    ('stamp', 'specific_force', 'angular_velocity')
    """

    stamp: np.ndarray  # (k,) ns
    specific_force: np.ndarray  # (k, 2, 3) m/s^2, chassis and powertrain
    angular_velocity: np.ndarray  # (k, 2, 3) rad/s
    current: np.ndarray  # (k, coils) demanded in answer to the row's sample, A
    coil_current: np.ndarray  # (k, coils) at the end of the period, A
    deflection: np.ndarray  # (k, mounts, 3) at the end of the period, hull axes, m
    force: np.ndarray  # (k, mounts, 3) on the powertrain at the same time, hull axes, N
    probed: np.ndarray  # (k steps, p, 3) specific force in the axes of the probes' bodies, m/s^2


def run_closed_loop(simulation: Simulation, road: HasHeights, law: ControlLaw, periods: int) -> Record:
    """Run `simulation.Simulation` on a road under a control law for a number of control periods.

    Bit-identical to what the nodes do in lock-step with the same vehicle, settings, road and law, on one machine.

    Raises
    ------
    RunFailed, LawError
        As the simulation and the law do.

    Examples
    --------
    A tenth of a second under the skyhook law; the record has one row per millisecond.

    >>> import trackvib_sim as tv
    >>> from mr_mount_controller.laws import find_law
    >>> vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    >>> settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    >>> road, law = tv.Iso8608Road("E", seed=1), find_law("skyhook")(1e-3)
    >>> record = tv.run_closed_loop(tv.Simulation(vehicle, settings), road, law, periods=100)
    >>> record.specific_force.shape  # (periods, chassis and powertrain, x y z)
    (100, 2, 3)
    """
    feeder = RoadFeeder(road, HORIZON)

    def feed():
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)

    coils, mounts = (simulation.mounting.coils,), (len(simulation.mounting.mounts), 3)
    shapes = ((2, 3), (2, 3), coils, coils, mounts, mounts)
    probed = np.zeros((periods, *simulation.sample.probed.shape))
    record = Record(
        np.zeros(periods, dtype=np.int64),
        *(np.zeros((periods, *shape)) for shape in shapes),
        joined(probed),
    )
    for k, (lockstep, sample) in zip(range(periods), periods_under_law(simulation, law, feed), strict=False):
        mounts = simulation.sample.mounts
        record.stamp[k] = simulation.time
        record.specific_force[k] = sample.chassis_force, sample.powertrain_force
        record.angular_velocity[k] = sample.chassis_angular_velocity, sample.powertrain_angular_velocity
        record.current[k] = lockstep.currents
        record.coil_current[k], record.deflection[k], record.force[k] = mounts.current, mounts.deflection, mounts.force
        probed[k] = simulation.sample.probed
    return record


def periods_under_law(simulation, law, feed=lambda: None, changes=()):
    """Yield the `Lockstep` and the law's `Sample` after each control period under a control law, without end.

    `feed()` is called before each period, to see to the road ahead. `changes` are those of the law's parameters in
    their order: the last stamp [ns] that the law answers with the old ones, and the new values by name. Raises as
    `run_closed_loop` does, and `ParameterError` for a change that the law cannot take.
    """
    changes = deque(changes)
    lockstep = Lockstep(simulation.mounting.coils, simulation.settings.passive_current, (-np.inf, np.inf))
    readings = Readings(simulation)
    names = [sensor.name for sensor in simulation.sensors[: POWERTRAIN + 1]]
    run_law_on(law, simulation.mounting)
    while True:
        feed()
        simulation.advance(lockstep.currents)
        read = readings.take()
        vectors = (tuple(vector.tolist()) for name in names for vector in read[name])
        sample = Sample(simulation.time / NANO, *vectors)
        while changes and changes[0][0] < simulation.time:
            law = changed_law(law, changes.popleft()[1])
        lockstep.publish(simulation.time)
        lockstep.offer(simulation.time, answer(law, sample))
        yield lockstep, sample
