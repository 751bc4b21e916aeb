"""An environment of Gymnasium: currents of the MR mounts in, what the inertial sensors measure out, a control period a
step. It is the loop in one process, to the same bits as that of the nodes."""

from operator import index

import gymnasium
import numpy as np
from gymnasium.error import ResetNeeded
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.estimator import LARGEST_FORCE, LARGEST_RATE, MotionEstimator
from mr_mount_controller.node_base.suggestion import suggestion

from ..data import find_vehicle
from ..nodes.simulator_parameters import PARAMETERS, prepare
from ..numerics.units import NANO
from ..road.classes import CLASSES
from ..road.feeder import RoadFeeder
from ..road.iso8608 import Iso8608Road, Isotropic
from ..road_sources.road_file import find_road
from ..simulation.readings import Readings
from ..simulation.simulation import CHASSIS, HORIZON, POWERTRAIN, RunFailed
from ..vehicle.vehicle_file import read_vehicle
from .running_weighting import RunningWeighting

FAILED = -1e6  # (m/s^2)^2, reward of a step in which the run fails: less than all of an episode
CORNER = 0.5  # Hz, of the estimated velocities, as the laws have it
FASTEST = 100.0  # m/s
HIGHEST_SEED = 10**9
# parameters of the simulator node that an environment has, too
OF_THE_DRIVE = (
    "speed", "drive", "gears", "engine_speed", "engine_excitation", "track_phase", "passive_current", "physics_rate",
    "control_rate",
)  # fmt: skip
_VECTORS = 2 * ([LARGEST_FORCE] * 3 + [LARGEST_RATE] * 3)
_MOTION = 2 * [LARGEST_FORCE, FASTEST]


