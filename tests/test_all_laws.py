"""Every law gives the same bits in the loop without ROS, with all nodes in one process and with each in its own."""

import signal

import numpy as np
import pytest
from mr_mount_controller.laws import find_law, known_laws
from trackvib_sim.bags.reading import read_recording
from trackvib_sim.data import find_vehicle
from trackvib_sim.road.iso8608 import Iso8608Road
from trackvib_sim.simulation.closed_loop import run_closed_loop
from trackvib_sim.simulation.settings import Rates, RunSettings
from trackvib_sim.simulation.simulation import Simulation
from trackvib_sim.vehicle.step_size import recommended_rate
from trackvib_sim.vehicle.system import Operation
from trackvib_sim.vehicle.vehicle_file import read_vehicle

from .conftest import UNHURRIED

pytestmark = [pytest.mark.system, pytest.mark.slow(reason="each law drives three whole loops")]

SAMPLES = 1000
ROAD = {"road": "E", "seed": 1, "level_until": 1.0, "fade": 1.0}


@pytest.fixture(scope="module")
def simulation():
    """The vehicle as the simulator node has it by default; reset for each law."""
    vehicle, _ = read_vehicle(find_vehicle())
    rates = Rates(recommended_rate(vehicle))
    return Simulation(vehicle, RunSettings(Operation(10.0, 1650.0, False, 0.25), rates, 1.0))


@pytest.fixture
def run_nodes(start_node, tmp_path):
    """Run nodes for a second: `run_nodes(executables, law)` returns the `Drive` of the bag."""

    def run(executables, law):
        of_nodes = {
            "road_excitation": ROAD,
            "controller": {"law": law, "wait_for_recorder": True},
            "simulator": {"duration": SAMPLES / 1000, "wait_for_recorder": True, "answer_timeout": UNHURRIED},
        }
        given = {f"{node}:{name}": value for node, values in of_nodes.items() for name, value in values.items()}
        bag = tmp_path / executables[-1]
        recorder = start_node("recorder", bag=bag)
        *others, last = (start_node(name, **given) for name in executables)
        assert last.wait() == 0, last.output
        recorder.signal(signal.SIGINT)
        assert recorder.wait() == 0, recorder.output
        for node in others:
            node.signal(signal.SIGINT)
            assert node.wait() == 0, node.output
        return read_recording(bag)

    return run


@pytest.mark.parametrize("law", known_laws())
def test_three_ways_one_result(simulation, run_nodes, law):
    """One second on class E, roughness from the first metre on: sensors and currents agree to the last bit."""
    simulation.reset()
    record = run_closed_loop(simulation, Iso8608Road(*ROAD.values()), find_law(law)(1e-3), SAMPLES)
    for executables in (("one_process",), ("road_excitation", "controller", "simulator")):
        drive = run_nodes(executables, law)
        for k, sensor in enumerate((drive.chassis, drive.powertrain)):
            np.testing.assert_array_equal(sensor.stamp, record.stamp)
            np.testing.assert_array_equal(sensor.specific_force, record.specific_force[:, k])
            np.testing.assert_array_equal(sensor.angular_velocity, record.angular_velocity[:, k])
        np.testing.assert_array_equal(drive.answers.sample_stamp, record.stamp)
        np.testing.assert_array_equal(drive.answers.current, record.current)
