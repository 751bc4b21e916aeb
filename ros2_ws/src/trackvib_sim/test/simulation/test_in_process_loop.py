"""The closed loop in one process: reproducible, and measured as real sensors would."""

import numpy as np
import pytest
from mr_mount_controller.laws.passive import Passive
from mr_mount_controller.laws.skyhook import Skyhook
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.rui.sweeps.kinematics import new_motion, point_place, point_velocity, rotation, update_motion
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.open_loop import run_open_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import CHASSIS, POWERTRAIN, RunFailed, Simulation
from trackvib_sim.vehicle.parameters import SensorParameters
from trackvib_sim.vehicle.sensors import sensors_of
from trackvib_sim.vehicle.system import Operation

PERIOD = 1e-3


@pytest.fixture(scope="module")
def rough():
    """A class E road that begins under the vehicle."""
    return Iso8608Road("E", 1, 4.0, 8.0)


@pytest.fixture(scope="module")
def run(simulation, rough):
    """A function that runs 10 m/s on the rough road with the engine at rated speed."""

    def do(periods, law=Passive):
        return run_closed_loop(simulation(10.0, 1650.0), rough, law(PERIOD), periods)

    return do


@pytest.fixture(scope="module")
def reference(run):
    """Four seconds under the passive law."""
    return run(4000)


@pytest.mark.property
@pytest.mark.parametrize("law", [Passive, Skyhook])
def test_same_run_gives_the_same_bits(run, law):
    """A run done twice is identical to the last bit."""
    first, second = run(500, law), run(500, law)
    for a, b in zip(first, second, strict=True):
        assert a.tobytes() == b.tobytes()


@pytest.mark.property
def test_law_closes_the_loop(run):
    """A law that switches the current changes the motion of the powertrain."""
    passive, skyhook = run(1500), run(1500, Skyhook)
    assert len(np.unique(skyhook.current)) == 2
    assert np.abs(passive.specific_force - skyhook.specific_force)[:, POWERTRAIN].max() > 0.1


@pytest.mark.analytic
def test_mean_vertical_specific_force_is_gravity(reference):
    """Over four seconds both sensors feel g upwards on the mean.

    The mean differs from g by the change of vertical velocity over the time (at most some 0.4 m/s over 4 s), and by
    tilts of up to 0.03 rad: 0.03^2 / 2 of g, and 0.03 times longitudinal forces of some 1 m/s^2 on the mean.
    """
    mean = reference.specific_force[:, :, 2].mean(axis=0)
    assert_allclose(mean, 9.81, atol=0.1 + 0.005 + 0.03)


@pytest.mark.analytic
def test_stamps_are_exact(reference):
    """Stamps are whole milliseconds in nanoseconds, from the end of the first period on, none missing."""
    assert reference.stamp.tolist() == [1_000_000 * (k + 1) for k in range(4000)]
    assert (reference.current == 1.0).all()


@pytest.mark.slow(reason="seconds of the vehicle")
@pytest.mark.analytic
def test_sensors_are_those_of_an_inertial_navigator(simulation, rough, easy_teeth):
    """From the first state on, integrating the sensors' readings gives attitude and velocity of their points.

    Read at every physics step and without a low-pass, they are what the integrator has used: only the order in which
    force and attitude change within a step is left, below 1e-5 rad and 5e-3 m/s within a second.
    """
    wide = {
        sensor.name: SensorParameters.model_construct(body=sensor.body, place=list(sensor.place), bandwidth=1e6)
        for sensor in sensors_of(easy_teeth)
    }
    rates = Rates(physics=10_000, control=10_000)
    settings, period = RunSettings(Operation(10.0, 1650.0, False), rates, 1.0), 1.0 / rates.control
    moving = Simulation(easy_teeth.model_copy(update={"sensors": wide}), settings)
    for start in range(0, 1000, 100):
        moving.road.add(0.05 * (start - 400), 0.05, *rough.heights(start - 400, 100))
    motion = new_motion(moving.system.tree)

    def truth():
        update_motion(moving.system.tree, moving.state.tree, motion)
        turns, velocities = [], []
        for body, place in zip(moving.points.body, moving.points.place, strict=True):
            turns.append(Rotation.from_matrix(np.reshape(rotation(motion, body), (3, 3))))
            velocities.append(point_velocity(motion, body, point_place(motion, body, tuple(place))))
        return turns, np.array(velocities)

    turns, velocity = truth()
    for _ in range(rates.control):
        moving.advance(np.ones(2))
        for sensor in (CHASSIS, POWERTRAIN):
            step = Rotation.from_rotvec(period * moving.sample.angular_velocity[sensor])
            force = turns[sensor].apply(moving.sample.specific_force[sensor])
            velocity[sensor] += period * (force + (0.0, 0.0, -9.81))
            turns[sensor] = turns[sensor] * step
    expected_turns, expected_velocity = truth()
    for got, expected in zip(turns, expected_turns, strict=True):
        assert (got * expected.inv()).magnitude() < 1e-5
    assert_allclose(velocity, expected_velocity, atol=5e-3)
    assert np.abs(expected_velocity[:, 2]).max() > 0.02


@pytest.mark.slow(reason="seconds of the vehicle with its engine")
@pytest.mark.analytic
@pytest.mark.parametrize("imposed", [False, True])
def test_standing_vehicle_vibrates_in_the_engines_orders(simulation, level, imposed):
    """At 1500 r/min a standing vehicle's powertrain vibrates at orders 2, 3 and 6: 50, 75 and 150 Hz.

    With the imposed displacement it is order 2 alone. Geometry makes sums and differences of the orders, too, with
    amplitudes of microns over a metre; they and what is left of the start, when the vehicle still swings on its
    tracks, are below a thousandth of the power after 20 s.
    """
    standing = simulation(0.0, 1500.0, imposed=imposed)
    vertical = run_open_loop(standing, level, 22_000).specific_force[-2000:, POWERTRAIN, 2]
    power = np.abs(np.fft.rfft(vertical - vertical.mean())) ** 2
    orders = [100] if imposed else [100, 150, 300]  # bins of 0.5 Hz
    assert power[orders].min() > 1e-5 * power.sum()
    assert power[orders].sum() > 0.999 * power.sum()


@pytest.mark.property
@pytest.mark.parametrize("part", ["position", "attitude", "velocity", "angular_velocity", "hinge", "hinge_rate"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_state_that_is_not_finite_stops_the_run(simulation, level, rows, part, value):
    """A run whose state breaks stops with the time of its last good sample, and counts no further period."""
    broken = simulation(0.0)
    broken.road.add(-20.0, 0.05, *level.heights(-400, 801))
    broken.advance(np.ones(2))
    getattr(broken.state.tree, part).flat[rows["turret"] if part.startswith("hinge") else 1] = value
    with pytest.raises(RunFailed, match=r"no longer finite after t = 0\.001 s"):
        broken.advance(np.ones(2))
    assert broken.periods == 1


@pytest.mark.property
def test_simulation_asks_for_the_road_it_needs(simulation, level):
    """Without road under every wheel and a look ahead, a simulation says so."""
    waiting = simulation(10.0)
    assert not waiting.road_is_enough()
    waiting.road.add(-5.0, 0.05, *level.heights(-100, 100))
    assert not waiting.road_is_enough()
    waiting.road.add(0.0, 0.05, *level.heights(0, 100))
    assert waiting.road_is_enough()
    assert waiting.distance == 0.0 and waiting.time == 0
