"""The FMU's own part, without any host: what goes in and comes out, and what is refused."""

from types import SimpleNamespace

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle
from trackvib_sim.fmu.slave import VehicleSlave
from trackvib_sim.nodes.simulator_parameters import PARAMETERS, simulation_of
from trackvib_sim.road.iso8608 import Iso8608Road, Isotropic

pytestmark = pytest.mark.property

SPEED, SEED = 6.0, 3


@pytest.fixture
def slave():
    """An instance on class D with its variables by name."""
    values = {parameter.name: parameter.default for parameter in PARAMETERS} | {"speed": SPEED}
    text = find_vehicle().read_text(encoding="utf-8")
    told = {"title": "trial", "vehicle": text, "drive": "", "road": "D", "seed": SEED, "values": values}
    one = type("Trial", (VehicleSlave,), {"told": told})(instance_name="one")
    number = {variable.name: reference for reference, variable in one.vars.items()}
    return SimpleNamespace(
        step=one.do_step,
        read=lambda *names: one.get_real([number[name] for name in names]),
        write=lambda **values: one.set_real([number[f"coil_current.{name}"] for name in values], [*values.values()]),
        names=list(number),
        said=lambda: [entry.msg for entry in one.log_queue],
        description=one.to_xml(),
    )


def test_steps_have_the_bits_of_the_simulation(slave, vehicle, drive):
    """Under other currents than at the start; a step of several periods is as many steps."""
    values = {parameter.name: parameter.default for parameter in PARAMETERS} | {"speed": SPEED}
    road = Iso8608Road("D", SEED, coherence=Isotropic(2.0 * vehicle.road_wheels.y))
    alone = simulation_of(vehicle, values, "")
    for _ in drive(alone, road, 8):
        pass
    slave.write(left=1.0, right=1.0)
    assert slave.step(0.0, 0.001) and slave.step(0.001, 0.007)
    axes = [f"powertrain.linear_acceleration.{axis}" for axis in "xyz"]
    np.testing.assert_array_equal(slave.read(*axes), alone.sample.specific_force[1])
    force = [f"mount_state.right.force.{axis}" for axis in "xyz"]
    np.testing.assert_array_equal(slave.read(*force), alone.sample.mounts.force[1])
    assert slave.read("hull.distance") == [alone.distance]


def test_variables(slave):
    """Inputs are the coils; outputs stand in the description as outputs and as unknowns of the start."""
    assert slave.names[:2] == ["coil_current.left", "coil_current.right"]
    structure = slave.description.find("ModelStructure")
    outputs, initial = (
        [unknown.get("index") for unknown in structure.find(kind)] for kind in ("Outputs", "InitialUnknowns")
    )
    assert outputs == initial == [str(k) for k in range(3, len(slave.names) + 1)]
    assert slave.read("coil_current.left", "chassis.linear_acceleration.z") == [1.0, 0.0]


@pytest.mark.parametrize("size", [0.0004, 0.0015, 0.0, -0.001])
def test_odd_steps_are_refused(slave, size):
    """Nothing moves, and the log says what is accepted."""
    assert not slave.step(0.0, size)
    assert "multiples of the control period, 0.001 s" in slave.said()[-1]
    assert slave.read("chassis.linear_acceleration.z") == [0.0]


def test_currents_that_are_no_numbers_are_refused(slave):
    """The step is not done."""
    slave.write(left=float("nan"))
    assert not slave.step(0.0, 0.001)
    assert "must be finite" in slave.said()[-1]
