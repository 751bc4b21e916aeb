"""What an FMU does where it runs: coil currents in, what sensors and mounts tell out, a control period at a time."""

from copy import deepcopy
from itertools import product
from math import isfinite

import numpy as np
from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.enums import Fmi2Status

from ..nodes.simulator_parameters import simulation_of
from ..numerics.units import NANO
from ..road.feeder import RoadFeeder
from ..road_sources.road_file import find_road
from ..simulation.readings import Readings
from ..simulation.simulation import HORIZON, RunFailed
from ..vehicle.vehicle_file import parse_vehicle

AXES = "xyz"
IMU = {"linear_acceleration": "specific force, sensor axes [m/s^2]", "angular_velocity": "sensor axes [rad/s]"}
MOUNT = {
    "current": "in the coil [A]",
    "stiffness": "vertical [N/m]",
    "damping": "vertical [N s/m]",
    "deflection": "of the upper end from the lower one, hull axes [m]",
    "velocity": "rate of deflection [m/s]",
    "force": "on the body that it carries, hull axes [N]",
    "dissipated_power": "turned into heat [W]",
}
_NEAR = 1e-6  # of a control period, by which a step may miss a whole number of them


class VehicleSlave(Fmi2Slave):
    """A vehicle on its road, built when it is instantiated.

    Attributes
    ----------
    told : dict
        Set by the module in the FMU: texts of vehicle and drive, road, seed, values of the simulator's parameters.
    kept : list
        What that module keeps from being freed.

    Raises
    ------
    ParameterError, VehicleFileError, RoadError
        It cannot be built.
    """

    told, kept = None, []
    license, author = "Apache-2.0", "trackvib"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        vehicle = parse_vehicle(self.told["vehicle"], "the FMU's vehicle")
        simulation = self._simulation = simulation_of(vehicle, self.told["values"], self.told["drive"])
        road = find_road(self.told["road"], 2.0 * vehicle.road_wheels.y, self.told["seed"])
        self._feeder, self._readings = RoadFeeder(road, HORIZON), Readings(simulation)
        self._currents = np.full(simulation.mounting.coils, simulation.settings.passive_current)
        self._read = {sensor.name: np.zeros((2, 3)) for sensor in simulation.sensors}
        self.description = self.told["title"]
        self.default_experiment = DefaultExperiment(
            start_time=0.0, stop_time=10.0, step_size=simulation.settings.rates.period / NANO
        )
        self._register_inputs()
        self._register_outputs()

    def _register_inputs(self):
        for i, name in enumerate(self._simulation.mounting.names[: self._currents.size]):
            self.register_variable(
                Real(
                    f"coil_current.{name}",
                    causality=Fmi2Causality.input,
                    variability=Fmi2Variability.continuous,
                    description="demanded current [A]",
                    getter=lambda i=i: self._currents[i],
                    setter=lambda value, i=i: self._currents.__setitem__(i, value),
                ),
                nested=False,
            )

    def _register_outputs(self):
        simulation = self._simulation
        for sensor in self._read:
            for (row, (quantity, words)), (k, axis) in product(enumerate(IMU.items()), enumerate(AXES)):
                self._output(f"{sensor}.{quantity}.{axis}", words, lambda s=sensor, row=row, k=k: self._read[s][row, k])
        for quantity, words in MOUNT.items():
            values = getattr(simulation.sample.mounts, quantity)
            for i, name in enumerate(simulation.mounting.names[: len(values)]):
                for k in np.ndindex(values.shape[1:]):
                    at = ".".join((f"mount_state.{name}.{quantity}", *(AXES[axis] for axis in k)))
                    self._output(at, words, lambda q=quantity, i=i, k=k: getattr(simulation.sample.mounts, q)[(i, *k)])
        self._output("hull.speed", "along its own x axis [m/s]", lambda: simulation.sample.hull_velocity[0, 0])
        self._output("hull.distance", "of its origin along the path [m]", lambda: simulation.distance)

    def _output(self, name, words, getter):
        variable = Real(
            name,
            causality=Fmi2Causality.output,
            variability=Fmi2Variability.continuous,
            description=words,
            getter=getter,
        )
        self.register_variable(variable, nested=False)

    def to_xml(self, *options):
        """The FMU's description; the standard asks for the outputs among the initial unknowns, too."""
        root = super().to_xml(*options)
        structure = root.find("ModelStructure")
        structure.append(deepcopy(structure.find("Outputs")))
        structure[-1].tag = "InitialUnknowns"
        return root

    def do_step(self, current_time, step_size):
        """Advance by `step_size` [s], whole control periods, under the currents; returns whether it could be done."""
        wanted = step_size * self._simulation.settings.rates.control
        periods = round(wanted)
        if periods < 1 or abs(wanted - periods) > _NEAR:
            period = self._simulation.settings.rates.period / NANO
            return self._refuse(f"step is {step_size:g} s, accepted: multiples of the control period, {period:g} s")
        if not all(map(isfinite, self._currents)):
            return self._refuse(f"coil_current is {self._currents.tolist()}, must be finite")
        try:
            for _ in range(periods):
                self._advance()
        except RunFailed as failure:
            return self._refuse(f"run failed: {failure}")
        return True

    def _advance(self):
        simulation = self._simulation
        for start, spacing, heights in self._feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)
        simulation.advance(self._currents)
        for sensor, reading in self._readings.take().items():
            self._read[sensor][:] = reading

    def _refuse(self, words):
        self.log(words, Fmi2Status.error)
        return False
