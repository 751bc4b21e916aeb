"""Velocities of bodies beside the differences of their poses."""

import numpy as np
import pytest
from mr_mount_controller.laws.passive import Passive
from scipy.spatial.transform import Rotation
from trackvib_sim.data import find_vehicle
from trackvib_sim.road.feeder import RoadFeeder
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.scene.poses import PoseReader
from trackvib_sim.simulation.closed_loop import periods_under_law
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import HORIZON, Simulation
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

pytestmark = pytest.mark.property

RATE = 10_000  # Hz, of the periods: within a millisecond blows on a tooth change the speed of a sprocket by more


@pytest.mark.slow(reason="drives a vehicle")
def test_velocities_are_those_of_the_poses():
    """Of every body, idlers on their tensioners among them, over one physics step of a drive on a rough road.

    A step takes the velocities at its end (semi-implicit Euler), however hard a blow within it is.
    """
    vehicle, _ = read_vehicle(find_vehicle())
    simulation = Simulation(vehicle, RunSettings(Operation(10.0, 1650.0, False, 0.25), Rates(control=RATE), 1.0))
    feeder, poses = RoadFeeder(Iso8608Road("E", 1), HORIZON), PoseReader(vehicle, simulation.system)

    def feed():
        for start, spacing, heights in feeder.patches(simulation.distance):
            simulation.road.add(start, spacing, *heights)

    loop, seen = periods_under_law(simulation, Passive(1.0 / RATE), feed), []
    for _ in range(2 * RATE):
        next(loop)
    for _ in range(2):
        next(loop)
        pose = poses.read(simulation.state)
        seen.append((pose.place.copy(), Rotation.from_quat(pose.attitude), *poses.velocities(simulation.state)))
    (place, turn, *_), (later, turned, velocity, turning) = seen
    np.testing.assert_allclose((later - place) * RATE, velocity, atol=0.002)  # m/s, beside 10
    rates = (turned * turn.inv()).as_rotvec() * RATE
    np.testing.assert_allclose(rates, turning, atol=0.001)  # rad/s, beside some 30 of the wheels
    assert np.abs(turning).max() > 20.0
