"""What the controller's laws know of the vehicle agrees with the vehicle file, and each law closes the loop."""

import numpy as np
import pytest
from mr_mount_controller import mount
from mr_mount_controller.laws import find_law, shipped_laws
from mr_mount_controller.laws.base import Sample
from mr_mount_controller.laws.engine_speed import ORDERS, SPEEDS, EngineSpeedEstimator
from mr_mount_controller.laws.passive import Passive
from mr_mount_controller.mount import PUBLISHED
from mr_mount_controller.mounting import PAIR
from trackvib_sim.data import find_vehicle
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.rui.linear.mode import describe
from trackvib_sim.rui.linear.modes import modes
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.vehicle.linear_vehicle import build_linear_vehicle
from trackvib_sim.vehicle.mount_law import mount_characteristics
from trackvib_sim.vehicle.mounting import mounting_of
from trackvib_sim.vehicle.system import Operation, build_system
from trackvib_sim.vehicle.vehicle_file import read_vehicle

PERIOD = 1e-3


@pytest.fixture(scope="module")
def rough():
    """A class E road that begins under the vehicle."""
    return Iso8608Road("E", 1, 4.0, 8.0)


@pytest.mark.golden
@pytest.mark.parametrize("name", ["tao2025", "leopard1", "tao2025_free"])
def test_controller_knows_the_mounts(name):
    """k(I) and c(I) that it is told are the simulator's at every current, those out of range included, to rounding."""
    vehicle, _ = read_vehicle(find_vehicle(name))
    system, curve = build_system(vehicle, Operation(10.0, 1650.0, False), 1e-4), mounting_of(vehicle).curve
    for current in np.linspace(0.0, 5.0, 101):
        k, c = mount_characteristics(system.mounts, 0, float(current))
        assert curve.stiffness(current) == pytest.approx(k, rel=1e-12)
        assert curve.damping(current) == pytest.approx(c, rel=1e-12)


@pytest.mark.golden
def test_controller_takes_the_default_vehicle_where_nobody_tells(vehicle):
    """What laws are designed on then is the shipped vehicle."""
    told = mounting_of(vehicle)
    assert (told.curve, told.carried, told.turning) == (PUBLISHED, PAIR.carried, PAIR.turning)
    assert set(ORDERS) == set(vehicle.engine.orders)
    assert SPEEDS[0] < vehicle.engine.speed_range[0] and SPEEDS[-1] > vehicle.engine.speed_range[1]


@pytest.mark.slow(reason="the modes of each vehicle")
@pytest.mark.analytic
@pytest.mark.parametrize(("name", "within"), [("tao2025", 0.03), ("leopard1", 0.1), ("tao2025_free", 0.15)])
@pytest.mark.parametrize("current", [1.0, 3.0])
def test_resonance_that_is_told_is_a_mode_of_the_vehicle(name, within, current):
    """Of the standing vehicle's modes one that begins with the powertrain lies there.

    The hull is held and the mounts' other axes are left out, so to some percent only; of the free powertrain the pitch
    that goes with the vertical motion is left out as well.
    """
    vehicle, _ = read_vehicle(find_vehicle(name))
    mounting = mounting_of(vehicle)
    told = mounting.carried.resonance(mounting.coils, mounting.curve.stiffness(current))
    system = build_system(vehicle, Operation(0.0, 0.0, False), 1e-4)
    model = build_linear_vehicle(vehicle, system, current)
    own = [mode.frequency for mode in modes(model, 30.0) if describe(model, mode).startswith("powertrain")]
    assert min(abs(frequency / told - 1.0) for frequency in own) < within


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
    moving = simulation(10.0, speed)
    record = run_closed_loop(moving, rough, Passive(PERIOD), 2500)
    estimator = EngineSpeedEstimator(PERIOD, moving.mounting.carried)
    found = []
    for force, rate in zip(record.specific_force.tolist(), record.angular_velocity.tolist(), strict=True):
        found.append(estimator.update(Sample(0.0, force[0], rate[0], force[1], rate[1])))
    assert None not in found[2000:]
    assert np.abs(np.array(found[2000:]) - speed).max() < 10.0