class MountsEnv(gymnasium.Env):
    """Choose the currents of the mounts so that the powertrain shakes least.

    Parameters
    ----------
    vehicle : str, optional
        A vehicle that comes with the package, or a vehicle file.
    road : str
        A class of ISO 8608, of which each episode has another road, or a file, which all episodes have.
    **parameters
        Those of the simulator node that say how it is driven, `OF_THE_DRIVE`: `speed` [m/s], `engine_speed` [r/min],
        `drive`, `passive_current` [A], `control_rate` [Hz] and others.

    Raises
    ------
    ValueError
        Vehicle, road or a parameter cannot be used, or the vehicle has no coils.

    Attributes
    ----------
    action_space : Box (coils,)
        -1 to 1, from the lowest to the highest current that driver and mounts can use.
    observation_space : Box (16 + coils,)
        Specific force [m/s^2] and angular velocity [rad/s] of the chassis, then of the powertrain, each x, y, z in body
        axes; of the powertrain, then of the chassis, vertical acceleration without gravity [m/s^2] and velocity [m/s]
        as the laws estimate them; the action before.
    """

    metadata = {"render_modes": []}

    def __init__(self, vehicle=None, road="E", render_mode=None, **parameters):
        if render_mode is not None:
            raise ValueError(f"render_mode is {render_mode!r}, accepted: None; `trackvib view` shows bags of runs")
        if unknown := parameters.keys() - set(OF_THE_DRIVE):
            meant = suggestion(min(unknown), OF_THE_DRIVE)
            known = f"known are {', '.join(OF_THE_DRIVE)}{meant}"
            raise ValueError(f"there is no parameter {', '.join(sorted(unknown))}; {known}")
        values = {each.name: each.check(parameters.get(each.name, each.default)) for each in PARAMETERS}
        path = find_vehicle(vehicle)
        # nobody asks for odometry, so its rate shall clash with no other
        values |= {"vehicle_file": str(path), "odometry_rate": values["control_rate"]}
        self._simulation, usable, _, _ = prepare(values)
        coils = self._simulation.mounting.coils
        if coils == 0:
            raise ValueError(f"vehicle {str(path)!r} has no mount with a coil, at least one is needed")
        self._lowest, self._span = usable[0], usable[1] - usable[0]
        self._tread = 2.0 * read_vehicle(path)[0].road_wheels.y
        self._class = road if road in CLASSES else None
        self._road = None if self._class else find_road(road, self._tread)
        self._passive = values["passive_current"]
        self._names = [self._simulation.sensors[row].name for row in (CHASSIS, POWERTRAIN)]
        self._period = self._simulation.settings.rates.period / NANO
        self._running = False
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (coils,), np.float32)
        self._limits = np.array(_VECTORS + _MOTION + coils * [1.0], np.float32)
        self.observation_space = gymnasium.spaces.Box(-self._limits, self._limits, dtype=np.float32)

    def action_of(self, current):
        """Return the action (coils,) that demands a current [A] of every coil."""
        return np.full(self.action_space.shape, 2.0 * (current - self._lowest) / self._span - 1.0, np.float32)

    def reset(self, *, seed=None, options=None):
        """Begin a run; its first sample is that after one period with the passive current.

        Parameters
        ----------
        seed : int, optional
            Of the generator that draws the seeds of roads.
        options : dict, optional
            `road_seed`, 0 to 1e9: the seed of this episode's road.

        Raises
        ------
        ValueError
            An option cannot be used.
        """
        super().reset(seed=seed)
        seed_of_road = self._road_seed(dict(options or {}))
        self._simulation.reset()
        road = self._road or Iso8608Road(self._class, seed_of_road, coherence=Isotropic(self._tread))
        self._feeder, self._readings = RoadFeeder(road, HORIZON), Readings(self._simulation)
        self._estimator = MotionEstimator(self._period, CORNER)
        self._weighting = RunningWeighting("Wk", 1.0 / self._period)
        self._action = self.action_of(self._passive)
        self._advance(np.full(self._action.shape, self._passive))
        self._running = True
        return self._observation, {**self._info(), "road_seed": seed_of_road}

    def step(self, action):
        """Do one control period with the currents that the action (coils,) demands.

        Actions beyond -1 to 1 are cut, as the driver does.

        Raises
        ------
        ValueError
            The action has another shape, or is not finite.
        ResetNeeded
            There is no run, or it has failed.
        """
        if not self._running:
            raise ResetNeeded("the run has not started or has failed, call reset() first")
        self._action = self._checked(action)
        try:
            self._advance(self._lowest + 0.5 * self._span * (self._action.astype(float) + 1.0))
        except RunFailed as failure:
            self._running = False
            return self._observation.copy(), FAILED, True, False, {**self._info(), "failure": str(failure)}
        return self._observation, -(self._weighted**2), False, False, self._info()

    def _checked(self, action):
        try:
            numbers = np.array(action, np.float32)
        except (TypeError, ValueError):
            raise ValueError(f"action is {action!r}, accepted: numbers from -1 to 1") from None
        if numbers.shape != self.action_space.shape:
            raise ValueError(f"action has shape {numbers.shape}, accepted: {self.action_space.shape}, one per coil")
        if not np.isfinite(numbers).all():
            raise ValueError(f"action is {action!r}, accepted: finite numbers from -1 to 1")
        return np.minimum(np.maximum(numbers, -1.0), 1.0)

    def _road_seed(self, options):
        given = options.pop("road_seed", None)
        if options:
            raise ValueError(f"there is no option {', '.join(map(repr, options))}; known is 'road_seed'")
        if given is None:
            return int(self.np_random.integers(HIGHEST_SEED, endpoint=True))
        try:
            seed = index(given)
        except TypeError:
            seed = -1
        if not 0 <= seed <= HIGHEST_SEED:
            raise ValueError(f"option 'road_seed' is {given!r}, accepted: a whole number from 0 to {HIGHEST_SEED}")
        return seed

    def _advance(self, currents):
        """Do a period with currents [A]; raises `RunFailed`."""
        simulation = self._simulation
        for start, spacing, heights in self._feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        simulation.advance(currents)
        read = self._readings.take()
        vectors = [vector.tolist() for name in self._names for vector in read[name]]
        motion = self._estimator.update(Sample(simulation.time / NANO, *vectors))
        self._weighted = self._weighting.update(vectors[2][2])
        observation = np.array([*vectors[0], *vectors[1], *vectors[2], *vectors[3], *motion, *self._action], np.float32)
        self._observation = np.minimum(np.maximum(observation, -self._limits), self._limits)

    def _info(self):
        """Simulated time [s], vertical acceleration of the powertrain under Wk [m/s^2], currents in the coils [A]."""
        return {
            "time": self._simulation.time / NANO,
            "weighted": self._weighted,
            "current": self._simulation.sample.mounts.current.copy(),
        }
