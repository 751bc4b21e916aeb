"""What the controller's laws know of the vehicle agrees with the vehicle file, and each law closes the loop."""

import numpy as np
import pytest
from mr_mount_controller import mount
from mr_mount_controller.laws import find_law, mount_model, shipped_laws
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.engine_speed import ORDERS, SPEEDS, EngineSpeedEstimator
from mr_mount_controller.laws.passive import Passive
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.vehicle.mount_law import mount_characteristics

PERIOD = 1e-3


@pytest.fixture(scope="module")
def rough():
    """A class E road that begins under the vehicle."""
    return Iso8608Road("E", 1, 4.0, 8.0)


@pytest.mark.golden
def test_controller_knows_the_mounts(vehicle, system):
    """Its k(I) and c(I) are the simulator's at every current, those out of range included, to rounding."""
    for current in np.linspace(0.0, 5.0, 101):
        k, c = mount_characteristics(system.mounts, 0, float(current))
        assert mount.stiffness(current) == pytest.approx(k, rel=1e-12)
        assert mount.damping(current) == pytest.approx(c, rel=1e-12)
    assert tuple(vehicle.mount_types["mr"].current_range) == (mount.LOWEST_CURRENT, mount.HIGHEST_CURRENT)
    assert vehicle.coil.time_constant == mount.COIL_LAG


@pytest.mark.golden
def test_controller_knows_the_powertrain(vehicle):
    """The model that laws are designed on is the shipped vehicle to 2 % and 5 mm, as near as a controller needs it."""
    v, p, model = vehicle, vehicle.powertrain, mount_model
    arms, shocks = v.swing_arms, v.shock_absorbers
    for known, true in (
        (model.HULL_MASS, v.hull.mass + sum(body.mass for body in v.bodies.values())),
        (model.SUSPENSION_STIFFNESS, 12.0 * arms.wheel_rate[0]),
        (model.SUSPENSION_DAMPING, 12.0 * arms.friction[0] + 2.0 * sum(shocks.damping)),
        (model.POWERTRAIN_MASS, p.mass),
        (model.POWERTRAIN_INERTIA, p.inertia[1]),
        (model.HINGE_STIFFNESS, p.stiffness),
    ):
        assert known == pytest.approx(true, rel=0.02)
    assert (p.centre[0], p.centre[2]) == pytest.approx(model.CENTRE, abs=5e-3)
    assert (v.mounts["left"].place[0], v.mounts["left"].place[2]) == pytest.approx(model.MOUNTS, abs=5e-3)
    assert set(ORDERS) == set(v.engine.orders)
    assert SPEEDS[0] < v.engine.speed_range[0] and SPEEDS[-1] > v.engine.speed_range[1]


@pytest.mark.slow(reason="drives under every law")
@pytest.mark.property
@pytest.mark.parametrize("name", shipped_laws())
def test_law_closes_the_loop(simulation, rough, name):
    """On a rough road each law acts, the same twice to the last bit, within the currents that mounts can use."""
    first, second = (run_closed_loop(simulation(10.0, 1650.0), rough, find_law(name)(PERIOD), 2000) for _ in range(2))
    assert all(a.tobytes() == b.tobytes() for a, b in zip(first, second, strict=True))
    assert first.current.min() >= mount.LOWEST_CURRENT and first.current.max() <= mount.HIGHEST_CURRENT
    assert len(np.unique(first.current)) > 1 or name == "passive"


@pytest.mark.property
@pytest.mark.parametrize("speed", [1200.0, 1650.0])
def test_engine_speed_is_found_while_driving(simulation, rough, speed):
    """On class E at 10 m/s the accelerations tell the engine's speed to one hypothesis, 10 r/min."""
    record = run_closed_loop(simulation(10.0, speed), rough, Passive(PERIOD), 2500)
    estimator = EngineSpeedEstimator(PERIOD)
    found = []
    for force, rate in zip(record.specific_force.tolist(), record.angular_velocity.tolist(), strict=True):
        found.append(estimator.update(Sample(0.0, force[0], rate[0], force[1], rate[1])))
    assert None not in found[2000:]
    assert np.abs(np.array(found[2000:]) - speed).max() < 10.0
