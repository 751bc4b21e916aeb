"""The vehicle in motion: holds system, state and road, and advances one control period at a time."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..numerics.units import NANO
from ..road.store import Road, RoadStore
from ..rui.sweeps.cells import copy_cells
from ..vehicle.drive.command import curvature_of
from ..vehicle.mounting import mounting_of
from ..vehicle.parameters import Vehicle
from ..vehicle.sensors import sensors_of
from ..vehicle.system import body_rows, build_system, new_work
from .kept_run_in import run_in
from .sensing import points_of
from .settings import RunSettings
from .step import REASONS, Rows, Status, control_periods, new_sample, observe, one_row

CHASSIS, POWERTRAIN = 0, 1  # rows of the sample
HORIZON = 50.0  # m of road that a run in one process keeps ahead of the vehicle


class Probe(NamedTuple):
    """A further point whose acceleration is measured without errors, at every physics step.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> tv.Probe("turret", (0.0, 0.0, 0.5)).body
    'turret'
    """

    body: str  # name in the body table
    place: tuple  # in the body's axes, from its origin, m


class RunFailed(RuntimeError):
    """The state left the valid range of the model; the message says when.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> issubclass(tv.RunFailed, RuntimeError)
    True
    """


class Simulation:
    """A vehicle that rolls in static equilibrium until it is advanced.

    Attributes
    ----------
    sensors : list of vehicle.sensors.Sensor
    sample : step.Sample
        Of the last control period, one row per sensor, `CHASSIS` and `POWERTRAIN` first. Before the first period
        nothing is measured, only its state is filled.
    mounting : mr_mount_controller.mounting.Mounting
        The mounts in the order of the sample, and the number of coils.
    state : vehicle.system.State
    road : road.store.RoadStore
        To be filled by the caller, as far ahead as `road_is_enough` requires.
    road_at_hand : road.store.Road or None
        The part used for the last period, None before the first one.
    periods : int
        Control periods done.

    Examples
    --------
    >>> import trackvib_sim as tv
    >>> vehicle, _ = tv.read_vehicle(tv.find_vehicle())
    >>> settings = tv.RunSettings(tv.Operation(10.0, 1650.0, False), tv.Rates(), passive_current=1.0)
    >>> simulation = tv.Simulation(vehicle, settings)
    >>> simulation.sample.mounts.current  # by coil, A
    array([1., 1.])
    """

    def __init__(self, vehicle: Vehicle, settings: RunSettings, probes: Sequence[Probe] = ()):
        self.settings = settings
        self.system = build_system(vehicle, settings.operation, 1.0 / settings.rates.physics)
        self._initial = run_in(vehicle, self.system, settings)
        self.sensors = sensors_of(vehicle)
        self.mounting = mounting_of(vehicle)
        self.points = points_of(self.sensors, probes, body_rows(vehicle, self.system.tree), settings.rates)
        self._reach = self.system.drive.reach
        self._fastest = max(self.system.drive.schedule.speed, key=abs)
        self._expected = []
        self.reset()

    def reset(self):
        """Restart: time zero, the initial state of every run, no road."""
        self._held = self._statuses = None  # the road that the generator of control periods was made with, and itself
        self.road_at_hand = None
        self.state = copy_cells(self._initial)
        self.road = RoadStore()
        self.periods = 0
        self.points.started[:] = False
        steps = self.settings.rates.steps
        self.sample, self._next = (new_sample(self.points, steps, self.system.mounts) for _ in range(2))
        self._work, self._single = new_work(self.system), one_row(self.sample)
        self._demanded = np.zeros(self.mounting.coils)
        observe(self.system, self.state, self._work.motion, self.sample)

    def load(self):
        """Load the compiled periods: that takes a tenth of a second, by which the first would be late in real time."""
        nowhere, none = Road(0, 1.0, np.zeros((2, 2))), self._single._replace(wanted=np.zeros(1, int))
        next(self._periods(nowhere, none))

    @property
    def time(self) -> int:
        """Simulated time at the end of the last period [ns]."""
        return self.periods * self.settings.rates.period

    @property
    def distance(self) -> float:
        """Distance of the hull's origin along the road [m]."""
        return float(self.state.drive.path.distance[0])

    def road_is_enough(self) -> bool:
        """Return whether the next period can be done with the road at hand."""
        return self._road_around(1) is not None

    def command(self, speed: float, yaw_rate: float):
        """Demand a speed [m/s] and yaw rate [rad/s, to the left] from the next period, regardless of the schedule.

        The path ahead of the vehicle's front takes the curvature yaw_rate / speed.

        Raises
        ------
        ValueError
            A tracked vehicle cannot be steered by them.
        """
        self.state.drive.wanted.command[:] = speed, curvature_of(speed, yaw_rate)
        self.state.drive.wanted.commanded[0] = True

    def expect(self, commands):
        """Take commands, each a time [ns], speed [m/s] and yaw rate [rad/s], when their time has come.

        Those at times before the first period that is done are in force from it on. Raises as `command` does.
        """
        for _, speed, yaw_rate in commands:
            curvature_of(speed, yaw_rate)
        self._expected = sorted(commands, key=lambda command: command[0])

    def advance(self, demanded):
        """Do one control period with the demanded current of each coil [A].

        Raises
        ------
        RunFailed
            The state left what the model can describe. `sample` is still the last good one.
        """
        while self._expected and self._expected[0][0] <= self.time:
            self.command(*self._expected.pop(0)[1:])
        self.road_at_hand = self._road_around(1)
        if self.road_at_hand is not self._held:
            self._statuses, self._held = self._periods(self.road_at_hand, self._single), self.road_at_hand
        self._do_periods(self._statuses, demanded, self._single)

    def _periods(self, road, rows):
        """Hand all records to the kernel."""
        steps, samples = self.settings.rates.steps, (self._next, self.sample)
        return control_periods(
            self.system, self.state, road, self._demanded, steps, self._work, self.points, *samples, rows
        )

    def _do_periods(self, statuses, demanded, rows):
        self._demanded[:] = demanded
        status = next(statuses)
        self._end_periods(status, int(rows.done[0]))

    def advance_many(self, demanded, force, probed, speed):
        """Do a control period for each row of `force` (k, m, 3) [m/s^2], `probed` and `speed` (k,) [m/s].

        They are filled with the sensors' specific forces, those of the probes (k, steps, p, 3) at every physics step,
        and the hull's speed along its own x axis. Raises as `advance` does, with the rows before the failure filled.
        """
        self.road_at_hand = self._road_around(len(force))
        rows = Rows(np.array([len(speed)]), np.zeros(1, int), force, probed, speed)
        self._do_periods(self._periods(self.road_at_hand, rows), demanded, rows)
        self._held = None  # the samples may lie the other way round now

    def _end_periods(self, status, done):
        self.periods += done
        if done % 2:
            self.sample, self._next = self._next, self.sample
        if status != Status.GOOD:
            raise RunFailed(f"{REASONS[status]} after t = {self.time / NANO:.3f} s")

    def _road_around(self, periods):
        way = 1.5 * periods * self._fastest / self.settings.rates.control
        rear, front = self.distance - self._reach, self.distance + self._reach
        return self.road.around(rear + min(way, 0.0), front + max(way, 0.0))
