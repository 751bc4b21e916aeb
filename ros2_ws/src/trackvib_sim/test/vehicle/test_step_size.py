"""The step that a vehicle needs, for stability and for a result that does not depend on it."""

import numpy as np
import pytest
from trackvib_sim.data import find_vehicle, vehicle_names
from trackvib_sim.simulation.settings import Rates
from trackvib_sim.vehicle.step_size import CLEAR, NEEDED, contacts, fastest_contact, longest_step, recommended_rate
from trackvib_sim.vehicle.vehicle_file import read_vehicle


@pytest.mark.analytic
def test_longest_step_is_the_limit_of_symplectic_euler(vehicle):
    """Just below it the step's matrix for a pin between two links on a tooth keeps within 1, just above it does not."""
    t, teeth = vehicle.tracks, vehicle.sprocket_teeth
    k, c = 4.0 * t.link_stiffness + teeth.stiffness, 4.0 * t.link_damping + teeth.damping
    for factor, stable in ((1.0 - 1e-6, True), (1.0 + 1e-6, False)):
        h = factor * longest_step(vehicle)
        faster = np.array([[1.0, 0.0], [-h * k / t.shoe_mass, 1.0 - h * c / t.shoe_mass]])  # place, speed
        step = np.array([[1.0, h], [0.0, 1.0]]) @ faster
        assert (np.abs(np.linalg.eigvals(step)).max() <= 1.0) == stable


@pytest.mark.analytic
def test_fastest_contact_is_an_eigenvalue(vehicle):
    """Pins on teeth between pins in counterphase: the highest frequency of a ring of masses on springs."""
    t, pins = vehicle.tracks, 8
    ring = 2.0 * np.eye(pins) - np.roll(np.eye(pins), 1, axis=0) - np.roll(np.eye(pins), -1, axis=0)
    stiffness = t.link_stiffness * ring + vehicle.sprocket_teeth.stiffness * np.eye(pins)
    name, frequency = fastest_contact(vehicle)
    assert name == "on a tooth"
    assert frequency == pytest.approx(np.sqrt(np.linalg.eigvalsh(stiffness / t.shoe_mass)[-1]))


@pytest.mark.property
def test_stiffest_contact_decides(changed):
    """A rim or a ground that is stiffer than the teeth takes their place, for both figures."""
    usual = changed("tracks").tracks
    for section, item, name in (
        ("idler_rims", "radial_stiffness", "on an idler"),
        ("roller_rims", "radial_stiffness", "on a roller"),
        ("ground", "stiffness", "between road wheel and ground"),
    ):
        stiff = changed(section, **{item: 1e10})
        found, frequency = fastest_contact(stiff)
        assert found == name and frequency > np.sqrt(1e10 / usual.shoe_mass)
        assert longest_step(stiff) < 2.0 / np.sqrt(1e10 / usual.shoe_mass)
    assert "on a roller" not in {contact.name for contact in contacts(changed("tracks").model_copy(
        update={"carrier_rollers": None, "roller_rims": None}))}  # fmt: skip


@pytest.mark.property
@pytest.mark.parametrize("shoe_mass", [0.02, 1.0, 5.0, 18.58, 40.0])
def test_recommended_rate_is_one_that_a_run_takes(changed, shoe_mass):
    """It is the lowest such rate in whole kHz that is fine enough for the fastest motion and clear of instability."""
    vehicle = changed("tracks", shoe_mass=shoe_mass)
    rate, frequency, longest = recommended_rate(vehicle), fastest_contact(vehicle)[1], longest_step(vehicle)
    Rates(physics=rate, control=1000)
    assert rate % 1000 == 0 and frequency / rate <= NEEDED and rate * longest >= CLEAR
    lower = [each for each in range(1000, rate, 1000) if 10**9 % each == 0]
    assert all(frequency / each > NEEDED or each * longest < CLEAR for each in lower)


@pytest.mark.property
def test_damping_alone_asks_for_a_finer_step(changed):
    """Strongly damped links diverge where their frequency alone would allow a coarser step."""
    damped = changed("tracks", link_damping=3e5)
    assert recommended_rate(damped) * longest_step(damped) >= CLEAR
    assert fastest_contact(damped)[1] / recommended_rate(damped) < 0.5 * NEEDED


@pytest.mark.property
@pytest.mark.parametrize("control", [10, 250, 400, 1000, 5000, 10_000])
def test_recommended_rate_suits_the_control_rate(vehicle, control):
    """It is a multiple of it, and no finer than the next such one."""
    rate = recommended_rate(vehicle, control)
    Rates(rate, control, 10)
    assert rate >= recommended_rate(vehicle) and rate <= max(8000, control)


@pytest.mark.property
@pytest.mark.parametrize(("delay", "rate"), [(1e-3, 5000), (5e-4, 8000), (1.5e-4, 20_000), (1.3e-7, 5000)])
def test_recommended_rate_suits_the_delay_of_the_coils(changed, delay, rate):
    """It is the lowest that divides the delay into whole steps; for a delay that none divides it is as without."""
    assert recommended_rate(changed("coil", delay=delay)) == rate


@pytest.mark.property
@pytest.mark.parametrize("name", vehicle_names())
def test_library_steps_twice_as_finely_as_vehicles_need(name):
    """The rate by default of the library and of studies leaves room to spare with every vehicle that is included."""
    vehicle, _ = read_vehicle(find_vehicle(name))
    assert 2 * recommended_rate(vehicle) <= Rates().physics
