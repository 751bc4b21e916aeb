# the vehicle
from .data import find_vehicle as find_vehicle
from .data import vehicle_names as vehicle_names
from .vehicle.parameters import Vehicle as Vehicle
from .vehicle.step_size import recommended_rate as recommended_rate
from .vehicle.sensors import Instrument as Instrument
from .vehicle.sensors import Sensor as Sensor
from .vehicle.drive.schedule import Schedule as Schedule
from .vehicle.system import Operation as Operation
from .vehicle.vehicle_file import VehicleFileError as VehicleFileError
from .vehicle.vehicle_file import read_vehicle as read_vehicle

# roads
from .road.bump import Bump as Bump
from .road.obstacles import LevelRoad as LevelRoad
from .road.obstacles import ObstacleRoad as ObstacleRoad
from .road.obstacles import Step as Step
from .road.profile import Profile as Profile
from .road.profile import ProfileRoad as ProfileRoad
from .road_sources.road_file import find_road as find_road
from .road.iso8608 import Exponential as Exponential
from .road.iso8608 import Iso8608Road as Iso8608Road
from .road.iso8608 import Isotropic as Isotropic
from .road.iso8608 import Roughness as Roughness
from .road.iso8608 import roughness_of as roughness_of

# simulation; control laws come from `mr_mount_controller.laws`
from .simulation.closed_loop import Record as Record
from .simulation.closed_loop import run_closed_loop as run_closed_loop
from .simulation.open_loop import OpenLoopRecord as OpenLoopRecord
from .simulation.open_loop import run_open_loop as run_open_loop
from .simulation.running_gear import MeasuredKind as MeasuredKind
from .simulation.running_gear import RunningGear as RunningGear
from .simulation.settings import Rates as Rates
from .simulation.settings import RunSettings as RunSettings
from .simulation.simulation import Probe as Probe
from .simulation.simulation import RunFailed as RunFailed
from .simulation.simulation import Simulation as Simulation

# bags, and what they say
from .bags.errors import BagError as BagError
from .bags.reading import read_recording as read_recording
from .bags.recording import Recording as Recording
from .analysis.analyse import analyse as analyse
from .analysis.numbers import Analysis as Analysis

# the method
from . import rui as rui
