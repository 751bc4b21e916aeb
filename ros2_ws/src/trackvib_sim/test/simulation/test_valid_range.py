"""Runs that leave what the model can describe, and how a run starts."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.run_in import CannotRoll
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import RunFailed, Simulation
from trackvib_sim.simulation.step import LONGEST_FLIGHT
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.tracks.layout import sink
from trackvib_sim.vehicle.tracks.nodes import STRIDE, NodeOffset
from trackvib_sim.vehicle.tracks.wheels import LOWER_RUN

pytestmark = pytest.mark.property


def throw(simulation, height, roll=0.0):
    """Lift a standing vehicle with its tracks by a height [m] and turn both about the x axis by an angle [rad]."""
    turn, tree = Rotation.from_euler("x", roll), simulation.state.tree
    up = np.array([0.0, 0.0, height])
    nodes = simulation.state.tracks.nodes.reshape(2, -1, STRIDE)
    for quantity, shift in ((NodeOffset.PLACE, up), (NodeOffset.VELOCITY, 0.0)):
        vectors = nodes[:, quantity : quantity + 3]
        vectors[:] = np.moveaxis(turn.apply(np.moveaxis(vectors, 1, 2).reshape(-1, 3)).reshape(2, STRIDE, 3), 2, 1)
        vectors += np.reshape(shift, (-1, 1))
    tree.position[:] = turn.apply(tree.position) + up
    tree.velocity[:], tree.angular_velocity[:] = turn.apply(tree.velocity), turn.apply(tree.angular_velocity)
    attitude = turn * Rotation.from_quat(tree.attitude, scalar_first=True)
    tree.attitude[:] = attitude.as_quat(scalar_first=True)


@pytest.mark.parametrize("roll", [1.25, -1.25, 3.0])
def test_a_vehicle_on_its_side_has_overturned(simulation, level, roll, drive):
    """Tilted by more than 1.2 rad the vehicle has overturned; short of that, in the air, it goes on."""
    fallen, leaning = simulation(speed=0.0), simulation(speed=0.0)
    throw(fallen, 5.0, roll)
    with pytest.raises(RunFailed, match=r"^the vehicle has overturned after t = 0\.000 s$"):
        list(drive(fallen, level, 1))
    throw(leaning, 5.0, np.copysign(1.15, roll))
    assert [each.periods for each in drive(leaning, level, 10)] == list(range(1, 11))


def test_a_long_flight_ends_a_run(simulation, level, drive):
    """Without a shoe on the ground for longer than the limit the run fails, its last sample is that of free fall."""
    flying = simulation(speed=0.0)
    throw(flying, 20.0)
    with pytest.raises(RunFailed, match=r"^no shoe has touched the ground for 1 s after t = 1\.000 s$"):
        list(drive(flying, level, 2000))
    assert flying.periods == 1000 * LONGEST_FLIGHT
    # it swings on its springs, that have nothing to carry, by some cm
    assert np.abs(flying.sample.specific_force).max() < 9.81


def test_a_short_flight_does_not(simulation, level, drive):
    """A vehicle that drops by 0.5 m lands within 0.3 s, for its wheels hang lower; then its flight counts no more."""
    dropped, flight = simulation(speed=0.0), []
    throw(dropped, 0.5)
    for each in drive(dropped, level, 600):
        flight.append(each.state.flight[0])
    assert 0.2 < max(flight) < 0.3
    assert flight[-1] == 0.0


def test_a_wheel_below_the_road_ends_a_run(simulation, heights):
    """Where the road lies above a road wheel's hub on one side alone, the run fails."""
    lost = simulation(speed=0.0)
    lost.road.add(-20.0, 0.05, *heights(lambda x: 0.0 * x, lambda x: 0.0 * x + 0.6).heights(-400, 801))
    with pytest.raises(RunFailed, match=r"^a road wheel lies below the road after t = 0\.000 s$"):
        lost.advance(np.ones(2))


@pytest.mark.parametrize("teeth", [1, -1, 4])
def test_a_skipped_tooth_ends_a_run(simulation, level, drive, teeth):
    """A sprocket that stands teeth ahead of its pins, or behind them, has been skipped, although no force differs."""
    jumped = simulation(10.0)
    sprockets = jumped.system.tracks.sprockets
    jumped.state.tree.hinge[sprockets.row[1]] += teeth * 2.0 * np.pi / sprockets.teeth
    with pytest.raises(RunFailed, match=r"^a track has skipped a tooth of its sprocket after t = 0\.000 s$"):
        list(drive(jumped, level, 1))


def test_failure_keeps_the_last_sample(simulation, drive):
    """Class H at 25 m/s is beyond the vehicle: the run fails by name and time and keeps its last sample."""
    thrown = simulation(25.0)
    ways = "overturned|below the road|ground for 1 s|skipped a tooth of its sprocket"
    with pytest.raises(RunFailed, match=rf"({ways}) after t = \d+\.\d{{3}} s"):
        for _ in drive(thrown, Iso8608Road("H", 1, 8.0, 8.0), 20_000):
            before = [part.copy() for part in (thrown.sample.specific_force, thrown.sample.angular_velocity)]
    assert np.isfinite(before).all()
    np.testing.assert_array_equal(thrown.sample.specific_force, before[0])
    np.testing.assert_array_equal(thrown.sample.angular_velocity, before[1])


def test_a_vehicle_that_cannot_roll_is_refused(changed, simulation):
    """Where the ground neither carries nor damps, the vehicle does not survive its run-in and no run begins."""
    with pytest.raises(CannotRoll, match="^the vehicle cannot roll at 5 m/s on a level road: a road wheel lies below"):
        simulation(5.0, vehicle=changed("ground", stiffness=1e3, damping=0.0))


@pytest.mark.parametrize("speed", [0.0, 5.0, 10.0, 20.0])
def test_vehicle_is_already_rolling(simulation, level, speed, drive):
    """On a level road the vehicle has its speed from the start: the first second's mean is right to 0.5 %."""
    speeds = [each.sample.hull_velocity[0, 0] for each in drive(simulation(speed), level, 1000)]
    assert np.mean(speeds) == pytest.approx(speed, rel=5e-3, abs=1e-3)


@pytest.mark.parametrize("speed", [5.0, 20.0])
def test_road_wheels_are_already_turning(simulation, vehicle, level, speed, drive):
    """In the first tenths of a second every road wheel turns at speed over loaded radius.

    To 3 %, by which one turns slower that carries nothing.
    """
    moving, rate = simulation(speed), []
    road_wheels = moving.system.tracks.wheels.row[moving.system.tracks.wheels.run == LOWER_RUN]
    for each in drive(moving, level, 400):
        rate.append(each.state.tree.hinge_rate[road_wheels])
    loaded = vehicle.road_wheels.radius - sink(vehicle)
    np.testing.assert_allclose(np.mean(rate, axis=0) * loaded, moving.distance / 0.4, rtol=0.03)


def test_road_is_asked_for_as_far_as_a_slow_loop_goes(vehicle, level):
    """At ten periods a second, 2.5 m of road go by in one; the track never lies beyond what is held."""
    settings = RunSettings(Operation(25.0, 0.0, False), Rates(control=10, odometry=10), 1.0)
    moving = Simulation(vehicle, settings)
    moving.road.add(-20.0, 0.05, *level.heights(-400, 600))  # up to 9.95 m
    front = vehicle.idlers.x + vehicle.tensioners.travel + vehicle.idlers.radius
    while moving.road_is_enough():
        moving.advance(np.ones(2))
        assert moving.distance + front < 9.95
    assert moving.periods > 0
