"""What several test files share: the shipped vehicle, its records, and reproducible random states."""

from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import settings
from scipy.spatial.transform import Rotation
from trackvib_sim.installed import default_vehicle_file
from trackvib_sim.road.store import Road
from trackvib_sim.rui.kinematics import new_motion, update_motion
from trackvib_sim.rui.loads import new_loads
from trackvib_sim.rui.riccati import new_sweep, solve_accelerations
from trackvib_sim.rui.tree import rest_state
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.body_tree import body_table
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import read_vehicle

# the first example of a test may load a kernel, which takes its time; nothing is kept between runs
settings.register_profile("unit", deadline=None, database=None)
settings.load_profile("unit")


@pytest.fixture(scope="session")
def vehicle():
    """The vehicle that comes with the package."""
    return read_vehicle(default_vehicle_file())[0]


@pytest.fixture(scope="session")
def table(vehicle):
    """Its bodies."""
    return body_table(vehicle)


@pytest.fixture(scope="session")
def rows(table):
    """Row in the tree of each body's name."""
    return {body.name: row for row, body in enumerate(table)}


@pytest.fixture(scope="session")
def system(vehicle):
    """Its system record at 10 m/s with the engine at rated speed."""
    return build_system(vehicle, Operation(10.0, 1650.0, False), 1e-4)


@pytest.fixture(scope="session")
def changed(vehicle):
    """A function that returns the vehicle with some items of one section changed, unchecked."""

    def change(section, **items):
        return vehicle.model_copy(update={section: getattr(vehicle, section).model_copy(update=items)})

    return change


@pytest.fixture(scope="session")
def level_road():
    """40 m of level road around the origin."""
    return Road(-400, 0.05, np.zeros((2, 801)))


@pytest.fixture(scope="session")
def random_state():
    """A function that returns a state of a tree in which everything turns and moves."""

    def make(tree, seed, hinge=0.3, speed=1.0):
        random = np.random.default_rng(seed)
        state = rest_state(tree)
        attitude = random.normal(size=4)
        state.attitude[:] = attitude / np.linalg.norm(attitude)
        state.position[:] = random.normal(size=3)
        state.velocity[:] = speed * random.normal(size=3)
        state.rate[:] = speed * random.normal(size=3)
        state.hinge[1:] = hinge * random.normal(size=len(tree.mass) - 1)
        state.hinge_rate[1:] = speed * random.normal(size=len(tree.mass) - 1)
        return state

    return make


@pytest.fixture(scope="session")
def random_loads():
    """A function that returns random loads on n bodies."""

    def make(n, seed, size=1e4):
        random = np.random.default_rng(seed)
        loads = new_loads(n)
        loads.force[:] = size * random.normal(size=(n, 3))
        loads.moment[:] = size * random.normal(size=(n, 3))
        loads.torque[1:] = size * random.normal(size=n - 1)
        return loads

    return make


@pytest.fixture(scope="session")
def moved():
    """A function that returns the motion record of a state."""

    def move(tree, state):
        motion = new_motion(len(tree.mass))
        update_motion(tree, state, motion)
        return motion

    return move


@pytest.fixture(scope="session")
def solved(moved):
    """A function that returns motion and sweep records of a state under loads."""

    def solve(tree, state, loads=None):
        motion, sweep = moved(tree, state), new_sweep(len(tree.mass))
        solve_accelerations(tree, state, motion, loads or new_loads(len(tree.mass)), sweep)
        return motion, sweep

    return solve


@dataclass(frozen=True)
class Heights:
    """A road made of given functions of the distance [m], one a side."""

    left: object
    right: object

    def heights(self, first, count):
        """Return the heights (2, count) of samples 0.05 m apart."""
        distance = 0.05 * np.arange(first, first + count)
        return np.stack((self.left(distance), self.right(distance)))


@pytest.fixture(scope="session")
def level():
    """A level road without end."""
    return Heights(np.zeros_like, np.zeros_like)


@pytest.fixture(scope="session")
def simulation(vehicle):
    """A function that returns a new simulation."""

    def make(speed=10.0, engine_speed=0.0, physics=10_000, imposed=False, vehicle=vehicle):
        operation = Operation(speed, engine_speed, imposed)
        return Simulation(vehicle, RunSettings(operation, Rates(physics=physics), 1.0))

    return make


@pytest.fixture(scope="session")
def drifted():
    """The state of a tree after dt at constant speeds: `drifted(state, dt)`."""

    def drift(state, dt):
        turned = Rotation.from_rotvec(dt * state.rate) * Rotation.from_quat(state.attitude, scalar_first=True)
        return state._replace(
            position=state.position + dt * state.velocity,
            attitude=turned.as_quat(scalar_first=True),
            hinge=state.hinge + dt * state.hinge_rate,
        )

    return drift
