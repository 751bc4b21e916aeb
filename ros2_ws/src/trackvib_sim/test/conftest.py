"""What several test files share: the shipped vehicle, its records, and reproducible random states."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import settings
from scipy.spatial.transform import Rotation
from trackvib_sim.data import find_vehicle
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.rui.state import Loads, TreeState
from trackvib_sim.rui.sweeps.articulated import CutOffset, new_cuts, open_cuts
from trackvib_sim.rui.sweeps.cells import columns
from trackvib_sim.rui.sweeps.kinematics import new_motion, update_motion
from trackvib_sim.rui.sweeps.response import new_response
from trackvib_sim.rui.sweeps.riccati import solve_accelerations
from trackvib_sim.rui.sweeps.tree import new_rows, to_lanes
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import HORIZON, Simulation
from trackvib_sim.vehicle.body_tree import build_body_table
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import read_vehicle

# the first example of a test may load a kernel, which takes its time; nothing is kept between runs
settings.register_profile("unit", deadline=None, database=None)
settings.load_profile("unit")


@pytest.fixture(scope="session")
def vehicle():
    """The vehicle that comes with the package."""
    return read_vehicle(find_vehicle())[0]


@pytest.fixture(scope="session")
def table(vehicle):
    """Its bodies."""
    return build_body_table(vehicle)


@pytest.fixture(scope="session")
def system(vehicle):
    """Its system record at 10 m/s with the engine at rated speed."""
    return build_system(vehicle, Operation(10.0, 1650.0, False), 1e-4)


@pytest.fixture(scope="session")
def rows(table, system):
    """Row in the tree of each body's name."""
    return {body.name: row for body, row in zip(table, system.tree.row.tolist(), strict=True)}


@pytest.fixture(scope="session")
def changed(vehicle):
    """A function that returns the vehicle with some items of one section or body changed, unchecked."""

    def change(section, **items):
        if section in vehicle.bodies:
            bodies = vehicle.bodies | {section: vehicle.bodies[section].model_copy(update=items)}
            return vehicle.model_copy(update={"bodies": bodies})
        return vehicle.model_copy(update={section: getattr(vehicle, section).model_copy(update=items)})

    return change


@pytest.fixture(scope="session")
def easy_teeth(changed, vehicle):
    """The vehicle with teeth that pins enter freely and tracks that calm down: for tests of the code in which harsh
    impacts amplify or hide."""
    teeth = dict(teeth=16.0, pitch_excess=0.0, flank_angle=19.7, backlash=0.0011, height=0.045, corner_radius=0.02)
    easy = changed("sprocket_teeth", **teeth, stiffness=1.5e8, damping=1.2e4)
    tracks = vehicle.tracks.model_copy(update={"link_damping": 1.4e4, "pin_damping": 2.0})
    return easy.model_copy(update={"tracks": tracks})


@pytest.fixture(scope="session")
def random_state(table):
    """A function that returns a state of the vehicle in which everything turns and moves, in the order of its table."""

    def make(seed, hinge=0.3, speed=1.0):
        random, n = np.random.default_rng(seed), len(table)
        attitude = random.normal(size=(1, 4))
        state = TreeState(
            position=random.normal(size=(1, 3)),
            attitude=attitude / np.linalg.norm(attitude),
            velocity=speed * random.normal(size=(1, 3)),
            angular_velocity=speed * random.normal(size=(1, 3)),
            hinge=hinge * random.normal(size=n),
            hinge_rate=speed * random.normal(size=n),
        )
        state.hinge[0] = state.hinge_rate[0] = 0.0
        return state

    return make


@pytest.fixture(scope="session")
def random_loads(table):
    """A function that returns random loads on the vehicle's bodies, in the order of its table."""

    def make(seed, size=1e4):
        random, n = np.random.default_rng(seed), len(table)
        torque = size * random.normal(size=n)
        torque[0] = 0.0
        return Loads(size * random.normal(size=(n, 3)), size * random.normal(size=(n, 3)), torque, np.zeros(n))

    return make


