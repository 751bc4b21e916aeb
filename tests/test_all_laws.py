"""Every law gives the same bits in the loop without ROS, in one process and in several."""

import numpy as np
import pytest
from mr_mount_controller.laws import find_law, known_laws
from mr_mount_controller.packed_message import MessageReader
from sensor_msgs.msg import Imu
from trackvib_msgs.msg import CoilCurrent
from trackvib_sim.installed import default_vehicle_file
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

pytestmark = pytest.mark.system

SECONDS = 1.0
SAMPLES = 1000
ROAD = {"road_class": "E", "seed": 1, "level_until": 1.0, "fade": 1.0}
IMU = MessageReader(Imu, {"angular_velocity": "3d", "linear_acceleration": "3d"})
ANSWER = MessageReader(CoilCurrent, {"sample_stamp": "iI", "current": "2d"})
TOPICS = {"chassis/imu": Imu, "powertrain/imu": Imu, "coil_current": CoilCurrent}


@pytest.fixture(scope="module")
def simulation():
    """The vehicle as the simulator node has it by default; reset for each law."""
    vehicle, _ = read_vehicle(default_vehicle_file())
    return Simulation(vehicle, RunSettings(Operation(10.0, 1650.0, False, 0.25), Rates(), 1.0))


def without_ros(simulation, law):
    """Return rates and forces (k, 12) of both sensors and currents (k, 2)."""
    simulation.reset()
    record = run_closed_loop(simulation, Iso8608Road(*ROAD.values()), find_law(law)(1e-3), SAMPLES)
    sensors = np.concatenate((record.rate, record.specific_force), axis=2).reshape(SAMPLES, 12)
    return sensors, record.current


def gathered(observer):
    """Return the same of what the nodes have published, and forget it."""
    observer.wait_until(lambda: all(len(observer.gathered[topic]) >= SAMPLES for topic in TOPICS))
    sensors = [np.array([IMU.read(data) for data in observer.gathered[f"{place}/imu"]]) for place in
               ("chassis", "powertrain")]
    answers = np.array([ANSWER.read(data) for data in observer.gathered["coil_current"]])
    np.testing.assert_array_equal(answers[:, 0] * 1000 + answers[:, 1] / 1_000_000, np.arange(1, SAMPLES + 1))
    for messages in observer.gathered.values():
        messages.clear()
    return np.concatenate(sensors, axis=1), answers[:, 2:]


@pytest.mark.parametrize("law", known_laws())
def test_three_ways_one_result(simulation, start_node, observer, law):
    """One second on class E, roughness from the first metre on: sensors and currents agree to the last bit."""
    expected = without_ros(simulation, law)
    for topic, kind in TOPICS.items():
        observer.gather(kind, topic)

    together = start_node("one_process", law=law, duration=SECONDS, **ROAD)
    assert together.wait() == 0, together.output
    one = gathered(observer)

    road, controller = start_node("road_excitation", **ROAD), start_node("controller", law=law)
    simulator = start_node("simulator", duration=SECONDS)
    assert simulator.wait() == 0, simulator.output
    several = gathered(observer)

    assert road.running and controller.running
    for here, there, apart in zip(expected, one, several, strict=True):
        np.testing.assert_array_equal(there, here)
        np.testing.assert_array_equal(apart, here)