@pytest.fixture(scope="session")
def moved():
    """A function that returns the motion record of a state in rows."""

    def move(tree, state):
        motion = new_motion(tree)
        update_motion(tree, state, motion)
        return motion

    return move


@pytest.fixture(scope="session")
def random_motion(system, random_state, moved):
    """A function that returns the vehicle's motion record in a random state."""
    return lambda seed: moved(system.tree, to_lanes(system.tree, random_state(seed)))


@pytest.fixture(scope="session")
def added():
    """A function that returns what a kernel has added to empty cuts, by row, and that it is loads and nothing else."""

    def look(cuts):
        everything = columns(cuts, 0, CutOffset.SIZE)
        known = everything[:, CutOffset.FORCE : CutOffset.TORQUE + 1]
        assert np.count_nonzero(everything) == np.count_nonzero(known)
        return Added(
            columns(cuts, CutOffset.FORCE, 3),
            columns(cuts, CutOffset.MOMENT, 3),
            columns(cuts, CutOffset.TORQUE, 1)[:, 0],
        )

    return look


class Added(NamedTuple):
    """Loads by row, moments about the bodies' origins."""

    force: np.ndarray
    moment: np.ndarray
    torque: np.ndarray


@pytest.fixture(scope="session")
def solved(moved):
    """A function that returns the records of both sweeps, for torques in rows; `load(motion, cuts)` may add loads."""

    def solve(tree, state, torques=None, load=None):
        motion, cuts, response = moved(tree, state), new_cuts(tree), new_response(tree)
        open_cuts(tree, motion, new_rows(tree) if torques is None else torques, cuts)
        if load is not None:
            load(motion, cuts)
        solve_accelerations(tree, motion, cuts, response)
        return motion, cuts, response

    return solve


@dataclass(frozen=True)
class Heights:
    """A road made of given functions of the distance [m], one a side."""

    left: object
    right: object
    spacing = 0.05  # m

    def heights(self, first, count):
        """Return the heights (2, count) of samples 0.05 m apart."""
        distance = 0.05 * np.arange(first, first + count)
        return np.stack((self.left(distance), self.right(distance)))


@pytest.fixture(scope="session")
def heights():
    """`Heights`."""
    return Heights


@pytest.fixture(scope="session")
def level():
    """A level road without end."""
    return Heights(np.zeros_like, np.zeros_like)


@pytest.fixture(scope="session")
def simulation(vehicle):
    """A function that returns a new simulation."""

    def make(speed=10.0, engine_speed=0.0, physics=10_000, imposed=False, phase=0.0, vehicle=vehicle, probes=()):
        operation = Operation(speed, engine_speed, imposed, phase)
        return Simulation(vehicle, RunSettings(operation, Rates(physics=physics), 1.0), probes)

    return make


@pytest.fixture(scope="session")
def drive():
    """A function `drive(simulation, road, periods)` that advances a simulation with 1 A and yields it each period."""

    def drive_on(simulation, road, periods):
        feeder = RoadFeeder(road, HORIZON)
        for _ in range(periods):
            for start, spacing, heights in feeder.patches(simulation.distance):
                simulation.road.add(start, spacing, *heights)
            simulation.advance(np.ones(2))
            yield simulation

    return drive_on


@pytest.fixture(scope="session")
def drifted():
    """A state after dt at constant speeds: `drifted(state, dt)`."""

    def drift(state, dt):
        turned = Rotation.from_rotvec(dt * state.angular_velocity) * Rotation.from_quat(
            state.attitude, scalar_first=True
        )
        return state._replace(
            position=state.position + dt * state.velocity,
            attitude=turned.as_quat(scalar_first=True),
            hinge=state.hinge + dt * state.hinge_rate,
        )

    return drift
